"""The lesson on a real JupyterHub, as deploy/jupyterhub configures it: two people log in, and each has pages of their own."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest
from jupyter_hub import PROXY, Channels, Hub, Person, find_proxy, jupyterhub, python_for_everyone
from jupyter_pages import KERNEL, NOTEBOOK, execute, listeners, python
from playwright.sync_api import Browser, Page, expect

from turtle_lesson.teaching.pages import NAMES


@pytest.fixture(scope="module")
def hub() -> Iterator[Hub]:
    """A hub that ann and ben may use, each as a system user of their own where root runs the tests."""
    pytest.importorskip("jupyterhub", reason="JupyterHub does not run on this system")
    proxy = find_proxy()
    if proxy is None:
        reason = f"no {PROXY} on this machine; it is installed by: npm install --prefix tests/browser"
        if os.environ.get("CI"):
            pytest.fail(reason)
        pytest.skip(reason)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        folder.chmod(0o711)  # people come into their homes
        python = python_for_everyone(folder) if hasattr(os, "geteuid") and os.geteuid() == 0 else None
        with jupyterhub(folder, ["ann", "ben"], proxy, python) as running:
            yield running


@pytest.fixture(scope="module")
def ann(hub: Hub, browser: Browser) -> Iterator[Page]:
    """A window in which ann has logged in."""
    page = browser.new_page(viewport={"width": 1280, "height": 1000})
    page.set_default_timeout(180_000)
    page.goto(hub.address)
    page.get_by_label("Username").fill("ann")
    page.get_by_label("Password").fill("any")
    page.get_by_role("button", name="Sign in").click()
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    yield page
    page.close()


@pytest.fixture(scope="module")
def ben(hub: Hub) -> Person:
    """Somebody else, whose server runs, too."""
    person = Person(hub, "ben")
    person.start_server()
    return person


@pytest.fixture(scope="module")
def bens_page(ben: Person) -> Iterator[Channels]:
    """A kernel of ben's, and its channels."""
    with ben.connected(ben.kernel()) as channels:
        yield channels


def test_after_the_login_page_00_is_open_in_a_folder_with_all_pages(ann: Page, hub: Hub) -> None:
    assert ann.url == f"{hub.address}/user/ann/lab/tree/00_welcome.ipynb"
    ann.wait_for_function(f"{KERNEL}?.status === 'idle'")
    assert ann.evaluate(f"{NOTEBOOK}.context.path") == "00_welcome.ipynb"
    listed = "async () => (await window.jupyterapp.serviceManager.contents.get('')).content.map(each => each.name)"
    assert sorted(ann.evaluate(listed)) == sorted(NAMES)
    assert python(ann, "import os; print(os.getcwd())").strip() == str(hub.folder("ann"))


def test_the_kernel_says_what_to_run_first(ann: Page) -> None:
    """It is the lesson's own, as in a folder that `turtle-lesson open` opens."""
    assert "Run the set-up cell first" in python(ann, "ros2 topic list")


def test_the_dashboard_lives_behind_the_proxy(ann: Page) -> None:
    problems: list[str] = []
    for event, listener in listeners(problems).items():
        ann.on(event, listener)  # type: ignore[call-overload]
    execute(ann, "docmanager:open", {"path": "lab.ipynb", "factory": "Notebook"})
    ann.wait_for_function(f"{NOTEBOOK}?.context?.path === 'lab.ipynb' && {KERNEL}?.status === 'idle'")
    execute(ann, "notebook:run-all-cells")
    dashboard = ann.locator(".tl-dashboard")
    dashboard.wait_for()
    battery = dashboard.locator(".tl-strip-value").last
    before = battery.inner_text()
    ann.get_by_role("button", name="Play").click()
    expect(battery).not_to_have_text(before)
    ann.get_by_role("button", name="Pause").click()
    assert problems == []


def test_a_second_learner_has_pages_and_a_kernel_too(ann: Page, ben: Person, bens_page: Channels) -> None:
    listed = ben.get(f"{ben.server}/api/contents").json()["content"]
    assert sorted(each["name"] for each in listed) == sorted(NAMES)
    bens_page.run("%load_ext turtle_lesson\nfrom turtle_lesson import start\nlesson = start(seed=0)")
    assert bens_page.run("ros2 node list").endswith("/turtlesim\n")


def test_the_hub_gives_nobody_the_files_of_another(ann: Page, ben: Person, hub: Hub) -> None:
    assert ben.get(f"{ben.server}/files/lab.ipynb").status_code == 200
    assert ben.get(f"{hub.address}/user/ann/files/lab.ipynb").status_code == 403
    assert ben.get(f"{hub.address}/user/ann/api/contents/lab.ipynb").status_code == 403
    assert ben.get(f"{hub.address}/user/ann/api/kernels").status_code == 403
    assert ben.get(f"{ben.server}/api/contents/%2e%2e/%2e%2e/ann/my-lesson/lab.ipynb").status_code == 404
    assert ann.request.get(f"{hub.address}/user/ben/files/lab.ipynb").status == 403


def test_no_cell_can_read_the_files_of_another(ann: Page, bens_page: Channels, hub: Hub) -> None:
    if not hub.separate:
        pytest.skip("only root can start servers as users of their own, with a Python that they may run")
    theirs = hub.folder("ann") / "lab.ipynb"
    assert theirs.is_file()
    assert bens_page.run("print(open('lab.ipynb').read(1))") == "{\n"
    assert "PermissionError" in bens_page.run(f"open({str(theirs)!r})")
    assert "PermissionError" in bens_page.run(f"import os; os.listdir({str(theirs.parent)!r})")


def test_nothing_listens_beyond_this_machine(ann: Page, ben: Person, hub: Hub) -> None:
    own = psutil.Process(hub.process.pid)
    sockets = [each for process in (own, *own.children(recursive=True)) for each in process.net_connections("inet")]
    listening = {each.laddr.ip for each in sockets if each.status == psutil.CONN_LISTEN}
    assert listening == {"127.0.0.1"}
