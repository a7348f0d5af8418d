"""The first page as a newcomer meets it: open it in JupyterLab, clear its outputs, run all, and look."""

from __future__ import annotations

import json
from typing import Any

from playwright.sync_api import Page

NOTEBOOK = "notebooks/00_welcome.ipynb"
NOTEBOOK_WIDGET = "window.jupyterapp.shell.currentWidget"


def open_page(page: Page, lab: str) -> None:
    """Open the notebook alone, and wait until its kernel is there."""
    page.goto(f"{lab}/doc/tree/{NOTEBOOK}?reset")
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function(f"{NOTEBOOK_WIDGET}?.sessionContext?.session?.kernel")


def code_cells(page: Page) -> list[dict[str, Any]]:
    """The code cells as the page's model has them now."""
    return page.evaluate(
        f"""() => Array.from({NOTEBOOK_WIDGET}.content.model.cells)
            .filter(cell => cell.type === 'code').map(cell => cell.toJSON())"""
    )


def run_all(page: Page) -> None:
    """Clear all outputs, run all cells, and wait for the last one."""
    page.evaluate("() => window.jupyterapp.commands.execute('notebook:clear-all-cell-outputs')")
    assert not any(cell["outputs"] for cell in code_cells(page))
    page.evaluate("() => window.jupyterapp.commands.execute('notebook:run-all-cells')")


def test_the_page_runs_in_jupyterlab(page: Page, lab: str) -> None:
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    open_page(page, lab)
    run_all(page)

    cells = code_cells(page)
    assert all(cell["execution_count"] for cell in cells)
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert not [output for output in outputs if output["output_type"] == "error"], json.dumps(outputs)[:3000]
    assert not [output for output in outputs if output.get("name") == "stderr"]
    assert sum("image/png" in output.get("data", {}) for output in outputs) >= 6
    assert problems == []


def test_every_picture_speaks_and_is_sharp(page: Page, lab: str) -> None:
    open_page(page, lab)
    for output in (output for cell in code_cells(page) for output in cell["outputs"]):
        if "image/png" in output.get("data", {}):
            # JupyterLab 4.6 does not hand this on to the img element; nbconvert's pages do
            spoken = output["metadata"]["image/png"]["alt"]
            assert spoken == "".join(output["data"]["text/plain"]) or spoken.startswith("Path of turtle1 from ")
    picture = page.locator(".jp-RenderedImage img").first
    picture.scroll_into_view_if_needed()
    shown = picture.bounding_box()
    assert shown is not None and 300 < shown["width"] < 700
    assert picture.evaluate("image => image.naturalWidth") >= 2 * shown["width"] - 2


def test_the_graph_is_drawn_as_a_diagram(page: Page, lab: str) -> None:
    open_page(page, lab)
    page.locator(".jp-CodeCell", has_text="lesson.plot_graph()").first.scroll_into_view_if_needed()
    diagram = page.locator("img[alt^='The ROS graph has'], .jp-RenderedMermaid img").first
    diagram.wait_for(state="visible")
    box = diagram.bounding_box()
    assert box is not None
    assert box["width"] > 300
    assert box["height"] > 150
