"""Places other than JupyterLab: programs that run a notebook without a reader, and what Colab asks of a widget.

`turtle_lesson/lab/README.md` has the table of all places.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import nbformat
import pytest

from turtle_lesson import start

CELLS = {
    "seconds = 1.0": ["parameters"],
    "%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)\nlesson.run(seconds)": [],
    "ros2 node list": [],
    "1 / 0": ["raises-exception"],
    "lesson.dashboard()": [],
    'lesson.predict("far", question="How far does it drive?", choices=["nowhere", "1 m"])': [],
    "lesson.plot_path()": [],
}
RUNNERS = {
    "papermill": ["-m", "papermill", "page.ipynb", "run.ipynb", "--no-progress-bar", "-p", "seconds", "2.5"],
    "jupyter execute": ["-c", "from nbclient.cli import main; main()", "page.ipynb", "--output", "run.ipynb"],
    "nbconvert": ["-m", "nbconvert", "--to", "notebook", "--execute", "page.ipynb", "--output", "run.ipynb"],
}
"""What Python is given; `jupyter execute` is nbclient's program."""


@pytest.mark.parametrize("runner", RUNNERS)
def test_a_page_runs_without_a_reader(runner: str, tmp_path: Path) -> None:
    cells = [nbformat.v4.new_code_cell(source, metadata={"tags": tags}) for source, tags in CELLS.items()]
    page = nbformat.v4.new_notebook(cells=cells)
    page.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    nbformat.write(page, tmp_path / "page.ipynb")
    command = [sys.executable, *RUNNERS[runner]]
    done = subprocess.run(command, cwd=tmp_path, env=alone(tmp_path), capture_output=True, text=True, timeout=400)
    # papermill goes on after an error that a cell's tags expect, but reports it at the end.
    assert done.returncode == (runner == "papermill"), done.stderr

    run = nbformat.read(tmp_path / "run.ipynb", as_version=4)
    seconds = 2.5 if runner == "papermill" else 1.0
    outputs = [cell.outputs for cell in run.cells if cell.cell_type == "code"]
    nodes, error, dashboard, question, path = outputs[-5:]
    assert "".join(each.text for each in nodes) == "/turtlesim\n"
    assert error[0].ename == "ZeroDivisionError"
    assert dashboard[0].data["text/plain"].startswith(f"Dashboard at {seconds + 0.1:.2f} s of robot time")
    assert "image/png" in dashboard[0].data, "a reader without a kernel sees a picture"
    assert "no guess yet" in question[0].data["text/plain"]
    assert path[0].data["text/plain"].startswith(f"Path of turtle1 from 0.02 s to {seconds + 0.09:.2f} s of robot time")
    assert {"application/vnd.jupyter.widget-state+json"} <= set(run.metadata.widgets)


def alone(folder: Path) -> dict[str, str]:
    """The environment of a Jupyter with nobody's settings."""
    places = dict.fromkeys(("HOME", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "IPYTHONDIR"), str(folder))
    root = str(Path(__file__).resolve().parents[2])
    return {**os.environ, **places, "PYTHONPATH": os.pathsep.join(filter(None, [root, os.environ.get("PYTHONPATH")]))}


def test_colab_is_told_where_its_manager_of_widgets_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """As anywidget does it: through a module that only Colab has, and the metadata of what is shown."""
    asked: list[str] = []
    output: Any = ModuleType("google.colab.output")
    output.enable_custom_widget_manager = lambda: asked.append("manager")
    output._widgets = SimpleNamespace(_installed_url="https://colab.example/manager.js")
    monkeypatch.setitem(sys.modules, "google.colab.output", output)
    data, metadata = start(seed=0).dashboard()._repr_mimebundle_()
    assert asked == ["manager"]
    (kind,) = [each for each in data if "widget-view" in each]
    assert metadata[kind] == {"colab": {"custom_widget_manager": {"url": "https://colab.example/manager.js"}}}
    assert data["text/plain"].startswith("Dashboard at 0.00 s")
