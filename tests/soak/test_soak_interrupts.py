"""The short form of `tests/soak/interrupts.py`; and calls of pages that are stopped at one line after the other."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest
from soak import interrupts

from turtle_lesson import start
from turtle_lesson.session.lesson import Lesson


def test_a_kernel_is_as_before_after_interrupts_of_all_kinds_of_cell() -> None:
    found: Counter[str] = Counter()
    with interrupts.kernel() as kernel:
        kernel.run("_imp.acquire_lock()\nraise KeyboardInterrupt")  # as an interrupt can leave it that comes just there
        assert kernel.run("print(_imp.lock_held())") == ("False\n", "")
        assert len(list(interrupts.soak(kernel, 16, 7, found))) == 16
    assert not found


# -- at one line after the other -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def lesson() -> Lesson:
    """A lesson with everything running."""
    lesson = start(seed=0)
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(2)
    return lesson


CALLS: dict[str, Callable[[Lesson, int], Any]] = {
    "predict": lambda lesson, at: lesson.predict(f"q{at}", "How long?", unit="s")._repr_mimebundle_(),
    "predict on the map": lambda lesson, at: lesson.predict(f"q{at}", "Where?", on_map=True)._repr_mimebundle_(),
    "outcome": lambda lesson, at: (lesson.predict("q", "How far?", unit="m", guess=1), lesson.outcome("q", 2.0)),
    "teleop": lambda lesson, at: show(lesson, lesson.teleop()),
    "form": lambda lesson, at: show(lesson, lesson.form("/navigate_to")),
    "parameters": lambda lesson, at: show(lesson, lesson.parameters("/navigator")),
}
STOPS = {"predict": 1000, "predict on the map": 1000, "outcome": 1000}
"""At how many lines of this package a call is stopped, from the first to the last: at all of them, if it has fewer; else 25."""


def show(lesson: Lesson, widget: Any) -> None:
    """Show a widget; it is made anew the next time."""
    widget._repr_mimebundle_()
    widget.close()
    lesson._widgets.clear()


def frames_named(name: str, frame: FrameType | None) -> bool:
    """Whether a function of this name has called here."""
    while frame is not None and frame.f_code.co_name != name:
        frame = frame.f_back
    return frame is not None


def lines_of(call: Callable[[], object], stop_at: int = 0) -> int:
    """Make a call, and count its lines in this package; raise KeyboardInterrupt at one, as if SIGINT came just there."""
    count = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal count
        if "turtle_lesson" not in frame.f_code.co_filename or frame.f_code.co_filename.endswith("interrupts.py"):
            return None  # a guarded run of the world puts it off
        if frames_named("__del__", frame):
            return None  # where Python would only print it
        count += event == "line"
        if event == "line" and count == stop_at:
            sys.settrace(None)
            raise KeyboardInterrupt
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        call()
    except KeyboardInterrupt:
        pass
    finally:
        sys.settrace(before)
    return count


@pytest.mark.parametrize("name", CALLS)
def test_a_call_that_was_stopped_anywhere_can_be_made_again(
    lesson: Lesson, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    unheard: list[Any] = []
    monkeypatch.setattr(sys, "unraisablehook", unheard.append)
    call = CALLS[name]
    call(lesson, 0)
    lines = lines_of(lambda: call(lesson, -1))
    for at in range(1, lines, max(1, lines // STOPS.get(name, 25))):
        lines_of(lambda at=at: call(lesson, at), stop_at=at)
        call(lesson, at)
    assert not unheard
