"""`colcon build`: what it prints, compared with recordings of the real one, and what it refuses."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from command_cases import cases
from hypothesis import given
from hypothesis import strategies as st
from workspace_cases import change, colcon, make_package, parse, source_in, timeless

from turtle_lesson.ros.ament.package import CompiledProgramError
from turtle_lesson.ros.cli.colcon import run
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime.world import World


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A good package in a workspace, which is the current folder."""
    monkeypatch.chdir(tmp_path)
    return make_package(tmp_path)


Break = Callable[[Path], object]
CMAKE, STATUS = "CMakeLists.txt", "msg/TurtleStatus.msg"
BROKEN: dict[str, Break] = {
    "as it is": lambda p: None,
    "find_package of a package that is not there": lambda p: change(
        p / CMAKE, "# line 10", "find_package(turtle_msgs REQUIRED)"
    ),
    "a default value that is none": lambda p: change(p / STATUS, "battery", "battery level"),
    "a type that is none": lambda p: change(p / STATUS, "float32 battery", "flot32 battery"),
    "a field with a capital": lambda p: change(p / STATUS, "battery", "Battery"),
    "a field twice": lambda p: change(p / STATUS, "float32 y", "float32 x"),
    "a service without ---": lambda p: change(p / "srv/NavigateTo.srv", "---\n", ""),
    "a file that is not there": lambda p: change(p / CMAKE, "TurtleStatus.msg", "TurtleStat.msg"),
    "without find_package": lambda p: change(p / CMAKE, "find_package(rosidl_default_generators REQUIRED)", "#"),
    "without member_of_group": lambda p: change(
        p / "package.xml", "  <member_of_group>rosidl_interface_packages</member_of_group>\n", ""
    ),
    "package.xml is cut off": lambda p: change(p / "package.xml", "</package>\n", ""),
    "a program that is not there": lambda p: change(p / CMAKE, "navigator_node.py", "navigator.py"),
    "another name in project()": lambda p: change(p / CMAKE, "project(robot_controller)", "project(robot)"),
    "a command that is none": lambda p: change(p / CMAKE, "ament_package", "ament_pakage"),
    "an unknown build_type": lambda p: change(p / "package.xml", "type>ament_cmake<", "type>ament_cmak<"),
    "ament_package() too early": lambda p: change(p / CMAKE, "# line 10", "ament_package()"),
    "no maintainer": lambda p: change(
        p / "package.xml", '  <maintainer email="user@example.org">user</maintainer>\n', ""
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_the_words_of_the_real_build(package: Path, world: World, name: str) -> None:
    (case,) = [case for case in cases("colcon_build.txt") if case.command == f"colcon build  # {name}"]
    BROKEN[name](package)
    answer = colcon(world)
    assert answer.shape == (case.code, timeless(case.stdout), timeless(case.stderr))


def test_every_recorded_case_is_tried() -> None:
    assert [case.command.partition("# ")[2] for case in cases("colcon_build.txt")] == list(BROKEN)


def test_commas_between_the_names_are_named(package: Path, world: World) -> None:
    change(package / CMAKE, 'TurtleStatus.msg"', 'TurtleStatus.msg",')
    assert "Hint: CMake separates names by spaces or new lines: leave the commas out." in colcon(world).err


def test_usage(package: Path, world: World) -> None:
    for case in cases("colcon_usage.txt"):
        answer = colcon(world, case.command.partition(" ")[2])
        assert answer.shape == (case.code, timeless(case.stdout), timeless(case.stderr)), case.command


def test_the_second_build_is_quick_and_fails_in_make(package: Path, world: World) -> None:
    assert "Finished <<< robot_controller [5.20s]" in colcon(world).out
    assert "Finished <<< robot_controller [0.70s]" in colcon(world).out
    change(package / "package.xml", "<member_of_group>rosidl_interface_packages</member_of_group>", "")
    answer = colcon(world)
    assert answer.code == 2
    assert "gmake: *** [Makefile:786: cmake_check_build_system] Error 1" in answer.err


def test_a_build_takes_robot_time(package: Path, world: World) -> None:
    colcon(world)
    assert world.now == pytest.approx(5.4e9)


def test_the_tree(package: Path, world: World, tmp_path: Path) -> None:
    colcon(world)
    tree = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*")}
    install = "install/robot_controller"
    for path in (
        "build/COLCON_IGNORE", "build/.built_by", "build/robot_controller/colcon_build.rc", "install/COLCON_IGNORE",
        "install/.colcon_install_layout", "install/setup.bash", "install/local_setup.bash", "log/COLCON_IGNORE",
        "log/latest_build/robot_controller/stdout_stderr.log",
        f"{install}/lib/robot_controller/navigator",
        f"{install}/local/lib/python3.10/dist-packages/robot_controller/msg/_turtle_status.py",
        f"{install}/local/lib/python3.10/dist-packages/robot_controller/srv/__init__.py",
        f"{install}/share/ament_index/resource_index/packages/robot_controller",
        f"{install}/share/ament_index/resource_index/rosidl_interfaces/robot_controller",
        f"{install}/share/colcon-core/packages/robot_controller",
        f"{install}/share/robot_controller/launch/start_system.launch.py",
        f"{install}/share/robot_controller/msg/TurtleStatus.msg",
        f"{install}/share/robot_controller/srv/NavigateTo.srv",
        f"{install}/share/robot_controller/package.xml",
    ):  # fmt: skip
        assert path in tree or (tmp_path / path).exists(), path
    assert "build/robot_controller/CMakeCache.txt" not in tree  # a real colcon would take it for CMake's own


def test_what_is_gone_from_the_source_is_gone_after_the_build(package: Path, world: World, tmp_path: Path) -> None:
    colcon(world)
    text = (package / CMAKE).read_text()
    (package / CMAKE).write_text(re.sub(r"install\(PROGRAMS[^)]*\)", "", text))
    colcon(world)
    assert not (tmp_path / "install/robot_controller/lib/robot_controller").exists()


def test_a_failed_build_leaves_the_last_good_one(package: Path, world: World, tmp_path: Path) -> None:
    colcon(world)
    change(package / STATUS, "battery", "Battery")
    assert colcon(world).code
    assert (tmp_path / "install/robot_controller/lib/robot_controller/navigator").is_file()


def test_symlink_install(package: Path, world: World, tmp_path: Path) -> None:
    colcon(world, "build --symlink-install")
    program = tmp_path / "install/robot_controller/lib/robot_controller/navigator"
    assert program.resolve() == package / "robot_controller/navigator_node.py"
    colcon(world)
    assert program.resolve() == program


# -- advice, where the real build says nothing or little -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("file", "old", "new", "code", "said"),
    [
        (CMAKE, "ament_package()", "", 0, "There is no ament_package() in CMakeLists.txt"),
        (
            CMAKE,
            "DESTINATION lib/${PROJECT_NAME} RENAME",
            "DESTINATION bin RENAME",
            0,
            "goes to bin; ros2 run looks only in",
        ),
        (CMAKE, "launch DESTINATION share/${PROJECT_NAME}", "launch", 1, "install DIRECTORY given no DESTINATION!"),
        (
            CMAKE,
            "DESTINATION share/${PROJECT_NAME}",
            "DESTINATION /etc",
            1,
            "lies outside the package's install folder",
        ),
        (
            CMAKE,
            "DESTINATION share/${PROJECT_NAME}",
            "DESTINATION ../..",
            1,
            "lies outside the package's install folder",
        ),
        (CMAKE, "# line 10", "find_package(launch REQUIRED)", 1, "launch is a Python package, which CMake cannot find"),
        (CMAKE, "# line 10", "find_package(sensor_mgs REQUIRED)", 1, "Did you mean 'sensor_msgs'?"),
        (CMAKE, "# line 10", "install(TARGETS x DESTINATION lib)", 1, 'given target "x" which does not exist.'),
        (CMAKE, "# line 10", "find_package(nope_msgs)", 0, "CMake Warning at CMakeLists.txt:10 (find_package)"),
        (
            CMAKE,
            "find_package(ament_cmake REQUIRED)",
            "ament_environment_hooks(x)",
            1,
            "Write find_package(ament_cmake REQ",
        ),
        (CMAKE, "ament_package()", "ament_package(", 1, 'Parse error. Function missing ending ")".'),
        (CMAKE, "project(robot_controller)", "", 1, "No project() command is present."),
        (
            STATUS,
            "float32 battery",
            "geometry_msgs/Point at",
            2,
            "line 6, uses messages of geometry_msgs: in CMakeLists",
        ),
        (
            STATUS,
            "float32 battery",
            "Batery b",
            2,
            "TurtleStatus.msg:6: fatal error: the type 'robot_controller/Batery' is unk",
        ),
        (
            "robot_controller/navigator_node.py",
            "#!/usr/bin/env python3\n",
            "",
            0,
            "does not begin with '#!/usr/bin/env python3'",
        ),
        ("package.xml", "<build_type>ament_cmake</build_type>", "", 0, "colcon takes it for a package of ROS 1"),
        (
            "package.xml",
            'format="3"',
            'format="2"',
            1,
            "(with format version 2) must not contain the following tags: member",
        ),
        ("package.xml", 'format="3"', "", 1, 'Write <package format="3"> in the second line'),
        ("package.xml", 'format="3"', 'format="4"', 1, "Unable to handle package.xml format version '4'"),
        ("package.xml", "<export>", "<export/><export>", 1, 'must not contain more than one "export" tags'),
        ("package.xml", "exec_depend>", "exec_dependd>", 1, "Did you mean 'exec_depend'?"),
        ("package.xml", "<version>0.0.0", "<version>1", 1, 'Package version "1" does not follow version conventions'),
    ],
)
def test_advice(package: Path, world: World, file: str, old: str, new: str, code: int, said: str) -> None:
    change(package / file, old, new)
    answer = colcon(world)
    assert (answer.code, said in " ".join(answer.err.split())) == (code, True), answer.err


def test_entry_points_do_nothing_in_an_ament_cmake_package(package: Path, world: World) -> None:
    (package / "setup.py").write_text("from setuptools import setup\n\nsetup(\n    entry_points={},\n)\n")
    answer = colcon(world)
    assert answer.code == 0
    assert "Hint: setup.py, line 4, lists entry_points, but package.xml says ament_cmake" in answer.err
    assert "nothing will be installed from them." in answer.err


@pytest.mark.parametrize("before", ["ament_package()", "rosidl_generate_interfaces("])
def test_a_python_package_of_the_interfaces_name_is_refused(package: Path, world: World, before: str) -> None:
    """Whichever comes first: both make a Python package (ros2/rosidl_python, issue 141)."""
    (package / "robot_controller/__init__.py").touch()
    python = "find_package(ament_cmake_python REQUIRED)\nament_python_install_package(${PROJECT_NAME})\n"
    change(package / CMAKE, before, f"{python}{before}")
    answer = colcon(world)
    assert 'cannot create target "ament_cmake_python_copy_robot_controller"' in " ".join(answer.err.split())
    assert "install the nodes as programs instead" in answer.err


def test_an_action_needs_no_word_in_package_xml(package: Path, world: World) -> None:
    """CMake looks for action_msgs quietly, and every ROS 2 has it."""
    (package / "action").mkdir()
    (package / "action/Drive.action").write_text("float32 far\n---\nfloat32 driven\n---\nfloat32 left\n")
    change(package / CMAKE, '"srv/NavigateTo.srv"', '"srv/NavigateTo.srv"\n  "action/Drive.action"')
    answer = colcon(world)
    assert (answer.code, answer.err) == (0, "")


def test_dependencies_that_are_named_are_found(package: Path, world: World) -> None:
    change(package / STATUS, "float32 battery", "geometry_msgs/Point at")
    change(package / CMAKE, "# line 10", "find_package(geometry_msgs REQUIRED)")
    change(package / CMAKE, '"srv/NavigateTo.srv"', '"srv/NavigateTo.srv"\n  DEPENDENCIES geometry_msgs')
    answer = colcon(world)
    assert (answer.code, answer.err) == (0, "")


# -- several packages ----------------------------------------------------------------------------------------------------

OTHER = """\
cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
{find}
ament_package()
"""


def add(package: Path, name: str, needs: str = "", text: str = "") -> Path:
    """Another, empty package beside it."""
    folder = package.parent / name
    folder.mkdir()
    xml = (package / "package.xml").read_text().replace("<name>robot_controller<", f"<name>{name}<")
    xml = xml.replace("<depend>rclpy</depend>", f"<depend>{needs}</depend>" if needs else "")
    (folder / "package.xml").write_text(xml)
    find = f"find_package({needs} REQUIRED)" if needs else ""
    (folder / CMAKE).write_text(text or OTHER.format(name=name, find=find))
    return folder


def test_each_after_those_it_needs(package: Path, world: World) -> None:
    add(package, "bringup", "robot_controller")
    add(package, "apart")
    answer = colcon(world)
    assert [line.split(" [")[0] for line in answer.out.splitlines() if "<<<" in line or ">>>" in line] == [
        "Starting >>> apart", "Starting >>> robot_controller", "Finished <<< apart", "Finished <<< robot_controller",
        "Starting >>> bringup", "Finished <<< bringup",
    ]  # fmt: skip
    assert answer.err == ""
    assert "Summary: 3 packages finished" in answer.out


def test_a_failure_stops_the_others(package: Path, world: World) -> None:
    add(package, "bringup", "robot_controller")
    add(package, "apart")
    change(package / STATUS, "battery", "Battery")
    answer = colcon(world)
    assert answer.shape[1] == [
        "Starting >>> apart", "Starting >>> robot_controller", "Aborted  <<< apart [0.00s]", "",
        "Summary: 0 packages finished [0.00s]", "  1 package failed: robot_controller", "  1 package aborted: apart",
        "  1 package had stderr output: robot_controller", "  1 package not processed",
    ]  # fmt: skip
    answer = colcon(world, "build --continue-on-error")
    assert "Finished <<< apart" in answer.out
    assert "  1 package not processed" in answer.out


def test_a_package_is_found_only_if_package_xml_names_it(package: Path, world: World) -> None:
    folder = add(package, "bringup", "robot_controller")
    change(folder / "package.xml", "<depend>robot_controller</depend>", "")
    colcon(world, "build --packages-select robot_controller")
    answer = colcon(world, "build --packages-select bringup")
    assert 'provided by "robot_controller", but CMake did not find one' in " ".join(answer.err.split())
    assert "write <depend>robot_controller</depend> in package.xml" in answer.err


def test_which_packages(package: Path, world: World) -> None:
    add(package, "bringup", "robot_controller")
    add(package, "apart")
    built = {
        "--packages-select apart": {"apart"},
        "--packages-up-to bringup": {"robot_controller", "bringup"},
        "--packages-skip apart bringup": {"robot_controller"},
        "--base-paths src/apart": {"apart"},
    }
    for option, names in built.items():
        out = colcon(world, f"build {option}").out
        assert set(re.findall(r"Finished <<< (\w+)", out)) == names, option


def test_circles_and_twins_are_refused(package: Path, world: World) -> None:
    add(package, "one", "two")
    add(package, "two", "one")
    answer = colcon(world)
    assert answer.err.endswith("Unable to order packages topologically:\none: ['two']\ntwo: ['one']\n")
    change(package.parent / "two/package.xml", "<name>two<", "<name>one<")
    answer = colcon(world)
    assert answer.err.endswith("Duplicate package names not supported:\n- one:\n  - src/one\n  - src/two\n")
    assert answer.code == 1


def test_event_handlers(package: Path, world: World) -> None:
    answer = colcon(world, "build --event-handlers console_direct+ console_start_end- summary-")
    assert "-- Installing: install/robot_controller/lib/robot_controller/navigator" in answer.out
    assert ">>>" not in answer.out and "Summary" not in answer.out
    answer = colcon(world, "build --event-handlers console_cohesion+")
    assert "--- output: robot_controller\n" in answer.out
    answer = colcon(world, "build --event-handlers console_drect+")
    assert "Did you mean 'console_direct+'?" in answer.err


def test_list(package: Path, world: World) -> None:
    add(package, "bringup", "robot_controller")
    lines = "bringup\tsrc/bringup\t(ros.ament_cmake)\nrobot_controller\tsrc/robot_controller\t(ros.ament_cmake)\n"
    assert colcon(world, "list").out == lines
    assert colcon(world, "list -t -n").out == "robot_controller\nbringup\n"


def test_a_place_without_packages(tmp_path: Path, world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    answer = colcon(world)
    assert (answer.code, answer.out) == (0, "\nSummary: 0 packages finished [0.20s]\n")
    assert "no folder here has a package.xml" in answer.err


def test_names_that_would_lead_elsewhere(package: Path, world: World, tmp_path: Path) -> None:
    change(package / "package.xml", "<name>robot_controller", "<name>../../../elsewhere")
    assert colcon(world).code
    assert not (tmp_path.parent / "elsewhere").exists()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("RENAME navigator", "RENAME ../../../../navigator"),
        ("DIRECTORY launch", "DIRECTORY ../.."),
        ("DIRECTORY launch", "DIRECTORY /"),
        ("DIRECTORY launch", "DIRECTORY ../robot_controller/.."),
    ],
)
def test_nothing_is_installed_from_or_to_elsewhere(package: Path, world: World, old: str, new: str) -> None:
    change(package / CMAKE, old, new)
    answer = colcon(world)
    assert (answer.code, "lies outside the package's" in answer.err) == (1, True)


def test_no_build_removes_the_source(package: Path, world: World) -> None:
    answer = colcon(world, "build --install-base src")
    assert "src is the folder of the sources; choose another folder" in answer.err
    assert (package / CMAKE).is_file()


def test_options_that_do_not_exist(package: Path, world: World) -> None:
    answer = colcon(world, "build --package-select robot_controller")
    assert answer.code == 2
    assert "unrecognized arguments: --package-select" in answer.err
    assert answer.err.endswith("Did you mean '--packages-select'?\n")
    assert len(colcon(world, "build --" + "x" * 10_000).err) < 3000


def test_words_for_cmake_are_taken(package: Path, world: World) -> None:
    (package / "robot_controller/navigator_node.py").chmod(0o755)
    answer = colcon(world, "--log-level info build --cmake-args -DCMAKE_BUILD_TYPE=Release --symlink-install")
    assert (answer.code, answer.err) == (0, "")
    assert (package.parents[1] / "install/robot_controller/share/robot_controller/package.xml").is_symlink()


def test_help(package: Path, world: World) -> None:
    answer = colcon(world, "build -h")
    assert (answer.code, answer.err) == (0, "")
    assert answer.out.startswith("usage: colcon build [-h]") and "--packages-select" in answer.out
    assert "verbs:" in colcon(world, "-h").out
    assert colcon(world, "test").code == 1


def test_an_interface_that_changed_takes_its_time(package: Path, world: World) -> None:
    colcon(world)
    change(package / STATUS, "battery", "charge")
    assert "Finished <<< robot_controller [2.70s]" in colcon(world).out


# -- ament_python ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def python_package(tmp_path: Path, world: World, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package that `ros2 pkg create` made."""
    from turtle_lesson.ros.ament.create import create_package

    (tmp_path / "src").mkdir()
    monkeypatch.chdir(tmp_path)
    words = "py_demo --build-type ament_python --node-name my_node --destination-directory src"
    create_package(parse(words.split()))
    return tmp_path / "src/py_demo"


def test_a_python_package(python_package: Path, world: World, tmp_path: Path) -> None:
    answer = colcon(world)
    assert answer.shape == (
        0,
        ["Starting >>> py_demo", "Finished <<< py_demo [0.00s]", "", "Summary: 1 package finished [0.00s]"],
        [""],
    )
    prefix = tmp_path / "install/py_demo"
    for path in (
        "lib/py_demo/my_node", "lib/python3.10/site-packages/py_demo/my_node.py",
        "lib/python3.10/site-packages/py_demo-0.0.0-py3.10.egg-info/entry_points.txt",
        "share/ament_index/resource_index/packages/py_demo", "share/colcon-core/packages/py_demo",
        "share/py_demo/package.xml",
    ):  # fmt: skip
        assert (prefix / path).is_file(), path


def test_entry_points_of_any_group_are_found_by_a_program(
    python_package: Path, world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    change(python_package / "setup.py", "entry_points={", "entry_points={'shapes': ['round = py_demo.my_node:circle'],")
    (python_package / "py_demo/my_node.py").write_text(
        "from importlib.metadata import entry_points\n\n\ndef circle():\n    return 'a circle'\n\n\n"
        "def main():\n    for each in entry_points(group='shapes'):\n        print(each.name, each.load()())\n"
    )
    assert colcon(world).code == 0
    run_line(world, "source install/setup.bash && ros2 run py_demo my_node")
    assert "round a circle" in capsys.readouterr().out.splitlines()


@pytest.mark.parametrize(
    ("file", "old", "new", "code", "said"),
    [
        (
            "setup.py",
            "'my_node = py_demo.my_node:main'",
            "'my_node = py_demo.my_node'",
            1,
            "('Invalid entry point: ', ",
        ),
        ("setup.py", "py_demo.my_node:main", "py_demo.my_nod:main", 0, "Did you mean 'py_demo.my_node'?"),
        ("setup.py", "my_node:main", "my_node:run", 0, "py_demo.my_node has no run()"),
        (
            "setup.py",
            "zip_safe=True,",
            "zip_safe=True",
            1,
            "setup.py: look at this line and at the end of the one before",
        ),
        ("setup.py", "['package.xml']", "['pakage.xml']", 1, "can't copy 'pakage.xml'"),
        (
            "setup.py",
            "('share/' + package_name, ['package.xml']),",
            "",
            0,
            "doesn't explicitly install the 'package.xml' file",
        ),
        ("setup.py", "'share/' + package_name", "'/etc'", 1, "lies outside the package's install folder"),
        ("setup.py", "find_packages(exclude=['test'])", "['nope']", 1, "package directory 'nope' does not exist"),
        ("setup.cfg", "install_scripts", "install_script", 0, "setup.cfg puts programs into bin/"),
        ("setup.py", "import find_packages, setup", "import find_package, setup", 1, "ImportError: cannot import name"),
        ("package.xml", "</package>", "", 0, "package.xml: no element found: line"),
        ("package.xml", "<license>", "<licence>", 0, "colcon takes the folder for a Python package without ROS"),
        ("package.xml", "<license>", "<licence/><license>", 0, "Did you mean 'license'? Until it is corrected"),
        ("package.xml", "0.0.0", "1", 0, "version conventions. A version is three numbers, such as <version>0.1.0"),
    ],
)
def test_a_wrong_python_package(
    python_package: Path, world: World, file: str, old: str, new: str, code: int, said: str
) -> None:
    change(python_package / file, old, new)
    answer = colcon(world)
    assert (answer.code, said in answer.err) == (code, True), answer.err


@pytest.mark.parametrize(
    ("lines", "hint"),
    [
        ("from distutils import log\nlog.set_verbosity(log.INFO)\nlog.info('building %s', 'py_demo')\n", ""),
        ("import distutils.log\ndistutils.log.warn('x')\n", ""),
        ("from setuptools.command.install import install\nclass Mine(install):\n    pass\n", "(cmdclass=…)"),
        ("from setuptools import Command\nclass Mine(Command):\n    user_options = []\n", "(cmdclass=…)"),
    ],
)
def test_a_setup_py_may_use_what_setuptools_brings(python_package: Path, world: World, lines: str, hint: str) -> None:
    given = "package_name, cmdclass={'install': Mine}," if hint else "package_name,"
    change(python_package / "setup.py", "name=package_name,", f"name={given}")
    file = python_package / "setup.py"
    file.write_text(lines + file.read_text())
    answer = colcon(world)
    assert answer.code == 0 and "1 package finished" in answer.out, answer.err
    assert (answer.err == "") if not hint else (hint in answer.err)


@pytest.mark.parametrize(
    ("old", "new"), [("</package>", ""), ("<maintainer", "<maintainr"), ("<name>py_demo", "<name>")]
)
def test_a_package_xml_that_is_refused_leaves_a_plain_python_package(
    python_package: Path, world: World, old: str, new: str
) -> None:
    change(python_package / "package.xml", old, new)
    assert colcon(world, "list").out == "py_demo\tsrc/py_demo\t(python)\n"
    assert colcon(world).code == 0 and source_in(world).code == 0
    assert list(world.packages.get("py_demo").executables) == ["my_node"]
    change(python_package / "setup.py", "('share/ament_index/resource_index/packages',", "('share/nowhere',")
    assert "ros2 does not find py_demo on a robot" in colcon(world).err


def test_without_setup_py(python_package: Path, world: World) -> None:
    (python_package / "setup.py").unlink()
    assert "there is no setup.py in src/py_demo" in colcon(world).err


# -- nonsense --------------------------------------------------------------------------------------------------------------


@given(st.sampled_from(["CMakeLists.txt", "package.xml", STATUS, "srv/NavigateTo.srv"]), st.data())
def test_damaged_files_never_end_in_a_traceback(package: Path, world: World, file: str, data: st.DataObject) -> None:
    good = (package / file).read_bytes()
    place = data.draw(st.integers(0, len(good)))
    junk = data.draw(st.binary(max_size=12) | st.sampled_from([b"(", b"${", b'"', b"<", b"\0", b"[[", b"#[["]))
    try:
        (package / file).write_bytes(good[:place] + junk + good[place + data.draw(st.integers(0, 40)) :])
        answer = colcon(world)
    finally:
        (package / file).write_bytes(good)
    assert answer.code in {0, 1, 2}
    assert "Traceback" not in answer.err


ODD_WORDS = st.lists(
    st.text(max_size=8)
    | st.sampled_from(["build", "list", "--base-paths", "--packages-select", "--event-handlers", "-h", "x" * 10_000])
    | st.sampled_from(["--parallel-workers", "-1", "\0", "--packages-up-to", "--executor"]),
    max_size=5,
)


@given(ODD_WORDS)
def test_odd_words_are_answered(tmp_path: Path, world: World, words: list[str]) -> None:
    folder = tmp_path / "empty"
    folder.mkdir(exist_ok=True)
    out, err = io.StringIO(), io.StringIO()
    code = run(world, words, stdout=out, stderr=err, cwd=folder)
    assert code in {0, 1, 2}
    assert code == 0 or out.getvalue() or err.getvalue()
    assert len(err.getvalue()) < 6000


@pytest.mark.parametrize("line", ["build --base-paths a\0b", "build --install-base a\0b"])
def test_folders_that_cannot_be(tmp_path: Path, world: World, line: str) -> None:
    out, err = io.StringIO(), io.StringIO()
    assert run(world, line.split(" "), stdout=out, stderr=err, cwd=tmp_path) == 1
    assert err.getvalue().splitlines()[-1].startswith("[0.200s] ERROR:colcon:colcon ")


def test_a_folder_whose_name_is_too_long_is_not_there(tmp_path: Path, world: World) -> None:
    out, err = io.StringIO(), io.StringIO()
    assert run(world, ["list", "--base-paths", "x" * 5000], stdout=out, stderr=err, cwd=tmp_path) == 0
    assert re.search(r"the base path 'x{100}' doesn't exist$", err.getvalue())


def test_a_python_package_brings_what_ament_cmake_core_has(package: Path, world: World) -> None:
    change(package / CMAKE, "find_package(ament_cmake REQUIRED)\nfind_package(rosidl_default_generators REQUIRED)", "")
    text = (package / CMAKE).read_text()
    (package / CMAKE).write_text(text.replace(text[text.index("rosidl_generate") : text.index("install(PROGRAMS")], ""))
    assert 'Unknown CMake command "ament_package"' in colcon(world).err
    (package / "tools").mkdir()
    (package / "tools/__init__.py").touch()
    package_of_tools = "find_package(ament_cmake_python REQUIRED)\nament_python_install_package(tools)\n"
    change(package / CMAKE, "ament_package()", f"{package_of_tools}ament_package()")
    answer = colcon(world)
    assert answer.code == 0, answer.err


# -- C++ -------------------------------------------------------------------------------------------------------------------

CPP = {
    "plain": """
        find_package(rclcpp REQUIRED)
        add_executable(fast src/fast.cpp)
        ament_target_dependencies(fast rclcpp)
        add_library(arm SHARED src/arm.cpp)
        target_include_directories(arm PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>)
        install(TARGETS fast arm EXPORT export_arm DESTINATION lib/${PROJECT_NAME})
        """,
    "of packages that are not here": """
        find_package(OpenCV REQUIRED)
        find_package(odd_vendor REQUIRED)
        add_library(arm src/arm.cpp)
        odd_vendor_library(arm)
        add_executable(fast src/fast.cpp)
        include(odd_vendor_macros)
        """,
}


@pytest.mark.parametrize("name", CPP)
def test_cpp_is_left_out_and_all_else_is_built(package: Path, world: World, name: str) -> None:
    change(package / CMAKE, "# line 10", CPP[name])
    add(package, "bringup", "robot_controller")
    answer = colcon(world)
    assert answer.code == 0 and "2 packages finished" in answer.out
    head, line = answer.err.splitlines()
    assert head.startswith("Warning: C++ is not compiled here. All else of these packages was built")
    assert line.startswith("  robot_controller: without ") and line.endswith("; needed by bringup")
    assert set(re.findall(r"fast|arm", line)) == {"fast", "arm"}
    assert ("needs OpenCV, odd_vendor, not here" in line) == (name == "of packages that are not here")
    source_in(world)
    found = world.packages.get("robot_controller")
    assert list(found.executables) == ["navigator"]
    assert found.interfaces == ["msg/TurtleStatus.msg", "srv/NavigateTo.srv"]
    assert found.shared_files("start_system.launch.py")
    with pytest.raises(CompiledProgramError) as caught:
        world.packages.executable("robot_controller", "fast")
    assert re.match(r"fast is a C\+\+ program \(CMakeLists.txt, line \d+\)", caught.value.hint)


def test_several_packages_in_cpp_are_named_in_one_warning(package: Path, world: World) -> None:
    many = "\n".join(f"add_executable(p{number} p.cpp)" for number in range(11))
    for name, text in {"one": "add_executable(a a.cpp)", "two": many}.items():
        add(package, name, text=OTHER.format(name=name, find=text))
    assert colcon(world).err.splitlines()[1:] == [
        "  one: without a",
        "  two: without p0, p1, p2, p3, p4, p5, p6, p7, p8, p9, p10",
    ]


def test_mistakes_beside_cpp_are_still_found(package: Path, world: World) -> None:
    change(package / CMAKE, "# line 10", "find_package(OpenCV REQUIRED)\nadd_executable(fast src/fast.cpp)")
    change(package / CMAKE, "ament_package()", "ament_pakage()")
    assert 'Unknown CMake command "ament_pakage"' in colcon(world).err
    change(package / CMAKE, "ament_pakage()", "find_package(sensor_mgs REQUIRED)\nament_package()")
    assert "Did you mean 'sensor_msgs'?" in colcon(world).err


def test_a_package_of_files_may_ask_for_what_only_robots_have(package: Path, world: World) -> None:
    change(package / CMAKE, "# line 10", "find_package(gazebo_ros REQUIRED)\nfind_package(urdf REQUIRED)")
    answer = colcon(world)
    assert (answer.code, answer.err.splitlines()[1:]) == (0, ["  robot_controller: needs gazebo_ros, urdf, not here"])


def test_a_script_that_is_not_python_is_left_out(package: Path, world: World) -> None:
    (package / "run.sh").write_text("#!/bin/bash\necho hello\n")
    change(
        package / CMAKE, "ament_package()", "install(PROGRAMS run.sh DESTINATION lib/${PROJECT_NAME})\nament_package()"
    )
    assert colcon(world).err.splitlines()[1:] == ["  robot_controller: without run.sh"]
    source_in(world)
    assert list(world.packages.get("robot_controller").executables) == ["navigator"]
