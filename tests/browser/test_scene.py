"""The 3-D scene in a real JupyterLab: it is drawn, it follows the turtle, and its pages need no network."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jupyter_pages import NOTEBOOK, Lab, notebook_in, serious_violations, write_notebook
from PIL import Image
from playwright.sync_api import Browser, Page

from turtle_lesson import start

CELLS = [
    """import psutil
from turtle_lesson import start
lesson = start(seed=0)
_ = lesson.launch("robot_controller", "start_system.launch.py", source="world")
lesson.run(1)
def listening():
    here = psutil.Process()
    return {each.laddr for process in (here, *here.children(True)) for each in process.net_connections()
            if each.status == psutil.CONN_LISTEN}
ports = listening()""",
    "lesson.scene()",
    "lesson.goal_pad().desk.send(9.0, 9.0, 0.0)\nlesson.run(4)",
    "lesson.set_obstacles('three pillars')\nlesson.run(1.5)",
    "print('new ports:', sorted(listening() - ports), 'children:', psutil.Process().children(True))",
    "lesson.scene()",
    "lesson = start(seed=0)",
]
DRAWN = "() => window.viewer && window.viewer.scene_tree.find(['lab', 'turtle']).object.visible"
PLACE = "() => window.viewer.scene_tree.find(['lab', 'turtle']).object.position.toArray()"
CAMERA = "() => window.viewer.camera.position.toArray()"


@pytest.fixture(scope="module")
def problems() -> list[str]:
    """What the browser complained about."""
    return []


@pytest.fixture(scope="module")
def page(desktop: Page, lab: Lab, problems: list[str]) -> Iterator[Page]:
    """One window for all tests of this file, which go through its cells from the first to the last."""
    write_notebook(lab, "scene.ipynb", CELLS)
    with notebook_in(desktop, lab, "scene.ipynb", problems, width=800) as page:
        run(page, 0)
        run(page, 1)
        yield page


def run(page: Page, number: int) -> None:
    """Run a cell, and wait until it is done."""
    page.evaluate(
        f"""async number => {{
            {NOTEBOOK}.content.activeCellIndex = number;
            await window.jupyterapp.commands.execute('notebook:run-cell');
        }}""",
        number,
    )


def printed(page: Page, number: int) -> str:
    outputs = page.evaluate(f"number => {NOTEBOOK}.content.model.cells.get(number).toJSON().outputs", number)
    return "".join("".join(output.get("text", "")) for output in outputs)


def inside(page: Page, number: int = 0) -> Any:
    """The frame of a scene, with the viewer in it, as soon as that has drawn the turtle."""
    handle = page.locator(".tl-scene-frame").nth(number).element_handle()
    assert handle is not None
    frame = handle.content_frame()
    assert frame is not None
    frame.wait_for_function(DRAWN)
    return frame


def pixels(page: Page, number: int = 0) -> np.ndarray:
    """What is to be seen of a scene: height by width by red, green and blue."""
    shown = page.locator(".tl-scene-frame").nth(number).screenshot()
    return np.asarray(Image.open(io.BytesIO(shown)).convert("RGB")).astype(int)


def shell(picture: np.ndarray) -> np.ndarray:
    """Where the turtle's green shell is: x and y of its middle, in pixels."""
    red, green, blue = np.moveaxis(picture, -1, 0)
    rows, columns = np.nonzero((green > red + 60) & (green > blue + 15))
    assert len(rows) > 20, "there is no green turtle in the picture"
    return np.array([columns.mean(), rows.mean()])


def stands_still(frame: Any) -> None:
    """Wait until the camera has arrived."""
    frame.wait_for_function(
        f"""() => {{
            const here = ({CAMERA})().map((each) => each.toFixed(3)).join();
            const same = here === window.before;
            window.before = here;
            return same;
        }}""",
        polling=150,
    )


def test_snapshot_and_animation_are_alive_without_network(browser: Browser, tmp_path: Path) -> None:
    lesson = start(seed=0)
    lesson.launch("robot_controller", "start_system.launch.py", source="world")
    lesson.goal_pad().desk.send(8.0, 8.0, 0.0)
    lesson.run(4)
    scene = lesson.scene()
    snapshot, animation = scene.snapshot().save(tmp_path / "still.html"), scene.animation().save(tmp_path / "run.html")
    page = browser.new_page(viewport={"width": 1000, "height": 640}, color_scheme="dark")
    asked: list[str] = []
    complaints: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.goto(snapshot.as_uri())
    inside(page)
    picture = pixels(page)
    shell(picture)
    assert picture[-5:, :5].mean() < 80  # dark, as the reader's machine is

    page.goto(animation.as_uri())
    frame = inside(page)
    begin = frame.evaluate(PLACE)
    page.get_by_label("Speed").select_option("10")
    page.get_by_role("button", name="Play").click()
    frame.wait_for_function(f"begin => Math.hypot(...({PLACE})().map((each, at) => each - begin[at])) > 3", arg=begin)
    page.wait_for_function("() => document.querySelector('.tl-scene-play').textContent === 'Play'")  # it has ended
    assert frame.evaluate(PLACE)[:2] == pytest.approx([8, 8], abs=0.2)
    page.get_by_label("Robot time").fill("0")
    frame.wait_for_function(
        f"begin => Math.hypot(...({PLACE})().map((each, at) => each - begin[at])) < 0.01", arg=begin
    )
    assert asked == [snapshot.as_uri(), animation.as_uri()] and complaints == []
    page.close()


def test_the_scene_is_drawn(page: Page) -> None:
    inside(page)
    picture = pixels(page)
    assert len(np.unique(picture @ [256 * 256, 256, 1])) > 150, "so many colours"
    shell(picture)
    assert page.locator(".tl-scene-caption").inner_text().startswith("Turtle at (5.54, 5.54) m facing 0.0°")


def test_it_follows_the_turtle(page: Page) -> None:
    frame = inside(page)
    page.get_by_role("button", name="From above").click()
    stands_still(frame)
    before = shell(pixels(page))
    run(page, 2)
    frame.wait_for_function(f"() => Math.hypot(...({PLACE})().map((each, at) => each - [9, 9, 0][at])) < 0.3")
    after = shell(pixels(page))
    assert after[0] > before[0] + 40 and after[1] < before[1] - 40  # to the upper right

    away = frame.evaluate(CAMERA)
    page.get_by_role("button", name="Follow").click()
    frame.wait_for_function(f"away => Math.hypot(...({CAMERA})().map((each, at) => each - away[at])) > 3", arg=away)
    stands_still(frame)
    place = [3.456, 0.0, -3.456]  # of the goal, in the viewer's own axes
    assert np.hypot(*(np.array(frame.evaluate(CAMERA)) - place)[[0, 2]]) < 5
    page.wait_for_function("() => document.querySelector('.tl-scene-words').textContent.includes('reached')")


def test_obstacles_appear(page: Page) -> None:
    frame = inside(page)
    run(page, 3)
    frame.wait_for_function("() => Object.keys(viewer.scene_tree.find(['lab', 'obstacles']).children).length === 3")
    page.get_by_role("button", name="From above").click()
    stands_still(frame)
    red, green, blue = np.moveaxis(pixels(page), -1, 0)
    assert ((red > 190) & (green > 130) & (blue < 120)).sum() > 300  # their orange


def test_keys_turn_the_view_and_the_laser_can_be_hidden(page: Page) -> None:
    frame = inside(page)
    page.get_by_role("button", name="Free").click()
    stands_still(frame)
    before = frame.evaluate(CAMERA)
    frame.locator("#pane").focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("+")
    frame.wait_for_function(f"away => Math.hypot(...({CAMERA})().map((each, at) => each - away[at])) > 1", arg=before)
    assert "Arrow keys turn the view" in frame.locator("#pane").get_attribute("aria-label")
    laser = page.get_by_role("button", name="Laser")
    laser.press("Enter")
    assert laser.get_attribute("aria-pressed") == "false"
    assert not frame.evaluate("() => viewer.scene_tree.find(['lab', 'scan']).object.visible")
    laser.press("Enter")


def test_a_view_that_comes_late_or_is_moved_is_complete(page: Page) -> None:
    run(page, 5)
    second = inside(page, 1)
    assert second.evaluate(PLACE) == pytest.approx(inside(page).evaluate(PLACE))
    assert len(second.evaluate("() => Object.keys(viewer.scene_tree.find(['lab', 'obstacles']).children)")) == 3
    second.evaluate("() => (window.old = true)")
    page.locator(".tl-scene-frame").nth(1).evaluate("frame => frame.parentElement.prepend(frame)")
    page.locator(".tl-scene-frame").nth(1).scroll_into_view_if_needed()
    again = inside(page, 1)
    assert not again.evaluate("() => window.old")
    assert again.evaluate(PLACE) == pytest.approx(inside(page).evaluate(PLACE))
    shell(pixels(page, 1))


def test_it_is_accessible(page: Page) -> None:
    assert serious_violations(page, ".tl-scene") == []
    assert serious_violations(inside(page), "body") == []


def test_nothing_listens_on_a_new_port(page: Page) -> None:
    run(page, 4)
    assert printed(page, 4) == "new ports: [] children: []\n"


def test_it_says_when_its_world_is_gone(page: Page) -> None:
    run(page, 6)
    page.wait_for_function(
        "() => document.querySelector('.tl-scene-words').textContent.startsWith('This world is gone')"
    )


def test_the_browser_had_nothing_to_complain_of(problems: list[str]) -> None:
    assert problems == []
