"""`python3 -m`: modules and packages as main programs, and what is left when they are interrupted."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime.world import World


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package with a main program and a module, beside which the terminal stands."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "shop"
    folder.mkdir()
    (folder / "__init__.py").write_text("NAME = 'the shop'\n")
    (folder / "till.py").write_text("from . import NAME\n\nprint(NAME, __name__, __package__)\n")
    (folder / "__main__.py").write_text(
        "import sys\nimport time\nfrom dataclasses import dataclass\n\nfrom . import till\n\n\n"
        "@dataclass\nclass Sale:\n    what: 'str'\n\n\n"
        "if __name__ == '__main__':\n"
        "    print(__package__, Sale(sys.argv[1]), sys.modules['__main__'].Sale is Sale)\n"
        "    time.sleep(60)\n"
    )
    return folder


def test_a_module_of_a_package_is_run(shop: Path, world: World, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_line(world, "python3 -m shop.till") == 0
    assert capsys.readouterr().out == "the shop __main__ shop\n"


def test_a_package_is_run_and_interrupted(shop: Path, world: World, capsys: pytest.CaptureFixture[str]) -> None:
    mine = sys.modules["__main__"]
    run_line(world, "python3 -m shop apples")
    run_line(world, "python3 -m shop pears")
    printed = [line for line in capsys.readouterr().out.splitlines() if line.startswith("shop ")]
    assert printed == ["shop Sale(what='apples') True", "shop Sale(what='pears') True"]
    world.sim.run_until(1_000_000_000)
    assert run_line(world, "kill -INT %1; kill -INT %2") == 0
    assert sys.modules["__main__"] is mine
    assert "shop" not in sys.modules
