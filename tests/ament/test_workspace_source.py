"""`source install/setup.bash`: what was built becomes importable and findable, and what is built again takes its place."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from workspace_cases import change, colcon, make_package, parse, source_in, started

import turtle_lesson
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World, open_world


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A good package in a workspace, which is the current folder."""
    monkeypatch.chdir(tmp_path)
    return make_package(tmp_path)


@pytest.fixture(autouse=True)
def clean(world: World) -> Iterator[None]:
    """Nothing of a page is left over."""
    before = list(sys.path)
    yield
    world.close()
    assert sys.path == before
    assert "robot_controller" not in registry.packages()


def fields() -> list[str]:
    """The fields of the message that an import finds now."""
    return list(importlib.import_module("robot_controller.msg").TurtleStatus.get_fields_and_field_types())


def test_before_it_nothing_can_be_imported(package: Path, world: World) -> None:
    colcon(world)
    with pytest.raises(ModuleNotFoundError, match="No module named 'robot_controller'"):
        fields()
    assert "robot_controller" not in world.packages
    assert source_in(world).shape == (0, [""], [""])
    assert fields()[-1] == "battery"
    assert "'battery': 'float'" in started(world, "robot_controller", "navigator")


def test_services_too(package: Path, world: World) -> None:
    colcon(world)
    source_in(world, "install/local_setup.bash")
    from robot_controller.srv import NavigateTo

    assert NavigateTo.Request(x=1.0).x == 1.0
    assert world.packages.get("robot_controller").interfaces == ["msg/TurtleStatus.msg", "srv/NavigateTo.srv"]


def test_after_an_edit_and_a_build_the_new_fields_count(package: Path, world: World) -> None:
    colcon(world)
    source_in(world)
    assert fields()[-1] == "battery"
    change(package / "msg/TurtleStatus.msg", "float32 battery", "uint8 lives 9")
    assert fields()[-1] == "battery"  # not built yet
    colcon(world)
    source_in(world)
    assert fields()[-1] == "lives"
    from robot_controller.msg import TurtleStatus

    assert TurtleStatus().lives == 9
    assert "'lives': 'uint8'" in started(world, "robot_controller", "navigator")


def test_a_sourced_package_is_built_in_place(package: Path, world: World) -> None:
    """As on a robot, a build replaces the files that the sourced paths lead to."""
    colcon(world)
    source_in(world)
    change(package / "robot_controller/navigator_node.py", "'navigator'", "'new code'")
    assert started(world, "robot_controller", "navigator").startswith("navigator")
    colcon(world)
    assert started(world, "robot_controller", "navigator").startswith("new code")


def test_a_message_made_before_the_build_is_told_from_a_new_one(package: Path, world: World) -> None:
    colcon(world)
    source_in(world)
    old = importlib.import_module("robot_controller.msg").TurtleStatus()
    change(package / "msg/TurtleStatus.msg", "float32 battery", "uint8 lives 9")
    colcon(world)
    source_in(world)
    import rclpy

    rclpy.init()
    kind = importlib.import_module("robot_controller.msg").TurtleStatus
    publisher = rclpy.create_node("n").create_publisher(kind, "status", 10)
    with pytest.raises(TypeError) as caught:
        publisher.publish(old)
    assert "was made before TurtleStatus was built again: import it again" in caught.value.__notes__[0]


def test_with_symlinks_an_edit_counts_at_once(package: Path, world: World) -> None:
    colcon(world, "build --symlink-install")
    (package / "robot_controller/navigator_node.py").chmod(0o755)
    source_in(world)
    change(package / "robot_controller/navigator_node.py", "'navigator'", "'new code'")
    assert started(world, "robot_controller", "navigator").startswith("new code")


def test_it_hides_the_finished_package_and_gives_it_back(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lesson = turtle_lesson.start(simulator=False)
    finished = world_of(lesson).packages.get("robot_controller")
    change(package / "msg/TurtleStatus.msg", "float32 battery", "uint8 lives")
    colcon(world_of(lesson))
    assert fields()[-1] == "battery"
    source_in(world_of(lesson))
    assert world_of(lesson).packages.get("robot_controller").prefix == package.parents[1] / "install/robot_controller"
    assert fields()[-1] == "lives"
    lesson = turtle_lesson.start(simulator=False)
    assert world_of(lesson).packages.get("robot_controller").share == finished.share
    assert fields()[-1] == "battery"
    registry.remove("robot_controller")


def world_of(lesson: turtle_lesson.Lesson) -> World:
    return lesson._world


def test_a_new_world_knows_nothing_of_it(package: Path, world: World) -> None:
    colcon(world)
    source_in(world)
    assert fields()
    open_world()
    with pytest.raises(ModuleNotFoundError):
        fields()


def test_twice_is_as_once(package: Path, world: World) -> None:
    colcon(world)
    for _ in range(3):
        source_in(world)
    assert world.packages.names() == ["robot_controller"]
    world.packages.remove(world.packages.get("robot_controller"))
    assert world.packages.names() == []


def test_what_is_wrong_is_said_in_bashs_words(package: Path, world: World) -> None:
    code, _, err = source_in(world).shape
    assert (code, err) == (
        1,
        [
            "bash: install/setup.bash: No such file or directory. Have you run colcon build, and are you in the workspace's "
            "folder (the one that contains src/)?"
        ],
    )
    colcon(world)
    assert "is a directory. Name the file in it: source install/setup.bash" in source_in(world, "install").err
    assert "Did you mean 'setup.bash'?" in source_in(world, "install/setp.bash").err
    assert "sources only what colcon build makes" in source_in(world, "src/robot_controller/package.xml").err
    assert source_in(world, "/opt/ros/humble/setup.bash").code == 0


# -- ament_python ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def python_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package with one program, which counts in a variable of its module."""
    from turtle_lesson.ros.ament.create import create_package

    (tmp_path / "src").mkdir()
    monkeypatch.chdir(tmp_path)
    line = "py_demo --build-type ament_python --node-name count --destination-directory src"
    create_package(parse(line.split()))
    folder = tmp_path / "src/py_demo/py_demo"
    (folder / "count.py").write_text(
        "from py_demo.words import WORD\n\ncount = 0\n\n\ndef main():\n    global count\n    count += 1\n"
        "    print(WORD, count)\n    return 3 if WORD == 'bad' else 0\n"
    )
    (folder / "words.py").write_text("WORD = 'one'\n")
    return folder


def test_an_entry_point_runs_as_a_process_of_its_own(python_package: Path, world: World) -> None:
    colcon(world)
    source_in(world)
    assert started(world, "py_demo", "count") == "one 1\n"
    assert started(world, "py_demo", "count") == "one 1\n"


def test_the_package_can_be_imported_and_is_fresh_after_a_build(python_package: Path, world: World) -> None:
    colcon(world)
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("py_demo.words")
    source_in(world)
    assert importlib.import_module("py_demo.words").WORD == "one"
    (python_package / "words.py").write_text("WORD = 'two'\n")  # the same size, the same second
    assert started(world, "py_demo", "count") == "one 1\n"
    colcon(world)
    source_in(world)
    assert importlib.import_module("py_demo.words").WORD == "two"
    assert started(world, "py_demo", "count") == "two 1\n"


def test_its_exit_code_is_the_process_s(python_package: Path, world: World) -> None:
    (python_package / "words.py").write_text("WORD = 'bad'\n")
    colcon(world)
    source_in(world)
    process = world.spawn(world.packages.executable("py_demo", "count"), name="count")
    world.sim.settle()
    assert process.exit_code == 3


def test_its_errors_name_the_installed_file(python_package: Path, world: World) -> None:
    (python_package / "words.py").write_text("WORD = unknown\n")
    colcon(world)
    source_in(world)
    said = started(world, "py_demo", "count")
    assert 'File "install/py_demo/lib/python3.10/site-packages/py_demo/words.py", line 1' in said
    assert "NameError: name 'unknown' is not defined" in said
