"""`ros2 pkg` and `ros2 daemon`: what they print, compared with recordings of the real ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from command_cases import check, type_in
from workspace_on_disk import install_robot_controller

from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World


@pytest.fixture
def workspace(world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    install_robot_controller(world, tmp_path)
    yield tmp_path
    registry.remove("robot_controller")


def test_pkg_answers_as_recorded(world: World, workspace: Path) -> None:
    check(world, "pkg.txt")


def test_daemon_answers_as_recorded(world: World) -> None:
    check(world, "daemon.txt")


def test_the_list_has_programs_interfaces_and_libraries(world: World, workspace: Path) -> None:
    names = type_in(world, "ros2 pkg list").stdout.split()
    assert names == sorted(names)
    assert {"robot_controller", "rclpy", "geometry_msgs", "launch_ros"} <= set(names)


def test_all_programs_of_all_packages_are_listed_without_a_name(world: World, workspace: Path) -> None:
    assert "robot_controller navigator" in type_in(world, "ros2 pkg executables").stdout.splitlines()


def test_a_package_of_interfaces_alone_has_no_programs(world: World) -> None:
    answer = type_in(world, "ros2 pkg executables std_msgs")
    assert (answer.stdout, answer.stderr, answer.code) == ("", "", 0)


def test_a_name_that_is_nearly_right_is_recognised(world: World, workspace: Path) -> None:
    for command in ("prefix", "executables", "xml"):
        answer = type_in(world, f"ros2 pkg {command} robot_controler")
        assert "Did you mean 'robot_controller'?" in answer.stderr
        assert answer.code == 1


def test_an_unknown_element_of_package_xml_is_said(world: World, workspace: Path) -> None:
    answer = type_in(world, "ros2 pkg xml robot_controller -t versoin")
    assert (answer.stderr, answer.code) == ("XML tag not found\nDid you mean 'version'?\n", 1)


def test_a_manifest_is_missing_with_its_package_or_because_the_package_is_simulated(world: World) -> None:
    assert type_in(world, "ros2 pkg xml nope").stderr.startswith("Package not found\n")
    assert "is a part of the simulation" in type_in(world, "ros2 pkg xml geometry_msgs").stderr


def test_a_new_package_goes_where_it_was_asked_for(world: World, workspace: Path) -> None:
    assert type_in(world, "ros2 pkg create here --destination-directory src").code == 0
    assert (workspace / "src" / "here" / "package.xml").is_file()
