"""`%%solution`: a folded solution runs nothing, whatever stands in it, until a reader deletes its first line."""

from __future__ import annotations

import pytest
from IPython.core.interactiveshell import InteractiveShell
from traitlets.config import Config

SOLUTION = """answer = 42
print("never")
ros2 topic list
def (: broken {x} $HOME"""


@pytest.fixture(scope="module")
def ipython() -> InteractiveShell:
    shell = InteractiveShell(config=Config(HistoryManager={"enabled": False}))
    shell.run_line_magic("load_ext", "turtle_lesson")
    return shell


@pytest.mark.parametrize("head", ["%%solution navigator", "%%solution", "%%solution two words  "])
def test_it_runs_and_says_nothing(ipython: InteractiveShell, head: str, capsys: pytest.CaptureFixture[str]) -> None:
    ipython.user_ns["answer"] = "the reader's"
    result = ipython.run_cell(f"{head}\n{SOLUTION}")
    assert result.success
    assert result.result is None
    assert ipython.user_ns["answer"] == "the reader's"
    assert capsys.readouterr() == ("", "")


def test_without_its_first_line_it_is_an_answer(ipython: InteractiveShell) -> None:
    ipython.run_cell("answer = 42")
    assert ipython.user_ns["answer"] == 42
