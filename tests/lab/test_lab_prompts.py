"""Prompts for an assistant: all that it needs, and nothing of the machine."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.prompts import code_of, compose


@pytest.fixture
def lesson(monkeypatch: pytest.MonkeyPatch) -> Lesson:
    monkeypatch.setattr(sys, "last_value", None, raising=False)
    return start()


def test_a_prompt_for_debugging_has_all_parts(lesson: Lesson) -> None:
    lesson.run(1)
    text = str(lesson.prompt_for("debugging", code="class Listener:\n    pass\n"))
    titles = [line for line in text.splitlines() if line.startswith("## ")]
    assert titles == [
        "## Specification",
        "## Code",
        "## Error",
        "## The running system, after 1.0 s",
        "## The last lines of the log",
        "## What I ask",
    ]
    assert "class Listener:" in text
    assert "None: nothing has raised an error." in text
    assert "/turtlesim publishes" in text
    assert "[INFO] [0.000] [turtlesim]: Starting turtlesim" in text
    assert "srv/NavigateTo: float32 x, y, theta" in text


def test_it_is_the_same_whenever_it_is_made(lesson: Lesson) -> None:
    assert lesson.prompt_for("code review").text == lesson.prompt_for("code review").text
    assert "(none chosen)" in lesson.prompt_for("code review").text


def test_the_error_of_a_program_is_there_without_addresses(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    def broken() -> None:
        raise RuntimeError(f"{object()!r} is no good")

    lesson._world.spawn(broken, name="broken")
    lesson.run(0.1)
    text = lesson.prompt_for("debugging").text
    assert "The program broken ended with:\nTraceback" in text
    assert "RuntimeError: <object object at 0x…> is no good" in text


def test_the_notebooks_last_error_is_there(lesson: Lesson, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "last_value", ValueError("so it was"), raising=False)
    assert "ValueError: so it was" in lesson.prompt_for("debugging").text


def test_the_learners_own_package_is_taken_unless_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import shutil

    from turtle_lesson.learner.story import FINISHED

    shutil.copytree(FINISHED, tmp_path / "robot_controller")
    shutil.copytree(
        Path(__file__).parents[1] / "data" / "simple_stage", tmp_path / "robot_controller", dirs_exist_ok=True
    )
    lesson = start(package=tmp_path / "robot_controller")
    text = lesson.prompt_for("code review").text
    assert "robot_controller/navigator_node.py:\n\n```python" in text
    assert "CMakeLists.txt:\n\n```cmake" in text and "msg/TurtleStatus.msg:" in text
    assert "def on_goal(self, request, response):" in text


def test_code_can_be_named_in_many_ways(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "node.py").write_text("x = 1\n")
    assert code_of("node.py") == {"node.py": "x = 1\n"}
    assert code_of(tmp_path) == {"node.py": "x = 1\n"}
    assert code_of("y = 2\n") == {"code": "y = 2\n"}
    assert list(code_of(["y = 2\n", "node.py"])) == ["code", "node.py"]


@pytest.mark.parametrize(("what", "said"), [("nope.py", "there is no file nope.py"), (3, "there is no file 3")])
def test_what_has_no_code_is_explained(what: object, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        code_of(what)  # type: ignore[arg-type]


def test_too_much_is_refused() -> None:
    with pytest.raises(ValueError, match="too much for a chat"):
        code_of("x = 1\n" * 20_000)


def test_an_unknown_kind_is_refused(lesson: Lesson) -> None:
    with pytest.raises(ValueError, match='"debugging" and for "code review"'):
        lesson.prompt_for("poem")


def test_fences_in_the_code_do_not_end_its_own_and_nothing_becomes_html() -> None:
    prompt = compose("debugging", {"a.py": '"""\n```\n"""\nx < 1 & y'}, "", "", [], 0.0)
    assert '````python\n"""\n```\n"""' in prompt.text
    bundle = prompt._repr_mimebundle_()
    assert "x &lt; 1 &amp; y" in bundle["text/html"]
    assert bundle["text/plain"] == prompt.text
