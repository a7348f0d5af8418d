"""Predictions: a guess before the run, guess and outcome side by side after it, and neither is needed."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab import predictions

SVG = "{http://www.w3.org/2000/svg}"


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
    assert 'alt="Map of the turtle&#x27;s world: ' in shown._repr_html_()


def drawing(shown: Any) -> ElementTree.Element:
    """The map of an outcome."""
    found = re.search(r'src="data:image/svg\+xml;base64,([^"]+)"', shown._repr_html_())
    assert found is not None
    return ElementTree.fromstring(base64.b64decode(found[1]))


def test_the_map_shows_turtle_goal_guess_and_outcome(lesson: Lesson) -> None:
    lesson.predict("end", "Where will it end?", on_map=True, goal=(5, 5), guess=(8, 3))
    shown = drawing(lesson.outcome("end", (11.09, 5.54)))
    key = ["start (5.54, 5.54) m", "goal (5.00, 5.00) m", "your guess (8.00, 3.00) m", "outcome (11.09, 5.54) m"]
    words = [each.text for each in shown.iter(f"{SVG}text")]
    assert words[-4:] == key
    assert {"x in metres", "y in metres", "0", "10"} <= set(words)
    assert shown.findtext(f"{SVG}desc") == f"Map of the turtle's world: {'; '.join(key)}."


@pytest.mark.parametrize("end", [(0, 0), (11.09, 11.09), (11.09, 0), (-50, 99)])
def test_a_mark_at_a_wall_is_not_cut(lesson: Lesson, end: tuple[float, float]) -> None:
    lesson.predict("end", "Where?", on_map=True, guess=end)
    shown = drawing(lesson.outcome("end", end))
    _, _, width, height = map(float, shown.attrib["viewBox"].split())
    circles = shown.findall(f"{SVG}circle")
    assert len(circles) == 2
    for circle in circles:
        x, y, radius = (float(circle.attrib[name]) for name in ("cx", "cy", "r"))
        assert radius + 2 < x < width - radius - 2 and radius + 2 < y < height - radius - 2


def test_the_turtle_is_where_it_was_when_the_question_was_put(lesson: Lesson) -> None:
    lesson.run(1)
    assert lesson.predict("end", "Where?", on_map=True).turtle == pytest.approx((5.544, 5.544, 0.0), abs=1e-3)
    empty = start(simulator=False)
    assert empty.predict("other", "Where?", on_map=True).turtle is None


@pytest.mark.parametrize(
    ("unit", "typed", "value"),
    [
        ("Hz", "20 Hz", 20),
        ("Hz", " 20hz ", 20),
        ("Hz", "20 times a second", 20),
        ("m", "0,5 m", 0.5),
        ("s", "2.5 seconds", 2.5),
        ("s", "1 second", 1),
        ("m", "−3", -3),
        ("%", "5%", 5),
        ("messages", "1 message", 1),
        ("beats", "12 Beats", 12),
        ("", "7", 7),
        ("m", "1e-1", 0.1),
    ],
)
def test_a_number_may_be_written_with_its_unit(lesson: Lesson, unit: str, typed: str, value: float) -> None:
    assert lesson.predict("x", "How much?", unit=unit, guess=typed).guess == pytest.approx(value)


@pytest.mark.parametrize(
    ("unit", "typed", "said"),
    [
        ("Hz", "20 m", "A number in Hz is asked for, got '20 m': 'm' is not understood. Write only the number."),
        ("m", "1 m/s", "got '1 m/s': 'm/s' is not understood"),
        ("s", "2 or 3", "'or 3' is not understood"),
        ("s", "soon", "got 'soon'. Write it like 2.5 or 2.5 s."),
        ("s", "1e999", "got '1e999'"),
        ("", "", "A number is asked for, got ''. Write it like 2.5."),
    ],
)
def test_what_is_no_number_is_told_with_what_to_write(lesson: Lesson, unit: str, typed: str, said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        lesson.predict("x", "How much?", unit=unit, guess=typed)


def test_a_number_has_a_unit(lesson: Lesson) -> None:
    lesson.predict("way", "How far?", unit="m", guess="1,5")
    assert repr(lesson.outcome("way", 1.0)).splitlines()[1:] == [
        "  your guess: 1.5 m",
        "  outcome:    1 m",
        "  0.5 m off, 50 %.",
    ]
    lesson.predict("count", "How many?", unit="messages", guess=10)
    assert lesson.outcome("count", 10).verdict == "That is right."


def test_a_choice_is_right_or_not(lesson: Lesson) -> None:
    asked = lesson.predict("on", "Does it drive on?", choices=["yes", "no"], guess="yes")
    assert repr(asked) == "Does it drive on? (yes / no) – your guess: yes."
    assert lesson.outcome("on", "no").verdict == "The outcome is different: why?"


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
    asked = lesson.predict("end", "Where will it end?", on_map=True, goal=(5, 5))
    widget = asked.widget
    data, _ = asked._repr_mimebundle_()
    assert data["text/plain"] == repr(asked)
    assert (widget.goal, widget.turtle[2]) == ({"x": 5.0, "y": 5.0, "theta": None}, 0.0)
    widget._order(widget, {"do": "guess", "view": "v", "value": [8, 3]}, [])
    assert widget.guess == [8.0, 3.0]
    assert widget.words.startswith("Recorded: (8.00, 3.00) m.")
    widget._order(widget, {"do": "guess", "view": "v", "value": "here"}, [])
    assert "A point is two finite numbers" in widget.words
    start()  # a fresh world does not take the guess away
    widget._order(widget, {"do": "guess", "view": "v", "value": [1, 2]}, [])
    assert lesson.outcome("end", (1, 2)).verdict == "0.00 m off."
    widget._order(widget, {"do": "guess", "view": "v", "value": [5, 5]}, [])
    assert not widget.is_open
    assert "The outcome is already known" in widget.words
    assert widget.guess == [1.0, 2.0]
