"""Teleop, form, live plot and parameters in JupyterLab: what hands do there reaches the robot."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from jupyter_pages import Lab, execute, notebook_in, serious_violations, write_notebook
from playwright.sync_api import Locator, Page, expect

CELLS = (
    """%load_ext turtle_lesson
from turtle_lesson import start
lesson = start(seed=0)
_ = lesson.launch("robot_controller", "start_system.launch.py")
lesson.run(1)""",
    "lesson.teleop()",
    'lesson.form("/turtle1/cmd_vel")',
    'lesson.form("/navigate_to")',
    'lesson.live_plot("/turtle1/pose/x", "/turtle1/cmd_vel/linear/x", "/turtle2/pose/x")',
    'lesson.parameters("/navigator")',
    "lesson.teleop()",
    "",
)
QUIT_BY_Q = """import sys, tty
tty.setraw(sys.stdin)
while sys.stdin.read(1) != "q":
    pass
"""
NAME = "small.ipynb"


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
        page.wait_for_selector(".tl-parameters", state="attached")
        expect(page.locator(".tl-teleop")).to_have_count(2)
        yield page


def speed(widget: Locator) -> Locator:
    return widget.locator(".tl-value").first


def test_the_panel_waits_for_time_and_asks_when_told_to(window: Page) -> None:
    panel = window.locator(".tl-parameters")
    panel.scroll_into_view_if_needed()
    panel.get_by_role("button", name="Ask now").click()
    expect(panel.locator(".tl-item")).to_have_count(7)


def test_the_stick_drives_while_it_is_held(window: Page) -> None:
    teleop, other = window.locator(".tl-teleop").first, window.locator(".tl-teleop").last
    stick = teleop.locator(".tl-stick")
    stick.scroll_into_view_if_needed()
    box = stick.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    window.mouse.move(x, y)
    window.mouse.down()
    window.mouse.move(x, y - 200, steps=3)
    expect(speed(teleop)).to_have_text("2.00")
    expect(speed(other)).to_have_text("2.00")
    expect(teleop.locator(".tl-head")).to_contain_text(re.compile(r"\d\d sent"))
    window.mouse.up()
    expect(speed(teleop)).to_have_text("0.00")
    expect(teleop.locator(".tl-said")).to_have_text("Stopped.")


def test_keys_drive_and_leaving_the_stick_stops(window: Page) -> None:
    teleop = window.locator(".tl-teleop").first
    teleop.locator(".tl-stick").focus()
    window.keyboard.down("ArrowUp")
    window.keyboard.down("d")
    expect(speed(teleop)).to_have_text("2.00")
    expect(teleop.locator(".tl-value").last).to_have_text("−2.00")
    window.keyboard.press("Space")
    expect(speed(teleop)).to_have_text("0.00")
    window.keyboard.up("d")
    window.keyboard.up("ArrowUp")
    window.keyboard.down("w")
    expect(speed(teleop)).to_have_text("2.00")
    teleop.locator(".tl-stick").evaluate("stick => stick.blur()")
    expect(speed(teleop)).to_have_text("0.00")
    window.keyboard.up("w")


def test_a_page_that_hangs_lets_go_of_the_stick(window: Page) -> None:
    teleop = window.locator(".tl-teleop").first
    teleop.locator(".tl-stick").focus()
    window.keyboard.down("w")
    expect(speed(teleop)).to_have_text("2.00")
    window.evaluate("() => { const end = performance.now() + 700; while (performance.now() < end); }")
    expect(window.locator(".tl-teleop .tl-said").first).to_have_text(re.compile("Driving|said nothing for 0.3 s"))
    window.keyboard.up("w")
    expect(speed(teleop)).to_have_text("0.00")


def test_the_plot_has_seen_it(window: Page) -> None:
    plot = window.locator(".tl-live")
    plot.scroll_into_view_if_needed()
    label = re.compile(r"/turtle1/pose/x: \d+ messages, last \d.*/linear/x: \d+ messages, last 0.00, from 0.00 to 2.00")
    expect(plot.locator("canvas")).to_have_attribute("aria-label", label)
    expect(plot.locator(".tl-notes")).to_contain_text("/turtle2/pose/x There is no such topic yet")
    colours = "canvas => new Set(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data).size"
    assert plot.locator("canvas").evaluate(colours) > 20


def test_the_form_publishes(window: Page) -> None:
    form = window.locator(".tl-form").first
    form.scroll_into_view_if_needed()
    field = form.locator('[data-path="linear/x"]')
    field.fill("1,5")
    expect(form.locator(".tl-bad", has_text="write a point")).to_be_visible()
    expect(form.get_by_role("button", name="Publish once")).to_be_disabled()
    field.fill("1.5")
    expect(form.locator(".tl-line")).to_contain_text('"{linear: {x: 1.5}}"')
    form.get_by_role("button", name="Publish once").click()
    expect(form.locator(".tl-actions")).to_contain_text("1 published")
    form.get_by_role("button", name="Publish repeatedly").click()
    expect(form.locator(".tl-line")).to_contain_text("--rate 10")
    expect(form.locator(".tl-actions")).to_contain_text(re.compile(r"\d\d published"))
    form.get_by_role("button", name="Stop").click()
    expect(form.locator(".tl-said")).to_contain_text("Stopped after")


def test_the_form_calls(window: Page) -> None:
    form = window.locator(".tl-form").last
    form.scroll_into_view_if_needed()
    form.locator('[data-path="x"]').fill("8")
    form.locator('[data-path="y"]').fill("8")
    form.get_by_role("button", name="Call").click()
    expect(form.locator(".tl-answer")).to_contain_text("success: true")
    expect(form.locator(".tl-said")).to_contain_text("/navigate_to answered after")


def test_a_parameter_is_set_refused_and_moved_by_keys(window: Page) -> None:
    panel = window.locator(".tl-parameters")
    row = panel.locator(".tl-item", has_text="linear_speed")
    row.scroll_into_view_if_needed()
    field, slider = row.locator('input[type="text"]'), row.locator('input[type="range"]')
    field.fill("77")
    field.press("Enter")
    expect(row.locator(".tl-bad")).to_contain_text("Refused: Parameter linear_speed out of range")
    expect(field).to_have_value("4.0")
    slider.focus()
    slider.press("ArrowLeft")
    expect(panel.locator(".tl-said")).to_have_text(re.compile(r"linear_speed is 3\.9\d now\."))
    expect(row.locator(".tl-bad")).to_have_text("")
    expect(field).to_have_value(re.compile(r"3\.9\d"))


def test_all_of_it_can_be_used_by_all(window: Page) -> None:
    assert serious_violations(window, ".tl-teleop, .tl-form, .tl-live, .tl-parameters") == []


def test_nothing_is_wider_than_the_window(window: Page) -> None:
    for width in (800, 1600):
        window.set_viewport_size({"width": width, "height": 1000})
        for widget in window.locator(".tl-small").all():
            assert widget.evaluate("root => root.scrollWidth <= root.clientWidth + 1")


def test_a_world_that_ended_is_said_to_have(window: Page) -> None:
    window.evaluate("() => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = 0 }")
    execute(window, "notebook:run-cell")
    for name in ("teleop", "form", "live", "parameters"):
        expect(window.locator(f".tl-{name}").first).to_contain_text("This world has ended.")


def test_keys_go_to_a_program_that_reads_them(window: Page, lab: Lab) -> None:
    (lab.folder / "quit_by_q.py").write_text(QUIT_BY_Q)
    window.evaluate("""() => {
      const { content } = window.jupyterapp.shell.currentWidget;
      content.activeCellIndex = content.widgets.length - 1;
      content.activeCell.model.sharedModel.setSource('python3 quit_by_q.py\\nlesson.teleop()');
    }""")
    execute(window, "notebook:run-cell")
    teleop = window.locator(".tl-teleop").last
    said = teleop.locator(".tl-unheard")
    expect(said).to_have_text("Keys pressed on the stick go to quit_by_q.")
    teleop.locator(".tl-stick").focus()
    window.keyboard.press("w")
    expect(teleop.locator(".tl-said")).to_have_text("Keys go to quit_by_q.")
    expect(speed(teleop)).to_have_text("0.00")
    window.keyboard.press("q")
    expect(said).to_have_text("")
    window.keyboard.down("w")
    expect(speed(teleop)).to_have_text("2.00")
    window.keyboard.up("w")


def test_the_browser_had_nothing_to_complain_of(window: Page, problems: list[str]) -> None:
    assert problems == []
