"""The first page as a newcomer meets it: open it in JupyterLab, look, clear its outputs, and run all."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from jupyter_pages import NOTEBOOK, Lab, execute, notebook_in
from playwright.sync_api import Page

PAGE = "notebooks/00_welcome.ipynb"


@pytest.fixture(scope="module")
def window(desktop: Page, lab: Lab) -> Iterator[Page]:
    """A window with the page as it is stored."""
    problems: list[str] = []
    with notebook_in(desktop, lab, PAGE, problems) as page:
        yield page
    assert problems == []


def code_cells(page: Page) -> list[dict[str, Any]]:
    """The code cells as the page's model has them now."""
    return page.evaluate(
        f"""() => Array.from({NOTEBOOK}.content.model.cells)
            .filter(cell => cell.type === 'code').map(cell => cell.toJSON())"""
    )


def test_every_picture_speaks_and_is_sharp(window: Page) -> None:
    for output in (output for cell in code_cells(window) for output in cell["outputs"]):
        if "image/png" in output.get("data", {}):
            # JupyterLab 4.6 does not hand this on to the img element; nbconvert's pages do
            spoken = output["metadata"]["image/png"]["alt"]
            assert spoken == "".join(output["data"]["text/plain"]) or spoken.startswith("Path of turtle1 from ")
    picture = window.locator(".jp-RenderedImage img").first
    picture.scroll_into_view_if_needed()
    shown = picture.bounding_box()
    assert shown is not None and 300 < shown["width"] < 700
    assert picture.evaluate("image => image.naturalWidth") >= 2 * shown["width"] - 2


def test_the_graph_is_drawn_as_a_diagram(window: Page) -> None:
    window.locator(".jp-CodeCell", has_text="lesson.plot_graph()").first.scroll_into_view_if_needed()
    diagram = window.locator("img[alt^='The ROS graph has'], .jp-RenderedMermaid img").first
    diagram.wait_for(state="visible")
    box = diagram.bounding_box()
    assert box is not None
    assert box["width"] > 300
    assert box["height"] > 150


def test_the_page_runs_in_jupyterlab(window: Page) -> None:
    execute(window, "notebook:clear-all-cell-outputs")
    assert not any(cell["outputs"] for cell in code_cells(window))
    execute(window, "notebook:run-all-cells")

    cells = code_cells(window)
    assert all(cell["execution_count"] for cell in cells)
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert not [output for output in outputs if output["output_type"] == "error"], json.dumps(outputs)[:3000]
    assert not [output for output in outputs if output.get("name") == "stderr"]
    assert sum("image/png" in output.get("data", {}) for output in outputs) >= 6
