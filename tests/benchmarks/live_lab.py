"""How alive the live lab is: the whole dashboard in JupyterLab, beside matplotlib drawing the same into widgets.Image.

Everything is measured in one run, in a headless Chromium, while the turtle drives from goal to goal at the pace of life:
frames that the browser showed, processor time of the kernel and bytes on its channel for each, and how long a click takes
to be a call in Python, and to be seen as motion. Nothing is asserted.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, WebSocket, sync_playwright

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "browser"))

from jupyter_pages import FLAGS, execute, find_chromium, jupyterlab, open_notebook, python, value, write_notebook

SECONDS = 8
CLICKS = 20

SYSTEM = '''%load_ext turtle_lesson
import asyncio, itertools, json, math, time
import numpy as np
from turtle_lesson import start
lesson = start(seed=0)
_ = lesson.launch("robot_controller", "start_system.launch.py", source="world")
lesson.set_obstacles("three pillars")
lesson.run(30)
lesson.play(1)
recorder, desk, loop = lesson._recording, lesson.dashboard().desk, asyncio.get_running_loop()
called = []

async def wander():
    """Drive along a square for ever."""
    for x, y in itertools.cycle([(9.5, 1.5), (9.5, 9.5), (1.5, 9.5), (1.5, 1.5)]):
        goal = desk.send(x, y, 0.0)
        while goal.waits:
            await asyncio.sleep(0.02)

def stop_wandering():
    wandering.cancel()
    lesson.run(6)  # until it is there

def cpu():
    """Seconds that all threads of the kernel have computed."""
    return time.process_time()

real_goal = lesson.dashboard().do_goal
def do_goal(**goal):
    called.append(time.time() * 1000)
    real_goal(**goal)
lesson.dashboard().do_goal = do_goal
wandering = loop.create_task(wander())'''

DASHBOARD = "lesson.dashboard()"

PICTURE = """import io
import ipywidgets
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from IPython.display import display

figure = Figure((12, 5), layout="constrained")
grid = figure.subplot_mosaic([["map", name, "scan"] for name in ("x", "y", "theta", "vel_x", "battery")],
                             per_subplot_kw={"scan": {"projection": "polar"}}, width_ratios=[5, 4, 4])
grid["map"].set(xlim=(0, 11.09), ylim=(0, 11.09), aspect=1)
grid["map"].grid()
for each in lesson.obstacles:
    grid["map"].add_patch(Circle((each.x, each.y), each.radius, color="orange"))
trail, = grid["map"].plot([], [])
nose, = grid["map"].plot([], [], "g", lw=6)
hits, = grid["map"].plot([], [], "m.", ms=2)
beams, = grid["scan"].plot([], [], ".", ms=2)
grid["scan"].set_rmax(10)
curves = {name: grid[name].plot([], [])[0] for name in ("x", "y", "theta", "vel_x", "battery")}
for name, (low, high) in {"x": (0, 11), "y": (0, 11), "theta": (-4, 4), "vel_x": (-4, 4), "battery": (0, 100)}.items():
    grid[name].set(ylim=(low, high), xlim=(-30, 0))
mark = figure.add_artist(Rectangle((0, 0.96), 0.02, 0.04, color="white"))  # black once the turtle has moved
FigureCanvasAgg(figure).draw()
figure.set_layout_engine("none")  # or the layout would be sought anew at each frame
image = ipywidgets.Image(format="png")
button = ipywidgets.Button(description="Go")
places, start_pose = itertools.cycle([(6.2, 3.0), (5.4, 3.0)]), None

def go(_):
    called.append(time.time() * 1000)
    loop.call_soon_threadsafe(send)

def send():
    global start_pose
    start_pose = recorder.poses.newest(1)[0]
    desk.send(*next(places), 0.0)

def forget():
    global start_pose
    start_pose = None
    mark.set_color("white")

def draw():
    poses, statuses = recorder.poses.newest(500), recorder.statuses.newest(300)
    last, scan = poses[-1], recorder.last_scan
    trail.set_data(poses["x"], poses["y"])
    x, y, theta = (float(last[name]) for name in ("x", "y", "theta"))
    nose.set_data([x, x + 0.4 * math.cos(theta)], [y, y + 0.4 * math.sin(theta)])
    angles, ranges = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges)), np.array(scan.ranges)
    beams.set_data(angles, ranges)
    hits.set_data(x + ranges * np.cos(angles + theta), y + ranges * np.sin(angles + theta))
    for name, curve in curves.items():
        curve.set_data((statuses["stamp"] - statuses["stamp"][-1]) / 1e9, statuses[name])
    if start_pose is not None and any(abs(last[name] - start_pose[name]) > 1e-4 for name in ("x", "y", "theta")):
        mark.set_color("black")
    buffer = io.BytesIO()
    figure.canvas.print_png(buffer)
    image.value = buffer.getvalue()

async def draw_again_and_again():
    while True:
        began = loop.time()
        draw()
        await asyncio.sleep(max(1 / 30 - (loop.time() - began), 0.001))

button.on_click(go)
display(button, image)
drawing = loop.create_task(draw_again_and_again())"""

METER = """
window.meter = { frames: 0, pose: '', clicked: 0, moved: null, before: '' };
const wrap = (name, note) => {
  const real = CanvasRenderingContext2D.prototype[name];
  CanvasRenderingContext2D.prototype[name] = function (...values) {
    if (this.canvas.className === 'tl-map') note(this, values);
    return real.apply(this, values);
  };
};
wrap('clearRect', () => meter.frames++);  // each frame of the map begins with it
wrap('translate', (context, place) => (context.place = place));
wrap('rotate', (context, turn) => (meter.pose = String([...context.place, turn])));  // last of all, the turtle is turned
const corner = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
document.addEventListener('load', ({ target }) => {
  if (!target.matches?.('img.widget-image')) return;
  meter.frames++;
  corner.drawImage(target, 4, 4, 1, 1, 0, 0, 1, 1);
  meter.pose = corner.getImageData(0, 0, 1, 1).data[0] < 128 ? 'moved' : '';
}, true);
const click = () => Object.assign(meter, { clicked: Date.now(), moved: null, before: meter.pose });
addEventListener('pointerup', ({ target }) => target.className === 'tl-map' && click(), true);
addEventListener('click', ({ target }) => target.closest?.('.widget-button') && click(), true);
meter.watch = (seconds) => new Promise((done) => {
  let [last, shown] = [meter.frames, 0];
  const end = performance.now() + 1000 * seconds;
  const look = () => {
    shown += meter.frames !== last;
    last = meter.frames;
    performance.now() < end ? requestAnimationFrame(look) : done(shown / seconds);
  };
  requestAnimationFrame(look);
});
const look = () => {
  // what was drawn before this animation frame is on the screen now
  if (meter.clicked && meter.moved === null && meter.pose !== meter.before) meter.moved = Date.now() - meter.clicked;
  requestAnimationFrame(look);
};
requestAnimationFrame(look);
"""


class Wire:
    """What comes from the kernel for its widgets."""

    def __init__(self, page: Page) -> None:
        self.messages = self.bytes = 0
        page.on("websocket", self._listen)

    def _listen(self, socket: WebSocket) -> None:
        socket.on("framereceived", self._hear)

    def _hear(self, frame: str | bytes) -> None:
        if (b"comm_msg" if isinstance(frame, bytes) else "comm_msg") in frame[:2000]:  # type: ignore[operator]
            self.messages += 1
            self.bytes += len(frame)


def measure(page: Page, wire: Wire, idle: float) -> dict[str, float]:
    """Frames shown a second, and what each costs; `idle` is the share of a core that the world takes unseen."""
    messages, size = wire.messages, wire.bytes
    began, clock = value(page, "(cpu(), time.monotonic())")
    shown = page.evaluate("seconds => meter.watch(seconds)", SECONDS)
    ended, later = value(page, "(cpu(), time.monotonic())")
    share = (ended - began) / (later - clock)
    sent = (wire.messages - messages) / (later - clock)
    return {
        "frames shown a second": shown,
        "frames sent a second": sent,
        "kernel CPU a frame, ms": (share - idle) / sent * 1000,
        "kB a frame": (wire.bytes - size) / (wire.messages - messages) / 1000,
        "kernel, with the world, % of a core": share * 100,
    }


def idle_share(page: Page) -> float:
    """The share of a core that the kernel takes while the world goes on and nobody looks."""
    began, clock = value(page, "(cpu(), time.monotonic())")
    page.wait_for_timeout(SECONDS * 1000)
    ended, later = value(page, "(cpu(), time.monotonic())")
    return (ended - began) / (later - clock)


def click_times(page: Page, click: Any) -> dict[str, float]:
    """Milliseconds from a click until Python hears of it, and until the turtle is seen to move; medians."""
    heard, moved = [], []
    for number in range(CLICKS):
        known = value(page, "len(called)")
        click(number)
        page.wait_for_function("meter.moved !== null")
        clicked, seen = page.evaluate("[meter.clicked, meter.moved]")
        heard.append(value(page, f"called[{known}]") - clicked)
        moved.append(seen)
        while value(page, "desk.goals[-1].waits"):
            page.wait_for_timeout(50)
        page.wait_for_timeout(
            300 + 37 * number % 100
        )  # it stands still by now, and clicks come at any phase of its timers
    return {
        "click to Python, ms": statistics.median(heard),
        "click to visible motion, ms": statistics.median(moved),
    }


def click_on_map(page: Page) -> Any:
    """A function that sends the turtle a little to and fro."""
    box = page.locator(".tl-map").bounding_box()
    assert box is not None
    scale = (box["width"] - 36) / 11.088889

    def click(number: int) -> None:
        x, y = ((6.2, 3.0), (5.4, 3.0))[number % 2]
        page.mouse.click(box["x"] + 26 + x * scale, box["y"] + 10 + (11.088889 - y) * scale)

    return click


def run_cell(page: Page, number: int) -> None:
    page.evaluate(f"() => {{ window.jupyterapp.shell.currentWidget.content.activeCellIndex = {number} }}")
    execute(page, "notebook:run-cell")


def live_lab(page: Page, wire: Wire, idle: float) -> dict[str, float]:
    """The dashboard."""
    run_cell(page, 1)
    page.locator(".tl-map").scroll_into_view_if_needed()
    page.wait_for_function("meter.frames > 60")
    figures = measure(page, wire, idle)
    python(page, "stop_wandering()")
    page.wait_for_function("!document.querySelector('.tl-goal-on-its-way')")
    page.wait_for_timeout(2000)
    figures |= click_times(page, click_on_map(page))
    execute(page, "notebook:clear-all-cell-outputs")
    while value(page, "len(lesson.dashboard()._views)"):
        page.wait_for_timeout(50)
    return figures


def picture(page: Page, wire: Wire, idle: float) -> dict[str, float]:
    """matplotlib, its artists reused, to PNG in widgets.Image; a Button sends the goals."""
    python(page, "wandering = loop.create_task(wander())")
    run_cell(page, 2)
    page.locator("img.widget-image").scroll_into_view_if_needed()
    begun = page.evaluate("meter.frames")
    page.wait_for_function("begun => meter.frames > begun + 30", arg=begun)
    figures = measure(page, wire, idle)
    python(page, "stop_wandering()")
    page.wait_for_timeout(2000)

    def click(number: int) -> None:
        python(page, "forget()")
        page.wait_for_function("meter.pose === ''")
        page.locator(".widget-button").click()

    return figures | click_times(page, click)


AIMS = {
    "frames shown a second": "30",
    "kernel CPU a frame, ms": "< 1.5",
    "kB a frame": "< 3",
    "kernel, with the world, % of a core": "< 33",
    "click to Python, ms": "< 10",
    "click to visible motion, ms": "< 100",
}


def main() -> None:
    with tempfile.TemporaryDirectory() as folder, jupyterlab(Path(folder)) as lab, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=find_chromium(), args=FLAGS)
        page = browser.new_page(viewport={"width": 1600, "height": 1000})
        page.set_default_timeout(60_000)
        page.add_init_script(METER)
        wire = Wire(page)
        write_notebook(lab, "bench.ipynb", [SYSTEM, DASHBOARD, PICTURE])
        open_notebook(page, lab, "bench.ipynb")
        run_cell(page, 0)
        idle = idle_share(page)
        ours = live_lab(page, wire, idle)
        theirs = picture(page, wire, idle)
        browser.close()
    print(f"{'the world alone, % of a core':38}{100 * idle:10.1f}")
    print(f"{'':38}{'live lab':>10}{'PNG':>10}{'aim':>10}")
    for name, figure in ours.items():
        print(f"{name:38}{figure:10.1f}{theirs[name]:10.1f}{AIMS.get(name, ''):>10}")


if __name__ == "__main__":
    main()
