"""A file of the learner's is written whole or not at all, and a command changes nothing outside the learner's folder."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from turtle_lesson import start
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.generator import _user_folder
from turtle_lesson.ros.runtime import files
from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.session.lesson import underlay_packages
from turtle_lesson.teaching import main

Type = Callable[[str], tuple[int, str, str]]


@pytest.fixture(autouse=True)
def nothing_is_deleted_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """For this computer's sake, should a test fail: what deletes and moves stops at all but temporary and cached files."""
    free = [os.path.realpath(each) for each in (tempfile.gettempdir(), _user_folder())]

    def stopping(work: Callable[..., object]) -> Callable[..., object]:
        def safe(path: str | Path, *more: object, **options: object) -> object:
            place = Path(os.path.realpath(Path(path).parent))
            assert options.get("dir_fd") is not None or any(place.is_relative_to(each) for each in free), path
            return work(path, *more, **options)

        return safe

    monkeypatch.setattr(shutil, "rmtree", stopping(shutil.rmtree))
    for name in ("unlink", "rmdir", "replace", "rename"):
        monkeypatch.setattr(os, name, stopping(getattr(os, name)))


# -- writing whole or not at all ---------------------------------------------------------------------------------------


def test_an_interrupt_leaves_the_old_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "node.py"
    files.write(file, "old")

    def interrupted(self: Path, text: str, **options: object) -> int:
        self.touch()
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_text", interrupted)
    with pytest.raises(KeyboardInterrupt):
        files.write(file, "new")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("node.py", "old")]


def test_permissions_and_links_stay(tmp_path: Path) -> None:
    file, link = tmp_path / "src" / "node.py", tmp_path / "link.py"
    files.write(file, "old")
    file.chmod(0o755)
    link.symlink_to(file)
    files.write(link, "new")
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert os.name == "nt" or file.stat().st_mode & 0o777 == 0o755


# -- a learner's folder, with files beside it, and with links that lead out ----------------------------------------------

PACKAGE_XML = """<?xml version="1.0"?>
<package format="3"><name>{name}</name><version>0.0.1</version><description>x</description>
<maintainer email="a@example.org">a</maintainer><license>MIT</license>
<buildtool_depend>ament_cmake</buildtool_depend><export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
install(PROGRAMS node.py DESTINATION lib/${{PROJECT_NAME}} RENAME node)
install(DIRECTORY data DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""

TEXTS = (
    "mine/a", "mine/inner/a", "mine/inner/b/a", "mine/00_welcome.ipynb", "mine/lab.ipynb", "outside/kept.txt",
    "outside/folder/a", "outside/folder/kept.txt", "outside/folder/__pycache__/a.pyc", "outside/folder/pkg/lib/a",
    "outside/install/setup.bash", "outside/install/pkg/share/colcon-core/packages/pkg",
    "outside/install/pkg/__pycache__/a.pyc", "outside/bag/bag_0.mcap",
)  # fmt: skip
LINKS = {
    "to_folder": "ABOVE/outside/folder",
    "to_file": "ABOVE/outside/kept.txt",
    "to_new": "../outside/new",
    "to_bag": "../outside/bag",
    "up": "..",
    "page": "00_welcome.ipynb",
    "install": "../outside/install",
    "inner/deep": "../../outside",
    "inner/chain": "../to_folder",
    "inner/round": "round",
    "inner/to_a": "a",
    "src/pkg/data/leads_out": "../../../../outside/folder",
}


def make(place: Path) -> Path:
    """Make it all in a folder; returns the learner's."""
    if os.name == "nt":
        pytest.skip("links may not be made everywhere on Windows, and modes are others")
    for folder in (place / "mine/src/pkg", place / "outside/src/other"):
        (folder / "data").mkdir(parents=True)
        (folder / "package.xml").write_text(PACKAGE_XML.format(name=folder.name))
        (folder / "CMakeLists.txt").write_text(CMAKE.format(name=folder.name))
        (folder / "node.py").write_text("#!/usr/bin/env python3\nprint('node')\n")
        (folder / "node.py").chmod(0o755)
        (folder / "data" / "a.yaml").write_text("a: 1\n")
    for file in TEXTS:
        (place / file).parent.mkdir(parents=True, exist_ok=True)
        (place / file).write_text(f"{file}\n")
    (place / "outside/install/.colcon_install_layout").write_text("isolated\n")
    for link, target in LINKS.items():
        (place / "mine" / link).symlink_to(target.replace("ABOVE", str(place)))
    return place / "mine"


def state(place: Path, but: Path) -> dict[str, object]:
    """All that can be seen below a folder, apart from another one: names, modes, times, bytes."""
    found: dict[str, object] = {}
    for folder, names, inside in os.walk(place):
        names[:] = [name for name in names if Path(folder, name) != but]
        for path in (Path(folder), *(Path(folder, name) for name in inside)):
            about = path.lstat()
            content = path.read_bytes() if stat.S_ISREG(about.st_mode) else b""
            found[str(path)] = (about.st_mode, about.st_ino, about.st_mtime_ns, about.st_ctime_ns, content)
    return found


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The learner's folder, and current."""
    monkeypatch.setattr(files, "last_cd", None)
    for name in ("OUT", "TURTLE_LESSON_OPENED", "OLDPWD"):  # to have them again afterwards
        monkeypatch.setenv(name, "")
    mine = make(tmp_path)
    monkeypatch.chdir(mine)
    return mine


@pytest.fixture
def type_line(mine: Path, world: World, capsys: pytest.CaptureFixture[str]) -> Type:
    """Types a line, in which ABOVE is the folder above; returns the exit code, stdout and stderr."""
    for package in underlay_packages():
        world.packages.add(package)

    def type_line(line: str) -> tuple[int, str, str]:
        code = run_line(world, line.replace("ABOVE", str(mine.parent)))
        return code, *capsys.readouterr()

    return type_line


# -- what commands may change ------------------------------------------------------------------------------------------

OUTSIDE = [
    "cd .. && rm -rf outside",
    "cd / && rm -rf ABOVE/outside",
    "rm to_folder/kept.txt",
    "rm -r up/outside",
    "rm -r i*/../../outside",
    "echo x > ../new",
    "echo x > ABOVE/outside/kept.txt",
    "cd ../outside; echo x >> kept.txt",
    "export OUT=ABOVE; touch $OUT/new",
    "export OUT=ABOVE; echo x > $OUT/new",
    "echo x > ~/../new",
    "echo x > to_file",
    "echo x > to_new",
    "ls nope 2> to_folder/new",
    "ls &> inner/chain/new",
    "cat a | head > '../new'",
    "cp a ../outside",
    "cp a to_file",
    "cp a to_folder",
    "cp a ../new",
    "cp -r inner ../outside/new",
    "mv to_folder inner/data; cp -r src/pkg/data inner",
    "mkdir inner/data; mv to_file inner/data/a.yaml; cp -r src/pkg/data inner",
    "mv a ..",
    "mv a to_folder",
    "mv to_folder/kept.txt .",
    "mv ../outside/kept.txt .",
    "mkdir ../new",
    "mkdir -p new/../../other",
    "mkdir to_folder/new",
    "touch to_file",
    "touch ../new",
    "chmod +x to_file",
    "chmod +x ../outside/kept.txt",
    "ros2 pkg create new --destination-directory ..",
    "ros2 pkg create new --destination-directory to_folder",
    "ros2 bag record -a -o ../new --for 0.1",
    "ros2 bag record -a -s sqlite3 -o to_folder/new --for 0.1",
    "ros2 bag record -a -o '~/new' --for 0.1",
    "ros2 run turtlesim turtlesim_node; ros2 param dump /turtlesim > ../turtlesim.yaml",
    "colcon build",
    "rm install; mkdir install; mv to_folder install/pkg; colcon build --base-paths src",
    "rm install; mkdir install; mv to_folder install/pkg; colcon build --base-paths src --symlink-install",
    "rm install; mkdir -p install build/pkg; echo kept.txt > build/pkg/install_manifest.txt; mv to_folder install/pkg; "
    "colcon build --base-paths src",
    "rm install; mkdir -p install/pkg/share; mv to_folder install/pkg/share/pkg; colcon build --base-paths src",
    "rm install; mkdir build; mv to_folder build/pkg; colcon build --base-paths src",
    "rm install; mv to_folder log; colcon build --base-paths src",
    "cd ..; colcon build --base-paths mine/src",
    "colcon build --base-paths src --install-base ../new",
    "colcon build --base-paths src --install-base in --build-base ../new",
]


@pytest.mark.parametrize("line", OUTSIDE)
def test_outside_of_the_learners_folder_nothing_changes(line: str, mine: Path, type_line: Type) -> None:
    before = state(mine.parent, mine)
    code, _, error = type_line(line)
    assert state(mine.parent, mine) == before
    assert f"it is outside your folder ({mine}). To change it on purpose, use Python or !command in a cell" in error
    assert code != 0


@pytest.mark.parametrize(
    "line", ["rm -rf .", "rm -rf ~", "rm -rf /", "rm -rf ..", "rm -rf up", "mv . x", "mv ~ x", "cd inner/b; rm -r ../b"]
)
def test_a_folder_is_not_deleted_under_ones_feet(line: str, mine: Path, type_line: Type) -> None:
    before = state(mine.parent, mine / "up")
    code, _, error = type_line(line)
    if line == "rm -rf up":  # the link alone
        (mine / "up").symlink_to("..")
    else:
        assert code == 1
        assert "': the current folder or the notebook's is in it" in error
    assert state(mine.parent / "outside", mine) == {path: each for path, each in before.items() if "outside" in path}
    assert (mine / "inner/b/a").read_text() == "mine/inner/b/a\n"


@pytest.mark.parametrize(
    "line",
    [
        "rm 00_welcome.ipynb",
        "rm *.ipynb",
        "mv lab.ipynb kept.ipynb",
        "mv a lab.ipynb",
        "cp a lab.ipynb",
        "echo x > lab.ipynb",
        "cd inner; echo x >> ../00_welcome.ipynb",
        "echo x > page",
        "mkdir inner/mine; mv inner/to_a inner/mine/lab.ipynb; cp -r inner/mine ..",
        "touch lab.ipynb",
        "chmod +x lab.ipynb",
    ],
)
def test_the_lessons_pages_are_left_alone(line: str, mine: Path, type_line: Type) -> None:
    before = state(mine, mine / "inner")
    code, _, error = type_line(line)
    assert state(mine, mine / "inner") == before
    assert code == 1
    assert (
        "it is a page of the lesson. Change a copy of another name, or use JupyterLab's list of files on purpose"
        in error
    )


def test_a_copy_of_a_page_is_a_file_like_any_other(mine: Path, type_line: Type) -> None:
    assert type_line("cp lab.ipynb mine.ipynb; cp lab.ipynb inner; echo x > mine.ipynb; rm inner/lab.ipynb") == (
        0,
        "",
        "",
    )
    assert (mine / "mine.ipynb").read_text() == "x\n"


def test_inside_links_are_what_they_are_in_a_terminal(mine: Path, type_line: Type) -> None:
    assert type_line(
        "rm to_folder; mv to_file inner/moved; cp -r inner copy; echo x > inner/to_a; mv a inner/to_a"
    ) == (0, "", "")
    assert [os.readlink(mine / "copy" / name) for name in ("moved", "deep", "round")] == [
        str(mine.parent / "outside/kept.txt"),
        "../../outside",
        "round",
    ]
    assert (mine / "inner/a").read_text() == "x\n"
    assert not (mine / "inner/to_a").is_symlink()
    assert type_line("echo a > /dev/null; ls nope 2> /dev/null; cat < inner/a") == (0, "x\n", "")


def test_what_goes_on_behind_a_redirection_follows_no_link_that_came_later(
    mine: Path, type_line: Type, world: World
) -> None:
    before = state(mine.parent, mine)
    type_line("ros2 topic pub /x std_msgs/msg/Int32 > said.txt &")
    type_line("sleep 1.5; mv said.txt inner; mv to_file said.txt; sleep 2; kill %1")
    assert (mine / "inner/said.txt").read_text().startswith("publisher: beginning loop")
    assert state(mine.parent, mine) == before


def test_a_bag_that_is_being_recorded_stays_where_it_is(mine: Path, type_line: Type) -> None:
    type_line("ros2 bag record -a -o inner/run &")
    for line in ("mv inner/run other", "rm -r inner", "mv inner/run ABOVE/outside"):
        assert "a bag is being recorded in it; stop that first" in type_line(line)[2]
    code, _, error = type_line("kill -INT %1; sleep 0.1; mv inner/run other; rm -r other")
    assert (code, error) == (0, "")


def test_a_bag_is_called_exactly_what_it_is_called(mine: Path, type_line: Type) -> None:
    (mine.parent / "b").mkdir()
    before = state(mine.parent, mine)
    assert type_line("ros2 bag record -a -s sqlite3 -o '%2e%2e%2fb' --for 0.1")[0] != 1
    assert state(mine.parent, mine) == before
    assert sorted(path.name for path in (mine / "%2e%2e%2fb").iterdir()) == ["%2e%2e%2fb_0.db3", "metadata.yaml"]


def test_a_link_that_colcon_made_leads_out_no_more_than_others(mine: Path, type_line: Type) -> None:
    before = state(mine.parent, mine)
    build = "colcon build --base-paths ../outside/src"
    assert type_line(f"rm install; {build} --symlink-install")[0] == 0
    assert (mine / "install/other/lib/other/node").samefile(mine.parent / "outside/src/other/node.py")
    for line in ("echo x > install/other/lib/other/node", f"rm build/other/install_manifest.txt; {build}"):
        assert "it is outside your folder" in type_line(line)[2]
    assert state(mine.parent, mine) == before


def test_to_source_a_workspace_elsewhere_leaves_it_as_it_is(mine: Path, type_line: Type) -> None:
    before = state(mine.parent, mine)
    assert type_line("source ../outside/install/setup.bash; ros2 pkg list | grep pkg") == (0, "pkg\n", "")
    assert state(mine.parent, mine) == before


def test_no_folder_is_copied_into_itself_through_a_link_at_its_target(mine: Path, type_line: Type) -> None:
    type_line("mkdir -p s/a/b t/s")
    (mine / "t/s/a").symlink_to(mine / "s/a/b", target_is_directory=True)
    code, _, error = type_line("cp -r s t")
    assert code == 1 and "no folder takes the place of a link" in error
    assert not list((mine / "s/a/b").iterdir())


# -- which folder it is --------------------------------------------------------------------------------------------------


def test_a_notebook_keeps_its_folder_whatever_cd_and_start_do(
    mine: Path, type_line: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    files.begin_notebook()
    type_line("cd ..")
    files.begin_terminal()
    assert (files.folder(), Path.cwd()) == (mine, mine)
    monkeypatch.chdir(mine.parent)
    start(simulator=False)
    assert (files.folder(), files.home()) == (mine, mine)
    assert type_line("echo x > outside/kept.txt")[0] == 1


def test_in_a_program_it_is_the_folder_that_is_current_at_start(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in (mine, mine.parent / "outside"):
        monkeypatch.chdir(folder)
        start(simulator=False)
        assert files.folder() == files.home() == folder


def test_jupyterlabs_folder_is_the_learners_where_the_notebook_is_in_it(
    mine: Path, type_line: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "_opened", str(mine))
    monkeypatch.chdir(mine / "inner")
    files.begin_notebook()
    assert (files.folder(), files.home()) == (mine, mine / "inner")
    assert type_line("echo x > ../a; cd ..; cat a; cd; pwd") == (0, f"x\n{mine}/inner\n", "")
    assert "it is a page of the lesson" in type_line("rm ../lab.ipynb")[2]
    assert "outside your folder" in type_line("export TURTLE_LESSON_OPENED=/; touch ../../new")[2]
    monkeypatch.chdir(mine.parent / "outside")
    files.begin(notebook=True)
    assert files.folder() == mine.parent / "outside"


def test_open_says_which_folder_it_opens(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[dict[str, str]] = []
    monkeypatch.setattr(main.os, "execve", lambda program, words, environment: given.append(environment))
    monkeypatch.setattr(main.subprocess, "call", lambda words, env: given.append(env))
    main.serve(Path("inner/.."), "jupyterlab", [])
    assert given[0][files.OPENED] == str(mine)


@pytest.mark.parametrize(
    "line", ["echo ü > ü.txt", "touch ü", "mkdir ü", "cp a ü", "ros2 bag record -a -o ü", "ros2 pkg create ü"]
)
def test_a_name_that_this_computer_cannot_write_is_refused_with_the_way_out(line: str, mine: Path) -> None:
    program = (
        "import sys; from turtle_lesson.ros.cli.shell import run_line; from turtle_lesson.ros.runtime.world import open_world; "
        f"print(sys.getfilesystemencoding()); sys.exit(run_line(open_world(), {line!a}))"
    )
    environment = os.environ | {
        "LC_ALL": "C",
        "PYTHONUTF8": "0",
        "PYTHONCOERCECLOCALE": "0",
        "PYTHONIOENCODING": "utf-8",
    }
    before = state(mine, mine / "nothing")
    ended = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, encoding="utf-8", check=False
    )
    if not ended.stdout.startswith("ascii"):
        pytest.skip("this system writes names of files in UTF-8 whatever the locale")
    assert ended.returncode == 1
    assert (
        "no file can have this name where Python encodes names as ascii: set PYTHONUTF8=1 and start it again"
        in ended.stderr
    )
    assert state(mine, mine / "nothing") == before


# -- any script ----------------------------------------------------------------------------------------------------------

NAMES = [
    *(
        "a",
        "b",
        "inner",
        "outside",
        "folder",
        "kept.txt",
        "new",
        "mine",
        "pkg",
        "src",
        "..",
        "..",
        ".",
        "*",
        "*a*",
        "%2e%2e",
    ),
    *LINKS,
]
BEGINNINGS = [
    "",
    "",
    "./",
    "../",
    "../../",
    "~/",
    "$OUT/",
    "$HOME/",
    "$OLDPWD/",
    "ABOVE/outside/",
    "ABOVE/",
    "*/",
    "new/../../",
]
OUT_AND_IN = [
    "to_folder", "to_folder/kept.txt", "to_file", "to_new", "to_bag", "up/outside", "inner/deep/folder", "inner/chain/new",
    "inner/deep/kept.txt", "../outside", "../outside/kept.txt", "ABOVE/outside/kept.txt", "ABOVE/outside/new", "../mine/a",
    "a", "inner", "inner/a", "inner/b", "new", "src", "install", "src/pkg", "page", "lab.ipynb", "ABOVE/mine/inner",
]  # fmt: skip
any_path = some.builds(
    lambda begin, parts: begin + "/".join(parts),
    some.sampled_from(BEGINNINGS),
    some.lists(some.sampled_from(NAMES), max_size=4),
)
paths = some.one_of(some.sampled_from(OUT_AND_IN), some.sampled_from(OUT_AND_IN), any_path).map(
    lambda path: path or "''"
)
LINES = [
    "rm {0}", "rm -rf {0}", "rm -r {0} {1}", "mv {0} {1}", "mv {0} {1} {2}", "cp {0} {1}", "cp -r {0} {1}", "mkdir {0}",
    "mkdir -p {0}", "touch {0}", "chmod +x {0}", "echo x > {0}", "echo x >> {0}", "ls nope 2> {0}", "ls &> {0}",
    "cat < {0} > {1}", "echo x | cat > {0}", "cd {0}", "cd {0}", "cd -", "cd", "export OUT={0}", "export HOME={0}",
    "OUT={0} rm -r {1}", "export TURTLE_LESSON_OPENED=/ TURTLE_LESSON_FOLDER=/",
    "source {0}/setup.bash", "ros2 pkg create new_pkg --destination-directory {0}", "ros2 pkg create {0}",
    "ros2 bag record -a -o {0} --for 0.1", "ros2 bag record -a -s sqlite3 -o {0} --for 0.1",
    "ros2 bag record -a -o {0} &", "kill -INT %1", "ros2 topic pub /x std_msgs/msg/Int32 > {0} &", "sleep 1",
    "colcon build", "colcon build --symlink-install",
    "colcon build --base-paths {0}", "colcon build --base-paths src --install-base {0} --build-base {1}",
    "colcon build --base-paths src --merge-install --install-base {0}",
]  # fmt: skip
lines = some.builds(str.format, some.sampled_from(LINES), paths, paths, paths)


@settings(database=None)  # which would be written and cleared outside
@given(some.lists(lines, min_size=1, max_size=8))
def test_whatever_is_typed_nothing_changes_outside(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: list[str]
) -> None:
    deep = Path(tempfile.mkdtemp(dir=tmp_path))
    place = deep / "1" / "2" / "3"
    mine = make(place)
    before, environment = state(deep, mine), dict(os.environ)
    monkeypatch.chdir(mine)
    files.begin()
    world = open_world()
    for package in underlay_packages():
        world.packages.add(package)
    try:
        for line in ["ros2 run turtlesim turtlesim_node", *script]:
            run_line(world, line.replace("ABOVE", str(place)))
        world.close()
        assert state(deep, mine) == before
    finally:
        monkeypatch.chdir(tmp_path)
        os.environ.clear()
        os.environ.update(environment)
        files.last_cd = None
        shutil.rmtree(deep)
