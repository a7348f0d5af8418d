"""The live lab as a whole, in JupyterLab: all widgets on one page, two windows, a restart; threads, ports, and all readers.

What single widgets do is told in the files named after them.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterator

import pytest
from jupyter_pages import (
    Lab,
    choose_theme,
    execute,
    new_window,
    notebook_in,
    open_notebook,
    python,
    serious_violations,
    value,
    write_notebook,
)
from playwright.sync_api import Browser, Locator, Page, expect

WATCHES = '''
import os, threading
from pathlib import Path

def sockets_that_wait():
    """The TCP sockets on which this process or a child of its own waits for callers, and their UDP sockets."""
    families, processes = ("tcp", "tcp6", "udp", "udp6"), [Path("/proc/self")]
    for process in processes:
        for task in (process / "task").iterdir():
            processes += [Path("/proc", child) for child in (task / "children").read_text().split()]
    own = set()
    for handle in (handle for process in processes for handle in (process / "fd").iterdir()):
        try:
            own.add(os.readlink(handle))
        except FileNotFoundError:  # the one that was just used to list them
            pass
    rows = [(family, *row.split()) for family in families if Path("/proc/net", family).exists()
            for row in Path("/proc/net", family).read_text().splitlines()[1:]]
    return {(row[0], row[2]) for row in rows if f"socket:[{row[10]}]" in own and (row[4] == "0A" or "udp" in row[0])}

waited_before = sockets_that_wait()

from ipywidgets import Widget
from turtle_lesson.lab.widgets.live_widget import LiveWidget

arrived, carried_out = {}, {}

def note_threads(owner, name, seen):
    """From now on, note in which thread a method is called, and for which widget."""
    real = getattr(owner, name)
    def noting(self, *rest):
        seen.setdefault(type(self).__name__, set()).add(threading.current_thread() is threading.main_thread())
        return real(self, *rest)
    setattr(owner, name, noting)

note_threads(Widget, "_handle_custom_msg", arrived)
for name in ("_order", "_carry_out", "_tick"):
    note_threads(LiveWidget, name, carried_out)
'''
SYSTEM = """%load_ext turtle_lesson
from turtle_lesson import start
lesson = start(seed=0)
launched = lesson.launch("robot_controller", "start_system.launch.py", source="world")
lesson.run(1)"""
WIDGETS = {
    "Dashboard": ("lesson.dashboard()", ".tl-root:has(.tl-dashboard:not(.tl-pad))"),
    "GoalPad": ("lesson.goal_pad()", ".tl-root:has(.tl-pad)"),
    "Teleop": ("lesson.teleop()", ".tl-teleop"),
    "Form": ('lesson.form("/turtle1/cmd_vel")', ".tl-form"),
    "LivePlot": ('lesson.live_plot("/turtle1/pose/x")', ".tl-live"),
    "ParametersPanel": ('lesson.parameters("/navigator")', ".tl-parameters"),
    "Scene": ("lesson.scene()", ".tl-scene"),
    "PredictionWidget": (
        'lesson.predict("way", "Does it turn first?", choices=["yes", "no"])',
        "section.tl-prediction",
    ),
}
CELLS = [WATCHES, SYSTEM, *(cell for cell, _ in WIDGETS.values())]
NAME = "live_lab.ipynb"
EDGES = {"left": 26, "right": 10, "top": 10}
WORLD = 11.088889


def widget(page: Page, name: str) -> Locator:
    """A widget of the page, scrolled into view."""
    found = page.locator(WIDGETS[name][1])
    found.scroll_into_view_if_needed()
    return found


class Board:
    """The dashboard in a window."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.root = widget(page, "Dashboard")
        self.states = self.root.locator(".tl-goal strong")
        self.answers = self.root.locator(".tl-goal small")
        self.dials = self.root.locator(".tl-dial dd")

    def click(self, x: float, y: float) -> None:
        """Click on the map at a place in metres."""
        canvas = self.root.locator(".tl-map")
        canvas.scroll_into_view_if_needed()
        box = canvas.bounding_box()
        assert box is not None
        scale = (box["width"] - EDGES["left"] - EDGES["right"]) / WORLD
        self.page.mouse.click(box["x"] + EDGES["left"] + x * scale, box["y"] + EDGES["top"] + (WORLD - y) * scale)

    def button(self, name: str) -> Locator:
        return self.root.get_by_role("button", name=name, exact=True)

    def choose_speed(self, speed: str) -> None:
        self.root.get_by_label("Speed of robot time").select_option(speed)

    def pause(self) -> None:
        python(self.page, "lesson.pause()")
        expect(self.button("Play")).to_be_visible()


def pose_by_topic(page: Page) -> tuple[float, float]:
    """Where the turtle is, as anybody would ask in a terminal."""
    said = python(page, "ros2 topic echo --once /turtle1/pose")
    return tuple(float(re.findall(rf"^{name}: (.+)$", said, re.MULTILINE)[0]) for name in "xy")  # type: ignore[return-value]


@pytest.fixture(scope="module")
def problems() -> list[str]:
    """What the browser complained of."""
    return []


@pytest.fixture(scope="module")
def window(desktop: Page, lab: Lab, problems: list[str]) -> Iterator[Page]:
    """A window in which all cells were run."""
    write_notebook(lab, NAME, CELLS)
    with notebook_in(desktop, lab, NAME, problems) as page:
        execute(page, "notebook:run-all-cells")
        all_are_there(page)
        yield page


def all_are_there(page: Page) -> None:
    for name in WIDGETS:
        page.locator(WIDGETS[name][1]).wait_for(state="attached")
    scene = page.locator(".tl-scene-frame")
    scene.scroll_into_view_if_needed()
    expect(scene).to_be_visible()


@pytest.fixture
def board(window: Page) -> Board:
    """The dashboard, at ten times the pace of life, while time stands still and no goal is on its way."""
    board = Board(window)
    board.pause()
    python(window, "lesson.run(20)")
    board.choose_speed("10")
    return board


def test_widgets_of_one_window_are_known_to_share_a_page(window: Page) -> None:
    shown = "lesson.dashboard(), lesson.goal_pad(), lesson.scene(), lesson.teleop()"
    pages = "{view.partition('/')[0] for view in each._views}"
    assert value(window, f"len(set.intersection(*({pages} for each in ({shown}))))") > 0


def test_showing_all_of_it_moved_nothing(window: Page) -> None:
    assert value(window, "lesson.now") == 1.9


def test_a_click_on_the_dashboard_brings_the_turtle_there(board: Board) -> None:
    board.click(8.0, 3.0)
    expect(board.states).to_have_text(["reached"])
    expect(board.answers.first).to_have_text(re.compile(r"success: True, time_taken: \d\.\d s"))
    board.pause()
    assert math.dist(pose_by_topic(board.page), (8.0, 3.0)) < 0.2


def test_without_a_navigator_it_says_so_and_how_to_start_one(board: Board) -> None:
    python(board.page, "launched.stop()")
    board.click(2.0, 2.0)
    expect(board.states.first).to_have_text("not sent")
    expect(board.answers.first).to_contain_text(
        'No node answers /navigate_to. Start the navigator: lesson.launch("robot'
    )
    expect(board.root.locator(".tl-light-missing")).to_have_count(4)
    python(board.page, SYSTEM.splitlines()[3])
    board.click(2.0, 2.0)
    expect(board.states.first).to_have_text("reached")
    expect(board.root.locator(".tl-light-missing")).to_have_count(0)


def test_all_of_it_can_be_used_by_all(board: Board) -> None:
    page, size = board.page, board.page.viewport_size
    assert size is not None
    python(page, "for x in (2.0, 9.0): lesson.dashboard().desk.send(x, 5.0, 0.0)\nlesson.run(1)")
    expect(board.states).to_contain_text(["busy", "on its way", "not sent", "reached"])
    page.set_viewport_size({"width": size["width"], "height": 6500})  # axe-core looks at no text that is out of sight
    for name in WIDGETS:
        widget(page, name).evaluate("root => root.setAttribute('data-looked-at', '')")
    for looked_at in (found := page.locator("[data-looked-at]")).all():
        assert (box := looked_at.bounding_box()) is not None and 0 <= box["y"] < 6500 - box["height"]
    expect(found).to_have_count(len(WIDGETS))
    for theme in ("Light", "Dark"):
        choose_theme(page, theme)
        assert (theme, serious_violations(page, "[data-looked-at]")) == (theme, [])
    page.set_viewport_size(size)


def second_window(browser: Browser, lab: Lab, problems: list[str]) -> Page:
    """A window that has opened the saved page and shows its dashboard.

    JupyterLab gives a widget up for good if its kernel tells of it just as the two seconds end that JupyterLab waits for
    it, which happens on a busy machine (renderModel of jupyterlab-manager). Such a window is closed and opened again.
    """
    for _ in range(20):
        page = new_window(browser, problems, width=900)
        open_notebook(page, lab, NAME)
        given_up = page.get_by_text("Error displaying widget: model not found")
        given_up.or_(page.locator(WIDGETS["Dashboard"][1])).first.wait_for(state="attached")
        problems[:] = [problem for problem in problems if not problem.startswith("Error: widget model not found")]
        if given_up.count() == 0:
            return page
        page.close()
    raise AssertionError("JupyterLab gave up the widgets of twenty windows")


def test_a_window_that_opens_the_saved_page_is_in_step(
    board: Board, browser: Browser, lab: Lab, problems: list[str]
) -> None:
    execute(board.page, "docmanager:save")
    page = second_window(browser, lab, problems)
    other = Board(page)  # which no cell had to be run for
    expect(other.states).to_have_text(board.states.all_inner_texts())
    expect(other.root.get_by_label("Speed of robot time")).to_have_value("10")
    other.click(9.0, 9.0)
    for each in (board, other):
        expect(each.states.first).to_have_text("reached")
        expect(each.button("Pause")).to_be_visible()
    board.button("Pause").click()
    expect(other.button("Play")).to_be_visible()
    other.choose_speed("20")
    expect(board.root.get_by_label("Speed of robot time")).to_have_value("20")
    assert other.dials.all_inner_texts() == board.dials.all_inner_texts()
    assert other.answers.all_inner_texts() == board.answers.all_inner_texts()

    pad, others_pad = (widget(each, "GoalPad") for each in (board.page, page))
    for each in (pad, others_pad):
        expect(each.get_by_label("Speed of robot time")).to_have_value("20")
    assert others_pad.locator(".tl-goal").all_inner_texts() == pad.locator(".tl-goal").all_inner_texts()
    assert others_pad.locator(".tl-dial dd").all_inner_texts() == pad.locator(".tl-dial dd").all_inner_texts()

    page.evaluate(
        "at => (window.jupyterapp.shell.currentWidget.content.activeCellIndex = at)", len(CELLS) - len(WIDGETS)
    )
    other.root.evaluate("root => root.setAttribute('data-old', '')")
    execute(page, "notebook:run-cell")  # and it has a dashboard of its own
    page.locator("[data-old]").wait_for(state="detached")
    lines, tools = ".tl-log-line:visible", ".tl-log-tools select"
    board.root.locator(tools).select_option("FATAL")
    expect(other.root.locator(tools)).to_have_value("FATAL")
    expect(other.root.locator(lines)).to_have_count(0)
    other.root.locator(tools).select_option("INFO")
    expect(board.root.locator(lines).first).to_be_visible()
    expect(other.root.locator(lines).first).to_be_visible()
    assert other.root.locator(".tl-log-text").all_inner_texts() == board.root.locator(".tl-log-text").all_inner_texts()
    page.close()


def test_all_orders_are_carried_out_in_the_main_thread_wherever_they_arrive(board: Board) -> None:
    page = board.page
    board.button("Play").click()
    widget(page, "GoalPad").get_by_role("button", name="Send", exact=True).click()
    widget(page, "Teleop").locator(".tl-stick").press("w")
    widget(page, "Form").get_by_role("button", name="Publish once").click()
    widget(page, "ParametersPanel").locator('input[type="range"]').first.press("ArrowLeft")
    widget(page, "PredictionWidget").get_by_role("button", name="yes").click()
    expect(page.locator(WIDGETS["PredictionWidget"][1])).to_contain_text("Recorded: yes")
    expect(page.locator(".tl-form")).to_contain_text("1 published")
    expect(page.locator(".tl-parameters .tl-said")).to_have_text(re.compile(r"\w+ is .+ now\."))

    assert value(page, "set(carried_out)") == set(WIDGETS), "every widget had orders"
    assert value(page, "set().union(*carried_out.values())") == {True}
    assert value(page, "False in set().union(*arrived.values())"), "some orders came through another thread"


@pytest.mark.skipif(sys.platform != "linux", reason="sockets are read from /proc")
def test_nothing_listens_on_a_new_port(window: Page) -> None:
    assert value(window, "len(waited_before)") > 0, "a kernel listens, so the look at sockets works"
    assert value(window, "sockets_that_wait() - waited_before") == set()


def test_fifty_clicks_in_a_second_while_time_goes_on(board: Board) -> None:
    sent = value(board.page, "len(lesson.dashboard().desk.goals)")
    clicks = """canvas => new Promise(done => {
      canvas.setPointerCapture = () => {};
      let clicked = 0;
      const timer = setInterval(() => {
        const frame = canvas.getBoundingClientRect();
        const place = { clientX: frame.left + 40 + 4 * clicked, clientY: frame.top + 200, pointerId: 1, bubbles: true };
        for (const name of ['pointerdown', 'pointerup']) canvas.dispatchEvent(new PointerEvent(name, place));
        if (++clicked === 50) clearInterval(timer), delete canvas.setPointerCapture, done();
      }, 20);
    })"""
    board.button("Play").click()
    board.root.locator(".tl-map").evaluate(clicks)
    expect(board.root.locator(".tl-goal-busy").first).to_be_attached()
    expect(board.states).to_have_count(min(sent + 50, 60))
    board.pause()
    python(board.page, "lesson.run(20)")  # to the end of the last trip, without a frame for each moment
    expect(board.root.locator(".tl-goal-on-its-way")).to_have_count(0)
    new = value(board.page, f"[(each.number, each.x, each.state) for each in lesson.dashboard().desk.goals[{sent}:]]")
    assert [number for number, _, _ in new] == list(range(sent + 1, sent + 51))
    assert [x for _, x, _ in new] == sorted({x for _, x, _ in new}), "each once, and in their order"
    assert {state for _, _, state in new} == {"reached", "busy"}


def test_fifty_steps_in_a_second_are_fifty_steps(board: Board) -> None:
    begun = value(board.page, "lesson.now")
    expect(board.button("Step 0.1 s")).to_be_enabled()
    board.button("Step 0.1 s").evaluate("""button => new Promise(done => {
      let clicked = 0;
      const timer = setInterval(() => (button.click(), ++clicked === 50 && (clearInterval(timer), done())), 20);
    })""")
    expect(board.dials.first).to_have_text(f"{begun + 5:.1f} s")
    assert value(board.page, "lesson.now") == pytest.approx(begun + 5)


def test_a_restart_and_run_all_brings_all_of_it_back(board: Board, problems: list[str]) -> None:
    page = board.page
    assert problems == []
    board.button("Play").click()  # it is in full swing
    page.evaluate("() => void window.jupyterapp.commands.execute('notebook:restart-run-all')")
    page.get_by_role("button", name="Confirm Kernel Restart").click()
    board.root.wait_for(state="detached")
    all_are_there(page)
    late = "Comm not found for comm id"  # what JupyterLab says of a frame that arrives after its kernel's end
    problems[:] = [problem for problem in problems if not problem.startswith(late)]
    board = Board(page)
    expect(board.dials.first).to_have_text("1.9 s")
    expect(board.states).to_have_count(0)
    board.choose_speed("10")
    board.click(3.0, 8.0)
    expect(board.states).to_have_text(["reached"])
    board.pause()
    assert math.dist(pose_by_topic(page), (3.0, 8.0)) < 0.2
    assert value(page, "set().union(*carried_out.values())") == {True}


def test_the_browser_had_nothing_to_complain_of(window: Page, problems: list[str]) -> None:
    assert problems == []
