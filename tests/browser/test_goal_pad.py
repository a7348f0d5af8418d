"""The goal pad in JupyterLab: what hands and keys do on it moves the turtle, the clock and the obstacles."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest
from jupyter_pages import Lab, choose_theme, execute, notebook_in, python, serious_violations, value, write_notebook
from playwright.sync_api import Locator, Page, expect

CELLS = (
    """%load_ext turtle_lesson
import threading
from turtle_lesson import start
lesson = start(seed=0)
_ = lesson.launch("robot_controller", "start_system.launch.py", source="world")
lesson.run(1)
threads = set()""",
    """pad = lesson.goal_pad()
carry_out = pad._carry_out
pad._carry_out = lambda *order: (threads.add(threading.current_thread() is threading.main_thread()), carry_out(*order))
pad""",
    "",
)
NAME = "goals.ipynb"
EDGES = {"left": 26, "right": 10, "top": 10}
WORLD = 11.088889


class Pad:
    """One window's goal pad, in metres."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.map = page.locator(".tl-map")
        self.words = page.locator(".tl-words")
        self.states = page.locator(".tl-goal strong")

    def ask(self, code: str) -> Any:
        """What this Python expression is in the kernel."""
        return value(self.page, code)

    def do(self, code: str) -> None:
        assert "Traceback" not in python(self.page, code)

    def at(self, x: float, y: float) -> tuple[float, float]:
        box = self.map.bounding_box()
        assert box is not None
        scale = (box["width"] - EDGES["left"] - EDGES["right"]) / WORLD
        return box["x"] + EDGES["left"] + x * scale, box["y"] + EDGES["top"] + (WORLD - y) * scale

    def click(self, x: float, y: float) -> None:
        self.map.scroll_into_view_if_needed()
        self.page.mouse.click(*self.at(x, y))

    def drag(self, *places: tuple[float, float]) -> None:
        self.map.scroll_into_view_if_needed()
        self.page.mouse.move(*self.at(*places[0]))
        self.page.mouse.down()
        for place in places[1:]:
            self.page.mouse.move(*self.at(*place), steps=3)
        self.page.mouse.up()

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name, exact=True)

    def pose(self) -> tuple[float, float, float]:
        """Where the turtle is, by its topic."""
        return self.ask("tuple(float(lesson._recording.poses.newest(1)[name][0]) for name in ('x', 'y', 'theta'))")

    def choose_speed(self, speed: str) -> None:
        self.page.get_by_label("Speed of robot time").select_option(speed)


@pytest.fixture(scope="module")
def problems() -> list[str]:
    """What the browser complained of."""
    return []


@pytest.fixture(scope="module")
def window(desktop: Page, lab: Lab, problems: list[str]) -> Iterator[Page]:
    """A window in which the cells were run."""
    write_notebook(lab, NAME, CELLS)
    with notebook_in(desktop, lab, NAME, problems) as page:
        execute(page, "notebook:run-all-cells")
        page.wait_for_selector(".tl-map")
        yield page


@pytest.fixture
def pad(window: Page) -> Pad:
    """The goal pad of a fresh turtle in an empty world, whose time stands still."""
    pad = Pad(window)
    window.set_viewport_size({"width": 1280, "height": 1000})
    pad.do("lesson.pause(); lesson.set_obstacles([]); lesson.run(20)")
    pad.do("""from std_srvs.srv import Empty
client = lesson._recording.node.create_client(Empty, "/reset")
client.call_async(Empty.Request())
lesson.run(1)
lesson._recording.node.destroy_client(client)
pad.desk.goals.clear(); pad._goal_news = True; pad._tick()""")
    pad.choose_speed("10")
    pad.button("Send goals").click()
    expect(pad.states).to_have_count(0)
    return pad


def heading(goal: dict[str, Any]) -> float:
    return math.degrees(goal["theta"])


def test_showing_it_moved_nothing(window: Page) -> None:
    assert Pad(window).ask("lesson.now") == 1.9


def test_a_click_sends_the_turtle_there(pad: Pad) -> None:
    pad.click(8.0, 3.0)
    expect(pad.states).to_have_text(["reached"])
    expect(pad.page.locator(".tl-goal small")).to_have_text(re.compile(r"success: True, time_taken: \d\.\d s"))
    expect(pad.words).to_contain_text("Goal 1 at (8.0")
    x, y, theta = pad.pose()
    assert math.dist((x, y), (8.0, 3.0)) < 0.2
    assert theta == pytest.approx(math.atan2(3.0 - 5.544, 8.0 - 5.544), abs=0.15), "it faces as it went"


def test_a_drag_sets_the_heading(pad: Pad) -> None:
    pad.drag((3.0, 8.0), (3.0, 7.0), (3.0, 5.0))
    expect(pad.states).to_have_text(["reached"])
    assert heading(pad.ask("pad.goals[0]")) == pytest.approx(-90, abs=2)
    assert math.degrees(pad.pose()[2]) == pytest.approx(-90, abs=6)


def test_escape_takes_a_drag_back(pad: Pad) -> None:
    pad.page.mouse.move(*pad.at(3.0, 8.0))
    pad.page.mouse.down()
    pad.page.keyboard.press("Escape")
    pad.page.mouse.up()
    assert pad.ask("len(pad.desk.goals)") == 0


def test_keys_on_the_map_do_the_same(pad: Pad) -> None:
    pad.map.focus()
    for key in ("Tab", "Shift+Tab"):
        pad.page.keyboard.press(key)
    assert pad.map.evaluate("node => getComputedStyle(node).outlineStyle") == "solid", "it shows that it has the focus"
    for key in ["ArrowUp", "ArrowUp", *4 * ["ArrowRight"], "Shift+ArrowRight", "Shift+ArrowDown"]:
        pad.map.press(key)
    expect(pad.page.locator(".tl-map-panel [role=status]")).to_have_text(
        re.compile(r"Goal at \(7.50, 6.50\) m, \d+ degrees")
    )
    pad.map.press("Enter")
    expect(pad.states).to_have_text(["reached"])
    goal = pad.ask("pad.goals[0]")
    assert (goal["x"], goal["y"]) == (7.5, 6.5)
    travel = math.degrees(math.atan2(6.5 - 5.544, 7.5 - 5.544))
    assert heading(goal) == pytest.approx(travel - 16, abs=0.1)
    assert pad.page.locator(".jp-Notebook .jp-Cell").count() == len(CELLS), "no key became a shortcut"


def test_fields_and_a_button_do_the_same(pad: Pad) -> None:
    for name, typed in (("x m", "2"), ("y m", "2.5"), ("heading °", "180")):
        pad.page.locator(".tl-goal-form").get_by_label(name).fill(typed)
    pad.button("Send").click()
    expect(pad.states).to_have_text(["reached"])
    goal = pad.ask("pad.goals[0]")
    assert (goal["x"], goal["y"], heading(goal)) == (2.0, 2.5, pytest.approx(180))


def test_refused_and_busy_are_told_with_the_reason(pad: Pad) -> None:
    pad.choose_speed("1")
    pad.page.locator(".tl-goal-form").get_by_label("x m").fill("12")
    pad.page.locator(".tl-goal-form").get_by_label("x m").press("Enter")
    expect(pad.states).to_have_text(["refused"])
    expect(pad.page.locator(".tl-goal small").first).to_contain_text("is outside the world: x and y must be from 0")
    pad.click(1.0, 1.0)
    expect(pad.page.locator(".tl-goal-progress")).to_contain_text(
        re.compile(r"Goal 2: \d\.\d\d m and \d+° to go, \d\.\d s")
    )
    pad.click(9.0, 9.0)
    expect(pad.states).to_have_text(["busy", "on its way", "refused"])
    expect(pad.page.locator(".tl-goal small").first).to_contain_text("Still on the way to (1.")


def test_fifty_clicks_lose_none(pad: Pad) -> None:
    clicks = """canvas => {
      const frame = canvas.getBoundingClientRect();
      canvas.setPointerCapture = () => {};
      for (let at = 0; at < 50; at++) {
        const place = { clientX: frame.left + 40 + 4 * at, clientY: frame.top + 200, pointerId: 1, button: 0, bubbles: true };
        canvas.dispatchEvent(new PointerEvent('pointerdown', place));
        canvas.dispatchEvent(new PointerEvent('pointerup', place));
      }
      delete canvas.setPointerCapture;
    }"""
    pad.map.evaluate(clicks)
    expect(pad.states).to_have_count(50)
    expect(pad.states.filter(has_text="on its way")).to_have_count(0)
    states = Counter(pad.states.all_inner_texts())
    assert states["reached"] >= 1
    assert states["reached"] + states["busy"] == 50
    assert [goal["number"] for goal in pad.ask("pad.goals")] == list(range(1, 51))


def test_the_clock_pauses_steps_and_keeps_its_speed(pad: Pad) -> None:
    begun = pad.ask("lesson.now")
    pad.button("Step 0.1 s").click()
    expect(pad.page.locator(".tl-dial dd").first).to_have_text(f"{begun + 0.1:.1f} s")
    assert pad.ask("lesson.now") == pytest.approx(begun + 0.1)
    pad.button("Play").click()
    expect(pad.page.locator(".tl-dial dd").last).to_have_text(re.compile(r"× (9\.\d|1\d)"))
    expect(pad.button("Step 0.1 s")).to_be_disabled()
    pad.choose_speed("max")
    expect(pad.page.locator(".tl-dial dd").last).to_have_text(re.compile(r"× \d\d+"))
    pad.button("Pause").click()
    paused = pad.ask("lesson.now")
    pad.page.wait_for_timeout(200)
    assert pad.ask("lesson.now") == paused


def test_an_obstacle_dragged_into_the_scan_is_seen(pad: Pad) -> None:
    ahead = "lesson._recording.last_scan.ranges[90]"
    assert pad.ask(ahead) == pytest.approx(WORLD - 5.544445, abs=0.01)
    pad.button("Edit the world").click()
    pad.button("Add a circle").click()
    expect(pad.words).to_contain_text("1 obstacle in the world.")
    circle = pad.ask("pad.obstacles[0]")
    pad.drag((circle["x"], circle["y"]), (9.0, 8.0), (9.0, 5.5))
    expect(pad.words).to_contain_text("Now a circle at (9.0")
    now = pad.ask("lesson.now")
    pad.button("Step 0.1 s").click(click_count=3)
    expect(pad.page.locator(".tl-dial dd").first).to_have_text(f"{now + 0.3:.1f} s")
    assert pad.ask(ahead) == pytest.approx(9.0 - 0.5 - 5.544445, abs=0.1)
    assert pad.ask("len(pad.desk.goals)") == 0, "on the editor's map a click sends no goal"


def test_obstacles_are_changed_by_numbers_and_keys(pad: Pad) -> None:
    pad.button("Edit the world").click()
    pad.page.get_by_label("Ready-made world").select_option("three pillars")
    pad.button("Load this world").click()
    expect(pad.page.locator(".tl-obstacles button")).to_have_count(3)
    pad.page.locator(".tl-obstacles button").nth(1).click()
    pad.page.get_by_label("radius m").fill("1.25")
    pad.page.get_by_label("radius m").press("Tab")
    expect(pad.words).to_contain_text("radius 1.25 m")
    pad.map.focus()
    for key in ("ArrowRight", "Shift+ArrowUp"):
        pad.map.press(key)
    expect(pad.words).to_contain_text("circle at (4.00, 8.10), radius 1.25 m")
    pad.map.press("Delete")
    expect(pad.page.locator(".tl-obstacles button")).to_have_count(2)
    assert pad.ask("[each.radius for each in lesson.obstacles]") == [0.4, 0.6]
    pad.page.get_by_label("radius m").fill("-1")
    pad.page.get_by_label("radius m").press("Tab")
    expect(pad.words).to_contain_text("radius must be a number above zero")


def test_it_fits_into_small_and_large_windows(pad: Pad) -> None:
    spill = "root => root.scrollWidth - root.clientWidth"
    for width in (800, 1600):
        pad.page.set_viewport_size({"width": width, "height": 1000})
        for mode in ("Edit the world", "Send goals"):
            pad.button(mode).click()
            assert pad.page.locator(".tl-root").evaluate(spill) <= 0
            for card in pad.page.locator(".tl-card:visible").all():
                assert card.evaluate(spill) <= 1


@pytest.mark.parametrize("theme", ["Light", "Dark"])
def test_it_can_be_used_by_all(pad: Pad, theme: str) -> None:
    choose_theme(pad.page, theme)
    pad.do(
        "lesson.set_obstacles('three pillars'); pad.do_goal(12.0, 2.0, 0.0); lesson.pause(); lesson.run(1); pad._tick()"
    )
    for mode in ("Send goals", "Edit the world"):
        pad.button(mode).click()
        assert serious_violations(pad.page, ".tl-root") == []


def test_an_ended_world_is_said(pad: Pad) -> None:
    pad.do("newer = start(seed=1)")
    expect(pad.page.locator(".tl-ended")).to_be_visible()


def test_all_of_it_happened_in_the_kernels_main_thread_and_without_a_complaint(
    window: Page, problems: list[str]
) -> None:
    assert Pad(window).ask("threads") == {True}
    assert problems == []
