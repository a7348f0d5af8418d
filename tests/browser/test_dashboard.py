"""The dashboard in JupyterLab: the page with nothing but it, and its log."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from jupyter_pages import Lab, execute, notebook_in
from playwright.sync_api import Page, expect

NOTEBOOK = "notebooks/lab.ipynb"


@pytest.fixture(scope="module")
def opened(desktop: Page, lab: Lab) -> Iterator[Page]:
    """A window with the page, which shows its picture until it is run."""
    with notebook_in(desktop, lab, NOTEBOOK, [], width=1600) as page:
        expect(page.locator(".jp-OutputArea img").first).to_be_visible()
        assert page.locator(".tl-dashboard").count() == 0
        yield page


@pytest.fixture(scope="module")
def window(opened: Page) -> Page:
    """A window in which the page was run: five seconds of robot time, and then it stands still."""
    execute(opened, "notebook:run-all-cells")
    opened.wait_for_selector(".tl-dashboard")
    return opened


def test_everything_is_there_and_as_expected(window: Page) -> None:
    headings = window.locator(".tl-dashboard h3:visible")
    expect(headings).to_have_text(["Map", "Goals", "Status", "Log", "Scan", "Topics", "Nodes and services"])
    expect(window.locator(".tl-light-present")).to_have_count(5)
    expect(window.locator(".tl-state", has_text="as expected")).to_have_count(3)
    expect(window.locator(".tl-scan-nearest")).to_have_text(re.compile(r"Nearest: \d+\.\d\d m, "))


def test_status_and_log_run_when_time_does(window: Page) -> None:
    battery = window.locator(".tl-strip-value").last
    before = battery.inner_text()
    window.get_by_role("button", name="Play").click()
    expect(battery).not_to_have_text(before)
    expect(window.locator(".tl-log-line").first).to_contain_text("Starting turtlesim")
    window.get_by_role("button", name="Pause").click()


def test_a_reader_who_scrolls_up_is_left_alone(window: Page) -> None:
    log, newest = window.locator(".tl-log"), window.get_by_role("button", name="Newest")
    log.evaluate("list => { list.style.flex = 'none'; list.style.height = '60px' }")
    log.evaluate("list => { list.scrollTop = 0 }")
    expect(newest).to_be_visible()
    window.get_by_role("button", name="Send", exact=True).click()  # which makes a new line
    expect(window.locator(".tl-log-line").last).to_contain_text("Goal")
    assert log.evaluate("list => list.scrollTop") == 0
    newest.click()
    expect(newest).to_be_hidden()
    assert log.evaluate("list => list.scrollHeight - list.scrollTop - list.clientHeight") < 8


def test_it_fits_into_a_small_window(window: Page) -> None:
    for width in (800, 1600):
        window.set_viewport_size({"width": width, "height": 1000})
        spill = "root => root.scrollWidth - root.clientWidth"
        assert window.locator(".tl-root").evaluate(spill) <= 0
        for card in window.locator(".tl-card:visible").all():
            assert card.evaluate(spill) <= 1
