"""Predictions: a guess before the run, guess and outcome side by side after it, and neither is needed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab import predictions


@pytest.fixture
def lesson() -> Iterator[Lesson]:
    predictions._questions.clear()
    yield start()
    predictions._questions.clear()


def test_without_a_guess_it_goes_on(lesson: Lesson) -> None:
    assert repr(lesson.predict("end", "Where will it end?", on_map=True)) == "Where will it end? – no guess yet."
    assert repr(lesson.outcome("end", (5.5444, 3))) == (
        "Where will it end?\n  your guess: no guess yet\n  outcome:    (5.54, 3.00) m"
    )


def test_a_point_is_compared_by_distance(lesson: Lesson) -> None:
    asked = lesson.predict("end", "Where will it end?", on_map=True, guess=(8, 3))
    assert repr(asked) == "Where will it end? – your guess: (8.00, 3.00) m."
    shown = lesson.outcome("end", (5, 7, 1.57))
    assert shown.verdict == "5.00 m off."
    assert '<svg role="img" aria-label="Map: a ring for your guess, a disc for the outcome"' in shown._repr_html_()


def test_a_number_has_a_unit(lesson: Lesson) -> None:
    lesson.predict("way", "How far?", unit="m", guess="1,5")
    assert repr(lesson.outcome("way", 1.0)).splitlines()[1:] == [
        "  your guess: 1.5 m",
        "  outcome:    1 m",
        "  0.5 m off, 50 %.",
    ]
    lesson.predict("count", "How many?", unit="messages", guess=10)
    assert lesson.outcome("count", 10).verdict == "That is it."


def test_a_choice_is_right_or_not(lesson: Lesson) -> None:
    asked = lesson.predict("on", "Does it drive on?", choices=["yes", "no"], guess="yes")
    assert repr(asked) == "Does it drive on? (yes / no) – your guess: yes."
    assert lesson.outcome("on", "no").verdict == "It came out differently: why?"


def test_asked_twice_the_guess_stays_until_the_outcome_is_known(lesson: Lesson) -> None:
    lesson.predict("on", "Does it?", choices=["yes", "no"], guess="yes")
    assert "your guess: yes" in repr(start().predict("on", "Does it?", choices=["yes", "no"]))
    lesson.outcome("on", "no")
    assert "your guess: yes" in repr(lesson.outcome("on", "no")), "the outcome's cell can be run twice"
    assert "no guess yet" in repr(lesson.predict("on", "Does it?", choices=["yes", "no"]))


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({}, "just one of"),
        ({"choices": ["a"], "unit": "m"}, "just one of"),
        ({"choices": ["a", "b"], "guess": "c"}, "not among the choices: 'a' and 'b'"),
        ({"unit": "m", "guess": "far"}, "A number in m is asked for, got 'far'"),
        ({"unit": "", "guess": float("nan")}, "A number is asked for"),
        ({"on_map": True, "guess": 8}, r"such as \(8, 3\), got 8"),
        ({"on_map": True, "guess": (float("inf"), 1)}, "finite"),
    ],
)
def test_what_is_no_guess_is_explained(lesson: Lesson, how: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        lesson.predict("x", "What?", **how)


def test_an_outcome_that_was_never_asked_is_explained(lesson: Lesson) -> None:
    lesson.predict("where", "Where?", on_map=True)
    with pytest.raises(ValueError, match='Did you mean "where"'):
        lesson.outcome("were", (1, 2))


def test_the_widget_records_what_is_clicked(lesson: Lesson) -> None:
    asked = lesson.predict("end", "Where will it end?", on_map=True)
    widget = asked.widget
    data, _ = asked._repr_mimebundle_()
    assert data["text/plain"] == repr(asked)
    widget._order(widget, {"do": "guess", "view": "v", "value": [8, 3]}, [])
    assert widget.guess == [8.0, 3.0]
    assert widget.words.startswith("Recorded: (8.00, 3.00) m.")
    widget._order(widget, {"do": "guess", "view": "v", "value": "here"}, [])
    assert "A point is two numbers" in widget.words
    start()  # a fresh world does not take the guess away
    widget._order(widget, {"do": "guess", "view": "v", "value": [1, 2]}, [])
    assert lesson.outcome("end", (1, 2)).verdict == "0.00 m off."
    widget._order(widget, {"do": "guess", "view": "v", "value": [5, 5]}, [])
    assert not widget.is_open
    assert "The outcome is known" in widget.words
    assert widget.guess == [1.0, 2.0]
