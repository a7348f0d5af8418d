"""What a notebook gets of a picture: PNG and text, always the same, in our style and nobody else's."""

import base64
import html
import struct
import subprocess
import sys

import nbformat
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.display import display
from IPython.utils.capture import capture_output
from lab_fakes import drive, recording, report, scan, see
from nbconvert import HTMLExporter
from traitlets.config import Config

from turtle_lesson.lab import drawing
from turtle_lesson.lab.drawing import Picture
from turtle_lesson.lab.path import plot_path
from turtle_lesson.lab.status_and_scan import plot_scan, plot_status

PLOTS = {
    "path": lambda: plot_path(drive(recording()), goal=(8, 8, 1)),
    "status": lambda: plot_status(report(recording())),
    "scan": lambda: plot_scan(see(recording(), scan([2.0] * 181))),
}


@pytest.fixture(params=PLOTS, name="make")
def _make(request):
    return PLOTS[request.param]


def test_the_bundle_has_png_and_text_and_the_size_to_show(make):
    picture = make()
    data, metadata = picture._repr_mimebundle_()
    assert sorted(data) == ["image/png", "text/plain"]
    assert data["text/plain"] == picture.text == repr(picture) == metadata["image/png"]["alt"]
    size = struct.unpack(">II", data["image/png"][16:24])
    assert size == (2 * metadata["image/png"]["width"], 2 * metadata["image/png"]["height"])
    assert metadata["image/png"]["width"] <= 640


@pytest.fixture
def shell():
    yield InteractiveShell.instance(config=Config(HistoryManager={"enabled": False}))
    InteractiveShell.clear_instance()


def test_a_notebook_shows_the_picture_and_below_it_the_text(make, shell):
    picture = make()
    with capture_output() as shown:
        display(picture)
    first, second = shown.outputs
    assert first.data["image/png"] and first.metadata["image/png"]["alt"] == picture.text
    assert html.unescape(second.data["text/html"]) == (
        f"<details><summary>In words</summary><p>{picture.text}</p></details>"
    )


def test_a_picture_without_a_figure_is_shown_as_its_text(shell):
    with capture_output() as shown:
        display(Picture("No path yet."))
    assert [each.data for each in shown.outputs] == [{"text/plain": "No path yet."}]


def test_a_static_page_has_the_alternative_text(make):
    picture = make()
    data, metadata = picture._repr_mimebundle_()
    data["image/png"] = base64.b64encode(data["image/png"]).decode()
    page = nbformat.v4.new_notebook()
    output = nbformat.v4.new_output("display_data", data, metadata=metadata)
    page.cells = [nbformat.v4.new_code_cell("picture", outputs=[output])]
    assert f'alt="{picture.text}"' in html.unescape(HTMLExporter(template_name="classic").from_notebook_node(page)[0])


def test_a_text_is_one_paragraph(make):
    assert "\n" not in make().text and "  " not in make().text


def test_the_ground_is_that_of_the_page_light_or_dark(make):
    pixels = make().pixels()
    assert (pixels[..., 3] < 128).mean() > 0.5, "most of it is transparent"


@pytest.mark.parametrize("page", ["#ffffff", "#111111"])
def test_text_can_be_read_on_a_light_and_a_dark_page(page):
    from matplotlib.colors import to_rgb

    def luminance(colour):
        parts = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in to_rgb(colour)]
        return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

    dark, light = sorted([luminance(drawing.INK), luminance(page)])
    assert (light + 0.05) / (dark + 0.05) > 4.2


def test_the_same_plot_twice_gives_the_same_bytes(make):
    assert make().text == make().text
    assert make().png() == make().png()


def test_the_learners_own_settings_change_nothing_and_are_kept(make):
    import matplotlib

    expected = make().png()
    with matplotlib.rc_context({"font.size": 30, "axes.facecolor": "red", "lines.linewidth": 9}):
        assert make().png() == expected
        assert matplotlib.rcParams["font.size"] == 30


def test_without_a_figure_there_is_only_text():
    picture = Picture("No path yet.")
    assert picture._repr_mimebundle_() == {"text/plain": "No path yet."}


def test_pictures_leave_pyplot_alone():
    code = (
        "import sys, lab_fakes; from turtle_lesson.lab.path import plot_path\n"
        "assert 'matplotlib' not in sys.modules, 'imported before the first picture'\n"
        "plot_path(lab_fakes.drive(lab_fakes.recording())).png()\n"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    path = [*sys.path, __file__.rsplit("test_", 1)[0]]
    run = [sys.executable, "-c", f"import sys; sys.path[:] = {path!r}\n{code}"]
    assert subprocess.run(run, capture_output=True, text=True, check=False).stderr == ""


LAUNCHED = "(package='finished'); lesson.launch('robot_controller', 'start_system.launch.py'); lesson.run(1)"


@pytest.mark.parametrize(
    ("begun", "needless"),
    [
        ("()", {"argparse", "launch", "matplotlib", "numpy", "statistics", "yaml"}),
        (LAUNCHED, {"IPython", "ipywidgets", "anywidget", "matplotlib", "meshcat", "nbformat"}),
    ],
    ids=["a start", "a start and a launch"],
)
def test_a_plain_script_imports_only_what_runs_then(begun: str, needless: set[str]) -> None:
    code = (
        f"import sys; from turtle_lesson import start\nlesson = start{begun}\n"
        f"needless = {needless!r} & set(sys.modules)\nassert not needless, needless"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False).stderr == ""
