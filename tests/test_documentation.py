"""The pages of documentation: what they link and name exists, and what they list is complete."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

import turtle_lesson
from turtle_lesson.learner.story import PAGES

PACKAGE = Path(turtle_lesson.__file__).parent
ROOT = PACKAGE.parent
DOCUMENTS = sorted(
    [*ROOT.glob("*.md"), *PACKAGE.rglob("*.md"), *ROOT.glob("tests/*/README.md"), *ROOT.glob("deploy/**/*.md")]
)
LINK = re.compile(r"\]\((?!https?:)([^)#]*)(?:#([^)]*))?\)")
FILE = re.compile(r"`((?:[\w.]+/)+(?:[\w.]+)?|\w+\.py)`")
PLACEHOLDER = re.compile(r"NN|NAME|COMMAND")
OF_A_LEARNER = ("robot_ws", "install", "src", "build", "setup.py", ".venv")


def name_of(document: Path) -> str:
    return document.relative_to(ROOT).as_posix()


def anchors(document: Path) -> set[str]:
    """The anchors of its headings, as GitHub makes them."""
    titles = re.findall(r"^#+ (.+)$", document.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("document", DOCUMENTS, ids=name_of)
def test_links_lead_somewhere(document: Path) -> None:
    for path, anchor in LINK.findall(document.read_text(encoding="utf-8")):
        target = document.parent / path if path else document
        assert target.exists(), path
        assert not anchor or anchor in anchors(target), f"{path}#{anchor}"


@pytest.mark.parametrize("document", DOCUMENTS, ids=name_of)
def test_files_that_are_named_exist(document: Path) -> None:
    rooms = (document.parent, ROOT, PACKAGE, *PACKAGE.glob("lab/*/"))
    names = {name for name in FILE.findall(document.read_text(encoding="utf-8")) if not PLACEHOLDER.search(name)}
    names = {name for name in names if name.partition("/")[0] not in OF_A_LEARNER}
    assert {name for name in names if not any((room / name).exists() for room in rooms)} == set()


def test_readme_has_two_commands_and_every_page() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"<!-- (\w+) command -->\n```sh\n[^\n]+\n```\n", readme) == ["first", "second"]
    assert readme.count("```sh") == 2
    assert re.findall(r"^\| \[(\w+)\]\(notebooks/", readme, re.MULTILINE) == [*PAGES, "lab"]


@pytest.mark.parametrize("folder", [PACKAGE, PACKAGE / "ros"], ids=["turtle_lesson", "ros"])
def test_every_room_has_its_row(folder: Path) -> None:
    document = ROOT / "README.md" if folder == PACKAGE else folder / "README.md"
    rooms = {each.name for each in folder.iterdir() if each.is_dir() and not each.name.startswith("_")}
    assert rooms <= set(re.findall(r"^\| `(\w+)` \|", document.read_text(encoding="utf-8"), re.MULTILINE))


def test_the_rooms_of_ros_stand_in_the_order_of_their_contract() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
    (layers,) = (contract["layers"] for contract in declared if contract["id"] == "ros")
    height = {name: at for at, layer in enumerate(layers) for name in re.findall(r"ros\.(\w+)", layer) or ["site"]}
    text = (PACKAGE / "ros" / "README.md").read_text(encoding="utf-8")
    heights = [height[name] for name in re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)]
    assert heights == sorted(heights)


def test_the_changelog_begins_with_the_version() -> None:
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    newest = re.search(r"^## \[([\d.]+)\]", changelog, re.MULTILINE)
    assert newest is not None and newest[1] == declared == turtle_lesson.__version__
