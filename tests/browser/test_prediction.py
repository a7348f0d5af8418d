"""A prediction in JupyterLab: the map of a guess by mouse and by keys, a number with its unit, and pictures that speak."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from jupyter_pages import Lab, choose_theme, execute, notebook_in, serious_violations, value, write_notebook
from playwright.sync_api import Page, expect

CELLS = (
    """%load_ext turtle_lesson
from turtle_lesson import start
lesson = start(seed=0)
_ = lesson.launch("robot_controller", "start_system.launch.py")
lesson.run(2)""",
    """asked = lesson.predict("end", "Where will it end, on its way to (2, 8)?", on_map=True, goal=(2, 8))
asked""",
    """rate = lesson.predict("rate", "How many messages a second?", unit="Hz")
rate""",
    "lesson.plot_graph()",
    "lesson.plot_path(goal=(2, 8))",
    'lesson.outcome("end", (2, 8, 0.0))',
)
NAME = "prediction.ipynb"


@pytest.fixture(scope="module")
def window(desktop: Page, lab: Lab) -> Iterator[Page]:
    """A window in which all cells but the outcome's were run."""
    problems: list[str] = []
    write_notebook(lab, NAME, CELLS[:-1])
    with notebook_in(desktop, lab, NAME, problems) as page:
        execute(page, "notebook:run-all-cells")
        page.wait_for_selector(".tl-guess-map", state="attached")
        expect(page.get_by_text("In words")).to_have_count(1)
        yield page
    assert problems == []


def test_a_place_is_guessed_by_keys_alone(window: Page) -> None:
    guess = window.locator(".tl-guess-map")
    guess.scroll_into_view_if_needed()
    window.keyboard.press("Escape")  # as by a reader who uses keys: after a click the focus need not be shown
    guess.focus()
    assert guess.evaluate("node => getComputedStyle(node).outlineStyle") == "solid", "it shows that it has the focus"
    for key in ["ArrowLeft", "ArrowLeft", "Shift+ArrowUp", "Enter"]:
        guess.press(key)
    expect(window.locator(".tl-prediction .tl-said").first).to_contain_text("Recorded: (4.54, 5.64) m.")
    assert value(window, "asked.guess") == pytest.approx((4.544, 5.644), abs=1e-3)
    assert window.locator(".jp-Notebook .jp-Cell").count() == len(CELLS) - 1, "no key became a shortcut"


def test_turtle_and_goal_are_named_beside_the_map(window: Page) -> None:
    key = window.locator(".tl-guess-key").first
    expect(key).to_contain_text("the turtle: (5.54, 5.54) m")
    expect(key).to_contain_text("its goal, the flag: (2.00, 8.00) m")


def test_a_number_may_have_its_unit(window: Page) -> None:
    field = window.locator(".tl-prediction input")
    field.fill("20 hz")
    field.press("Enter")
    expect(window.locator(".tl-prediction .tl-said").last).to_contain_text("Recorded: 20 Hz.")
    field.fill("many")
    field.press("Enter")
    expect(window.locator(".tl-prediction .tl-said").last).to_contain_text("Write it like 2.5 or 2.5 Hz.")


def test_the_graph_has_its_alternative_text(window: Page) -> None:
    graph = window.locator(".jp-OutputArea img[alt^='The ROS graph has 4 nodes']")
    expect(graph).to_have_count(1)
    assert graph.evaluate("image => image.naturalWidth > 500 && image.clientWidth <= image.parentElement.clientWidth")


def test_the_text_of_a_picture_is_unfolded_by_a_key(window: Page) -> None:
    words = window.get_by_text("In words")
    words.focus()
    words.press("Enter")
    expect(window.get_by_text("Path of turtle1 from")).to_be_visible()


@pytest.mark.parametrize("theme", ["Light", "Dark"])
def test_it_can_be_used_by_all(window: Page, theme: str) -> None:
    choose_theme(window, theme)
    assert serious_violations(window, ".tl-prediction") == []


def test_printed_lines_do_not_break_within_words(window: Page) -> None:
    printed = window.locator(".jp-OutputArea .jp-RenderedText pre").first
    assert printed.evaluate("text => getComputedStyle(text).wordBreak") == "normal"
