"""A real JupyterLab and a real Chromium, for tests that look at pages as a reader does."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from jupyter_pages import FLAGS, PATIENCE, Lab, find_chromium, jupyterlab
from playwright.sync_api import Browser, Page, expect, sync_playwright

expect.set_options(timeout=PATIENCE)
HERE = Path(__file__).resolve().parent
NOTEBOOKS = HERE.parents[1] / "notebooks"


@pytest.fixture(scope="session")
def chromium() -> str:
    """The browser's path. Without one these tests are skipped, but not in CI."""
    found = find_chromium()
    if found is None:
        reason = "no Chromium on this machine; Debian's is installed by: apt-get install -y chromium"
        if os.environ.get("CI"):
            pytest.fail(reason)
        pytest.skip(reason)
    return found


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """A JupyterLab with a learner's folder, and in that a copy of the notebooks with their outputs."""
    with jupyterlab(tmp_path_factory.mktemp("lab")) as lab:
        shutil.copytree(NOTEBOOKS, lab.folder / "notebooks", ignore=shutil.ignore_patterns(".ipynb_checkpoints"))
        yield lab


class Chromium:
    """A headless browser with a window: opened by the first test that wants it, and closed after the last one.

    While Playwright runs, so does an event loop of its own, so it is not kept for tests of other folders.
    """

    def __init__(self) -> None:
        self._open = ExitStack()
        self._browser: Browser | None = None
        self._window: Page | None = None

    def browser(self, path: str) -> Browser:
        """The browser."""
        if self._browser is None:
            playwright = self._open.enter_context(sync_playwright())
            self._browser = playwright.chromium.launch(executable_path=path, args=FLAGS, timeout=PATIENCE)
            self._open.callback(self._browser.close)
        return self._browser

    def window(self, path: str) -> Page:
        """Its window, which the tests of one file after the other use."""
        if self._window is None:
            self._window = self.browser(path).new_page()
            self._window.set_default_timeout(PATIENCE)
        return self._window

    def close(self) -> None:
        """Close it; who asks for it again gets a new one."""
        self._browser = self._window = None
        self._open.close()


_chromium = Chromium()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> Iterator[None]:
    """Close the browser after the last test of this folder, also if that ends with an error."""
    try:
        yield
    finally:
        if nextitem is None or HERE not in nextitem.path.parents:
            _chromium.close()


@pytest.fixture(scope="module")
def browser(chromium: str) -> Browser:
    """A headless browser."""
    return _chromium.browser(chromium)


@pytest.fixture(scope="module")
def desktop(chromium: str) -> Page:
    """The window that all files share; `notebook_in` opens a notebook there."""
    return _chromium.window(chromium)


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A fresh window of the width of a small laptop."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(PATIENCE)
    yield page
    page.close()
