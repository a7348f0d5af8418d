"""Several packages and `colcon`'s options: which are taken, where they go, what they hide."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from command_cases import cases
from workspace_cases import XML, change, colcon, make_package, parse, source_in, started, timeless

import turtle_lesson
from turtle_lesson.ros.ament import setup_py
from turtle_lesson.ros.ament.create import create_package
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World

CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject({0})\nfind_package(ament_cmake REQUIRED)\nament_package()\n"


def add(folder: Path, needs: str = "", tag: str = "depend") -> None:
    """An empty package of the folder's name."""
    folder.mkdir(parents=True)
    xml = XML.replace("robot_controller", folder.name)
    need = f"<{tag}>{needs}</{tag}>" if needs else ""
    (folder / "package.xml").write_text(xml.replace("<depend>rclpy</depend>", need))
    (folder / "CMakeLists.txt").write_text(CMAKE.format(folder.name))


def make_python_package(destination: str) -> None:
    """py_demo, with one program."""
    line = f"py_demo --build-type ament_python --node-name hello --destination-directory {destination}"
    create_package(parse(line.split()))


@pytest.fixture
def four(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Packages a to e, one inside of another, which nobody finds, and one that is marked to be ignored."""
    monkeypatch.chdir(tmp_path)
    add(tmp_path / "src/a")
    add(tmp_path / "src/b", "a")
    add(tmp_path / "src/c", "b")
    add(tmp_path / "src/c/inner")
    add(tmp_path / "src/deep/d/e", "a", "exec_depend")
    add(tmp_path / "src/ignored")
    (tmp_path / "src/ignored/COLCON_IGNORE").touch()
    return tmp_path / "src"


@pytest.mark.parametrize("case", list(cases("colcon_packages.txt")), ids=lambda case: case.command)
def test_the_real_colcons_words(four: Path, world: World, case: object) -> None:
    answer = colcon(world, case.command.partition(" ")[2])  # type: ignore[attr-defined]
    expected = (case.code, timeless(case.stdout), timeless(case.stderr))  # type: ignore[attr-defined]
    code, out, err = answer.shape
    assert (code, out, [line.partition("] ERROR")[2] or line for line in err]) == (
        *expected[:2],
        [line.partition("] ERROR")[2] or line for line in expected[2]],
    )


def test_a_circle_names_all_that_cannot_be_built(four: Path, world: World) -> None:
    change(
        four / "a/package.xml",
        "<exec_depend>rosidl_default_runtime",
        "<depend>c</depend><exec_depend>rosidl_default_runtime",
    )
    lines = ["a: ['b', 'c']", "b: ['a', 'c']", "c: ['a', 'b']", "e: ['a', 'b', 'c']"]  # as recorded
    for verb in ("build", "list"):
        answer = colcon(world, verb)
        assert (answer.code, answer.err.splitlines()[1:]) == (1, lines), verb


@pytest.mark.parametrize("word", ["--log-level=info list", "--log-base=x list", "--log-level info list"])
def test_words_before_the_verb(four: Path, world: World, word: str) -> None:
    assert colcon(world, word).code == 0


def test_verbs_that_are_not_there_say_what_is(four: Path, world: World) -> None:
    assert "python -m pytest src/<package>/test" in colcon(world, "test").err
    assert "build and list are." in colcon(world, "info a").err
    for verb in ("test", "info", "test-result", "metadata", "version-check"):
        answer = colcon(world, verb)
        assert (answer.code, len(answer.err.splitlines())) == (1, 1)


def test_a_package_that_is_sourced_need_not_be_built_again(four: Path, world: World) -> None:
    assert colcon(world, "build --packages-select a --install-base below").code == 0
    assert colcon(world, "build --packages-select b").code == 1
    source_in(world, "below/setup.bash")
    assert colcon(world, "build --packages-select b").code == 0


def test_a_package_of_a_course_is_built_from_its_sources_without_a_word(four: Path, world: World) -> None:
    """px4_msgs of another release than the lesson's own: a robot has none, so that nothing is hidden, and it counts."""
    add(four / "px4_msgs", "rosidl_default_generators", "build_depend")
    group = "<member_of_group>rosidl_interface_packages</member_of_group>"
    change(four / "px4_msgs/package.xml", "<export>", f"{group}<export>")
    every = "file(GLOB all RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} msg/*.msg)\nrosidl_generate_interfaces(${PROJECT_NAME} ${all})"
    generators = "find_package(rosidl_default_generators REQUIRED)"
    change(four / "px4_msgs/CMakeLists.txt", "ament_package()", f"{generators}\n{every}\nament_package()")
    (four / "px4_msgs/msg").mkdir()
    (four / "px4_msgs/msg/GotoSetpoint.msg").write_text("uint64 timestamp\nfloat32[3] position\n")
    (four / "px4_msgs/msg/OffboardControlMode.msg").write_text("uint64 timestamp\nbool direct_actuator\n")
    answer = colcon(world, "build --packages-select px4_msgs")
    assert (answer.code, answer.err) == (0, "")
    source_in(world, "install/setup.bash")
    assert registry.package("px4_msgs").interface_names() == ["msg/GotoSetpoint", "msg/OffboardControlMode"]
    world.close()
    assert "# µs since" in registry.text("px4_msgs", "msg/ActuatorMotors", comments=True)  # the lesson's own again


# -- layouts -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """robot_controller, in a workspace that is the current folder."""
    monkeypatch.chdir(tmp_path)
    return make_package(tmp_path)


@pytest.fixture(autouse=True)
def clean(world: World) -> Iterator[None]:
    """Nothing is left over."""
    before = list(sys.path)
    yield
    world.close()
    assert sys.path == before


def test_one_folder_for_all(package: Path, world: World, tmp_path: Path) -> None:
    add(tmp_path / "src/other", "robot_controller")
    make_python_package("src")
    assert colcon(world, "build --merge-install").code == 0
    assert (tmp_path / "install/lib/robot_controller/navigator").is_file()
    assert (tmp_path / "install/share/other/package.xml").is_file()
    source_in(world)
    assert started(world, "robot_controller", "navigator").startswith("navigator")
    assert started(world, "py_demo", "hello") == "Hi from py_demo.\n"
    change(package / "CMakeLists.txt", "RENAME navigator", "RENAME driver")
    change(package / "msg/TurtleStatus.msg", "battery", "charge")
    assert colcon(world, "build --merge-install --packages-select robot_controller").code == 0
    assert not (tmp_path / "install/lib/robot_controller/navigator").exists()
    assert "'charge'" in started(world, "robot_controller", "driver")
    assert started(world, "py_demo", "hello") == "Hi from py_demo.\n"


def test_layouts_do_not_mix(package: Path, world: World) -> None:
    colcon(world)
    answer = colcon(world, "build --merge-install")
    assert answer.code == 1
    assert answer.err.endswith(
        "ERROR:colcon:colcon build: The install directory 'install' was created with the layout 'isolated'. Please remove "
        "the install directory, pick a different one or remove the '--merge-install' option.\n"
    )  # recorded


def test_a_build_deletes_what_it_has_installed_and_nothing_else(package: Path, world: World, tmp_path: Path) -> None:
    colcon(world)
    mine = tmp_path / "install/robot_controller/share/robot_controller/mine.txt"
    mine.write_text("kept")
    outside = tmp_path / "outside.txt"
    outside.write_text("kept")
    manifest = tmp_path / "build/robot_controller/install_manifest.txt"
    manifest.write_text(manifest.read_text() + "../../outside.txt\n")
    change(package / "CMakeLists.txt", "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})", "")
    colcon(world)
    assert not (tmp_path / "install/robot_controller/share/robot_controller/launch").exists()
    assert mine.read_text() == outside.read_text() == "kept"


def status() -> list[str]:
    """The fields of the message that an import finds now."""
    return list(importlib.import_module("robot_controller.msg").TurtleStatus.get_fields_and_field_types())


def test_links_are_for_code_and_not_for_new_fields(package: Path, world: World) -> None:
    node = package / "robot_controller/navigator_node.py"
    node.chmod(0o755)
    colcon(world, "build --symlink-install")
    source_in(world)
    change(node, "'navigator'", "'new code'")
    assert started(world, "robot_controller", "navigator").startswith("new code")
    change(package / "msg/TurtleStatus.msg", "battery", "charge")
    source_in(world)
    assert status()[-1] == "battery"
    colcon(world, "build --symlink-install")
    source_in(world)
    assert status()[-1] == "charge"


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such mode")
def test_a_link_to_what_cannot_be_run(package: Path, world: World) -> None:
    answer = colcon(world, "build --symlink-install")
    assert "!chmod +x src/robot_controller/robot_controller/navigator_node.py" in answer.err
    source_in(world)
    with pytest.raises(
        LookupError, match=r"not found on the libexec directory .* The file exists, but is not executable: !chmod"
    ):
        world.packages.executable("robot_controller", "navigator")


def test_old_messages_stay_what_they_were(package: Path, world: World) -> None:
    colcon(world)
    source_in(world)
    old_class = importlib.import_module("robot_controller.msg").TurtleStatus
    old = old_class(battery=3.0)
    change(package / "msg/TurtleStatus.msg", "float32 battery", "uint8 lives 9")
    colcon(world)
    source_in(world)
    new = importlib.import_module("robot_controller.msg").TurtleStatus()
    assert (old.battery, new.lives) == (3.0, 9)
    assert repr(old).endswith("battery=3.0)") and old != new


# -- ament_python as it lies there ---------------------------------------------------------------------------------------


@pytest.fixture
def py_demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A Python package with a launch folder."""
    monkeypatch.chdir(tmp_path)
    make_python_package(".")
    folder = tmp_path / "py_demo"
    (folder / "launch").mkdir()
    (folder / "launch/all.launch.py").write_text("")
    change(
        folder / "setup.py",
        "['package.xml']),",
        "['package.xml']),\n('share/' + package_name, ['launch/all.launch.py']),",
    )
    return folder


def test_a_python_package_can_be_used_where_it_lies(py_demo: Path) -> None:
    lesson = turtle_lesson.start(package=py_demo, simulator=False)
    world = lesson._world
    assert started(world, "py_demo", "hello") == "Hi from py_demo.\n"
    change(py_demo / "py_demo/hello.py", "Hi from", "Bye from")
    assert started(world, "py_demo", "hello") == "Bye from py_demo.\n"
    assert world.packages.get("py_demo").shared_files("all.launch.py") == [py_demo / "launch/all.launch.py"]
    assert importlib.import_module("py_demo.hello").main
    world.close()
    assert "py_demo.hello" not in sys.modules
    assert "py_demo" not in registry.packages()


def test_a_python_package_that_no_build_would_take(py_demo: Path) -> None:
    change(py_demo / "setup.py", "zip_safe=True,", "zip_safe=True")
    with pytest.raises(ValueError, match=r"(?s)a real build would refuse py_demo:.*is a comma or a bracket missing"):
        turtle_lesson.start(package=py_demo, simulator=False)


def test_modules_may_lie_in_a_folder_of_their_own(py_demo: Path, world: World) -> None:
    (py_demo / "lib").mkdir()
    (py_demo / "py_demo").rename(py_demo / "lib/py_demo")
    change(py_demo / "setup.py", "find_packages(exclude=['test'])", "find_packages('lib'), package_dir={'': 'lib'}")
    answer = colcon(world)
    assert (answer.code, answer.err) == (0, "")
    source_in(world)
    assert started(world, "py_demo", "hello") == "Hi from py_demo.\n"


def with_tools(py_demo: Path, listed: str) -> None:
    """Give the package a subpackage that its program needs, data files and a script; `listed` is what setup.py says."""
    (py_demo / "py_demo/tools").mkdir()
    (py_demo / "py_demo/tools/__init__.py").write_text("")
    (py_demo / "py_demo/tools/names.py").write_text("WHO = 'tools'\n")
    (py_demo / "py_demo/tools/words.txt").write_text("some words")
    (py_demo / "scripts").mkdir()
    for name in ("greet.py", "wave.py"):
        (py_demo / "scripts" / name).write_text("print('Hi from a script.')\n")
        (py_demo / "scripts" / name).chmod(0o755)
    change(py_demo / "setup.py", "find_packages(exclude=['test'])", listed)
    hello = py_demo / "py_demo/hello.py"
    hello.write_text("from py_demo.tools.names import WHO\n" + hello.read_text())


@pytest.mark.parametrize("name", ["py_demo.tools", "py_demo/tools"])
def test_a_subpackage_is_installed_if_it_is_listed(py_demo: Path, world: World, name: str) -> None:
    listed = f"['py_demo', {name!r}], package_data={{'py_demo.tools': ['*.txt']}}, scripts=['scripts/greet.py']"
    with_tools(py_demo, listed)
    change(py_demo / "setup.py", "data_files=[", "data_files=[('lib/py_demo', ['scripts/wave.py']),")
    answer = colcon(world)
    assert (answer.code, answer.err) == (0, "")
    source_in(world)
    assert started(world, "py_demo", "hello") == "Hi from py_demo.\n"
    assert started(world, "py_demo", "greet.py") == started(world, "py_demo", "wave.py") == "Hi from a script.\n"
    installed = next(Path("install/py_demo/lib").glob("python*/site-packages/py_demo/tools"))
    assert sorted(path.name for path in installed.iterdir()) == ["__init__.py", "names.py", "words.txt"]


def test_scripts_run_where_they_lie(py_demo: Path) -> None:
    with_tools(py_demo, "['py_demo', 'py_demo.tools'], scripts=['scripts/greet.py']")
    lesson = turtle_lesson.start(package=py_demo, simulator=False)
    assert started(lesson._world, "py_demo", "greet.py") == "Hi from a script.\n"
    assert started(lesson._world, "py_demo", "hello") == "Hi from py_demo.\n"
    lesson._world.close()


def test_a_subpackage_that_is_not_listed_is_left_out(
    py_demo: Path, world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    with_tools(py_demo, "['py_demo']")
    assert run_line(world, "colcon build && source install/setup.bash && ros2 run py_demo hello") == 1
    said = capsys.readouterr()
    assert "ModuleNotFoundError: No module named 'py_demo.tools'" in said.out + said.err
    assert "but not in setup.py: write packages=find_packages(), and build again" in said.out + said.err

    assert run_line(world, "colcon build --symlink-install && ros2 run py_demo hello") == 0


SETUP = "from setuptools import setup\nsetup(name='py_demo', {})\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("while True:\n    pass\n", "setup.py did not end within 3 s: is there a loop in it"),
        ("import os\nos._exit(4)\n", "never calls setup(…) and ended Python with exit code 4"),
        ("input()\n", "EOFError"),
        ("def f():\n    f()\nf()\n", "RecursionError"),
        ("\0", "SyntaxError"),
        (SETUP.format("packages='py_demo'"), "'packages' cannot have 'py_demo'"),
        (SETUP.format("py_modules=['x']"), "py_modules=… is not carried out in this simulation"),
        (SETUP.format("packages=['py_demo'], package_dir={'': '../..'}"), "lies outside the package's folder"),
        (SETUP.format("data_files=[(1, 2)]"), "It looks like data_files=[('share/py_demo', ['package.xml'])]."),
        (SETUP.format("data_files={'a': 1}"), "It looks like data_files=[('share/py_demo', ['package.xml'])]."),
        (SETUP.format("data_files=[3, None]"), "It looks like data_files=[('share/py_demo', ['package.xml'])]."),
        (
            SETUP.format("data_files=[('share/py_demo', 'setup.py')]"),
            "It looks like data_files=[('share/py_demo', ['package.xml'])].",
        ),
        (
            SETUP.format("data_files=[('share/py_demo', [__import__('os').path.abspath('setup.cfg')])]"),
            "relative to the folder of setup.py",
        ),
        (SETUP.format("entry_points={'console_scripts': 5}"), "Invalid entry point"),
        (
            SETUP.format("entry_points=[5]"),
            "It looks like entry_points={'console_scripts': ['my_node = py_demo.my_node:main']}.",
        ),
        (
            SETUP.format("entry_points='[console_scripts]'"),
            "It looks like entry_points={'console_scripts': ['my_node = py_demo.my_node:main']}.",
        ),
    ],
)
def test_a_setup_py_full_of_nonsense(
    py_demo: Path, world: World, monkeypatch: pytest.MonkeyPatch, text: str, said: str
) -> None:
    monkeypatch.setattr(setup_py, "LONGEST", 3.0)
    (py_demo / "setup.py").write_text(text)
    answer = colcon(world)
    assert (answer.code, said in answer.err) == (1, True), answer.err


def test_a_program_may_lie_in_a_file_whose_name_no_import_takes(
    py_demo: Path, world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    change(py_demo / "setup.py", "py_demo.hello:main", "py_demo.2_hellos:main")
    (py_demo / "py_demo/hello.py").rename(py_demo / "py_demo/2_hellos.py")
    assert run_line(world, "colcon build && source install/setup.bash && ros2 run py_demo hello") == 0
    assert "Hi from py_demo." in capsys.readouterr().out
