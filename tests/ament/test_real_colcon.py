"""Debian's colcon, ament_cmake and rosidl really build the finished package and a learner's one.

Debian lacks `rosidl_default_generators`, so a stand-in lies beside the package, which asks for the generators that Debian
has. Nothing of this is shipped. `apt-get install` of PACKAGES makes it run; CI does so.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
from test_workspace_build import BROKEN
from workspace_cases import XML, change, colcon, make_package, parse

from turtle_lesson import start
from turtle_lesson.ros.ament.create import create_package
from turtle_lesson.ros.ament.manifest import faults_in
from turtle_lesson.ros.runtime.world import open_world

PACKAGES = "colcon python3-colcon-ros python3-colcon-bash python3-colcon-output ament-cmake rosidl-core g++ make"
PYTHON = "/usr/bin/python3"
missing = [tool for tool in ("colcon", "cmake", "g++") if not Path("/usr/bin", tool).exists()]
missing += (
    [] if Path("/usr/share/rosidl_generator_cpp").is_dir() and Path("/usr/share/ament_cmake").is_dir() else ["rosidl"]
)
pytestmark = pytest.mark.skipif(
    bool(missing) and "CI" not in os.environ,
    reason=f"there is no {', '.join(missing)} here: on Debian, apt-get install {PACKAGES}",
)

STAND_IN = """\
cmake_minimum_required(VERSION 3.8)
project(rosidl_default_generators NONE)
find_package(ament_cmake REQUIRED)
ament_export_dependencies(rosidl_cmake rosidl_generator_c rosidl_generator_cpp rosidl_typesupport_introspection_c
  rosidl_typesupport_introspection_cpp)
ament_package()
"""
STAND_IN_XML = """\
<package format="3">
  <name>rosidl_default_generators</name>
  <version>0.0.0</version>
  <description>Stands for the package that Debian lacks</description>
  <maintainer email="turtle-lesson@example.org">Turtle Lesson</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


def real(words: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a program of the system's, and nothing of the virtual environment's."""
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "LANG": "C.UTF-8"}
    return subprocess.run(
        words.split(), cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False
    )


@pytest.fixture(scope="module")
def generators(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The setup file of a workspace in which the stand-in is built."""
    workspace = tmp_path_factory.mktemp("generators")
    folder = workspace / "src/rosidl_default_generators"
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(STAND_IN_XML)
    (folder / "CMakeLists.txt").write_text(STAND_IN)
    done = real(f"{PYTHON} /usr/bin/colcon build", workspace)
    assert done.returncode == 0, done.stdout + done.stderr
    return workspace / "install/local_setup.bash"


def build(workspace: Path, generators: Path) -> subprocess.CompletedProcess[str]:
    """`colcon build` in a shell where the stand-in was sourced."""
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(workspace), "LANG": "C.UTF-8"}
    command = ["/bin/bash", "-c", f". {generators}; {PYTHON} /usr/bin/colcon build"]
    return subprocess.run(
        command, cwd=workspace, env=environment, capture_output=True, text=True, timeout=300, check=False
    )


def check_installed(workspace: Path, programs: list[str], launch_file: str) -> None:
    """Everything of robot_controller is there: headers and libraries, programs, the launch file, the index."""
    prefix = workspace / "install/robot_controller"
    headers = prefix / "include/robot_controller/robot_controller"
    for name in ("msg/turtle_status", "srv/navigate_to"):
        assert (headers / f"{name}.h").is_file() and (headers / f"{name}.hpp").is_file()
    libraries = {path.name for path in (prefix / "lib").glob("*.so")}
    assert {
        f"librobot_controller__rosidl_{each}.so" for each in ("generator_c", "typesupport_introspection_c")
    } <= libraries
    assert sorted(path.name for path in (prefix / "lib/robot_controller").iterdir()) == programs
    assert all(os.access(prefix / "lib/robot_controller" / name, os.X_OK) for name in programs)
    assert (prefix / "share/robot_controller/launch" / launch_file).is_file()
    index = prefix / "share/ament_index/resource_index"
    assert (index / "packages/robot_controller").is_file()
    interfaces = (index / "rosidl_interfaces/robot_controller").read_text().splitlines()
    assert {"msg/TurtleStatus.msg", "srv/NavigateTo.srv"} <= set(interfaces)


@pytest.fixture(autouse=True)
def learners_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Our own commands change files in the current folder only."""
    monkeypatch.chdir(tmp_path)


def test_the_finished_package(tmp_path: Path, generators: Path) -> None:
    start(simulator=False).export("robot_controller", to=tmp_path)
    result = build(tmp_path, generators)
    assert result.returncode == 0, result.stdout + result.stderr
    assert result.stderr == ""
    check_installed(tmp_path, ["navigator", "obstacle_detector", "status_monitor"], "start_system.launch.py")


def test_a_learners_package(tmp_path: Path, generators: Path) -> None:
    """As the lesson has it: pkg create, definitions, programs and the launch file beside, then what a page adds."""
    (tmp_path / "src").mkdir()
    line = f"robot_controller --build-type ament_cmake --destination-directory {tmp_path}/src"
    create_package(parse(line.split()))
    folder = tmp_path / "src/robot_controller"
    template = make_package(tmp_path / "template")
    for name in ("msg", "srv", "launch", "robot_controller"):
        shutil.copytree(template / name, folder / name)
    change(
        folder / "CMakeLists.txt",
        "\nament_package()\n",
        """
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME}
  "msg/TurtleStatus.msg"
  "srv/NavigateTo.srv"
)
install(PROGRAMS robot_controller/navigator_node.py DESTINATION lib/${PROJECT_NAME} RENAME navigator)
install(PROGRAMS robot_controller/navigator_node.py DESTINATION lib/${PROJECT_NAME} RENAME status_monitor)
install(PROGRAMS robot_controller/navigator_node.py DESTINATION lib/${PROJECT_NAME} RENAME obstacle_detector)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
""",
    )
    group = "  <buildtool_depend>rosidl_default_generators</buildtool_depend>\n"
    group += "  <member_of_group>rosidl_interface_packages</member_of_group>\n\n  <export>"
    change(folder / "package.xml", "  <export>", group)
    # ament_lint_auto, which pkg create asks for where tests are built, is nothing that Debian has.
    change(folder / "CMakeLists.txt", "if(BUILD_TESTING)", "if(FALSE)")
    exported = start(simulator=False).export(folder, to=tmp_path / "robot")
    result = build(exported.folder, generators)
    assert result.returncode == 0, result.stdout + result.stderr
    check_installed(exported.folder, ["navigator", "obstacle_detector", "status_monitor"], "start_system.launch.py")


def test_an_ament_python_package(tmp_path: Path) -> None:
    line = f"py_demo --build-type ament_python --node-name hello --destination-directory {tmp_path}/src"
    (tmp_path / "src").mkdir()
    create_package(parse(line.split()))
    result = real(f"{PYTHON} /usr/bin/colcon build", tmp_path)
    assert result.returncode == 0, result.stdout + result.stderr
    program = tmp_path / "install/py_demo/lib/py_demo/hello"
    assert os.access(program, os.X_OK)
    said = subprocess.run(
        ["/bin/bash", "-c", f". {tmp_path}/install/setup.bash; {program}"],
        env={"PATH": "/usr/bin:/bin"}, capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    assert said.stdout == "Hi from py_demo.\n"


@pytest.mark.parametrize("line", ["build", "build --symlink-install"])
def test_a_workspace_that_was_built_here(tmp_path: Path, generators: Path, line: str) -> None:
    """The whole folder comes to a robot, with the build, install and log of the lesson's own colcon in it."""
    start(simulator=False).export("robot_controller", to=tmp_path)
    words = "py_demo --build-type ament_python --node-name hello --destination-directory src"
    create_package(parse(words.split()))
    world = open_world()
    assert [colcon(world, line).code, colcon(world, line).code] == [0, 0]
    assert {"build", "install", "log"} <= {path.name for path in tmp_path.iterdir()}
    sources = {path: path.read_bytes() for path in (tmp_path / "src").rglob("*") if path.is_file()}
    result = build(tmp_path, generators)
    assert result.returncode == 0, result.stdout + result.stderr
    check_installed(tmp_path, ["navigator", "obstacle_detector", "status_monitor"], "start_system.launch.py")
    assert (tmp_path / "build/robot_controller/CMakeCache.txt").is_file()
    assert os.access(tmp_path / "install/py_demo/lib/py_demo/hello", os.X_OK)
    assert {path: path.read_bytes() for path in sources} == sources
    again = build(tmp_path, generators)
    assert again.returncode == 0, again.stdout + again.stderr


ALIKE = [
    "find_package of a package that is not there", "a default value that is none", "a file that is not there",
    "without member_of_group", "package.xml is cut off", "another name in project()", "a command that is none",
    "an unknown build_type", "no maintainer",
]  # fmt: skip


@pytest.mark.parametrize("name", ALIKE)
def test_what_is_wrong_is_said_alike(tmp_path: Path, generators: Path, name: str) -> None:
    """Every word of our message, advice and places left out, is in the real one, and the exit codes are the same."""
    BROKEN[name](make_package(tmp_path))
    theirs = build(tmp_path, generators)
    shutil.rmtree(tmp_path / "build", ignore_errors=True)
    ours = colcon(open_world())
    assert ours.code == theirs.returncode
    said = [line for line in ours.err.splitlines() if not line.startswith("Hint: ") and "/share/" not in line]
    unsaid = words("\n".join(said)) - words(theirs.stderr)
    assert {word for word in unsaid if "/" not in word and "[" not in word} == set(), theirs.stderr


def words(text: str) -> set[str]:
    """The words of a text, without signs at their ends; rosidl_adapter's arguments are left out of ours."""
    return {word.strip("().:'\"") for word in text.split() if not re.fullmatch(r"[\d.,:()s\]]+", word)}


WRONG = {
    "no maintainer": lambda text: text.replace('  <maintainer email="user@example.org">user</maintainer>\n', ""),
    "no e-mail": lambda text: text.replace(' email="user@example.org"', ""),
    "an odd e-mail": lambda text: text.replace("user@example.org", "user"),
    "no version": lambda text: text.replace("  <version>0.0.0</version>\n", ""),
    "an odd version": lambda text: text.replace("0.0.0", "1.0"),
    "an odd name": lambda text: text.replace("<name>robot", "<name>my robot"),
    "two names": lambda text: text.replace("  <license>", "  <name>x</name>\n  <license>"),
    "no licence": lambda text: text.replace("  <license>Apache-2.0</license>\n", ""),
    "an empty licence": lambda text: text.replace("Apache-2.0", ""),
    "no description": lambda text: text.replace("A package for tests", ""),
    "an unknown tag": lambda text: text.replace("<depend>rclpy</depend>", "<dependd>rclpy</dependd>"),
    "named twice": lambda text: text.replace("<depend>rclpy</depend>", "<depend>rosidl_default_runtime</depend>"),
    "itself": lambda text: text.replace("<depend>rclpy</depend>", "<exec_depend>robot_controller</exec_depend>"),
    "an older format": lambda text: text.replace('format="3"', 'format="2"'),
    "two exports": lambda text: text.replace("<export>", "<export/><export>"),
    "an author's odd e-mail": lambda text: text.replace("  <license>", '  <author email="x">x</author>\n  <license>'),
    "the same twice": lambda text: text.replace("<depend>rclpy", "<depend>rclpy</depend><depend>rclpy"),
    "another outermost tag": lambda text: text.replace("package format", "pack format").replace(
        "</package>", "</pack>"
    ),
    "nothing": lambda text: text,
}
CATKIN = """\
import json, sys
from catkin_pkg.package import InvalidPackage, parse_package_string
said = {}
for name, text in json.load(open(sys.argv[1])).items():
    try:
        parse_package_string(text, 'package.xml')
        said[name] = ''
    except InvalidPackage as error:
        said[name] = str(error)
print(json.dumps(said))
"""


@pytest.fixture(scope="module")
def refused(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What the real reader says of each wrong package.xml, by its name."""
    folder = tmp_path_factory.mktemp("catkin")
    (folder / "texts.json").write_text(json.dumps({name: spoil(XML) for name, spoil in WRONG.items()}))
    (folder / "ask.py").write_text(CATKIN)
    done = real(f"{PYTHON} {folder}/ask.py {folder}/texts.json", folder)
    assert done.returncode == 0, done.stderr
    said: dict[str, str] = json.loads(done.stdout)
    return said


@pytest.mark.parametrize("name", WRONG)
def test_our_reader_refuses_what_catkin_pkg_refuses(refused: dict[str, str], name: str) -> None:
    text = WRONG[name](XML)
    assert (text == XML) == (name == "nothing")
    said = refused[name]
    ours = faults_in(ElementTree.fromstring(text))
    assert bool(ours) == bool(said), (ours, said)
    for fault in ours:
        assert fault in said
