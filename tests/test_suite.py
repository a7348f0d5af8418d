"""The suite itself: every test ends, where Ctrl-C is ignored too, and what failed is listed after Ctrl-C."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")


def run_pytest(folder: Path, text: str, *, patience: float = 300, ignored: bool = False) -> tuple[int, str]:
    """Run one file of tests under the suite's conftest.py; its exit code and what it printed."""
    shutil.copy(ROOT / "conftest.py", folder)
    (folder / "test_it.py").write_text(text)
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "no:cacheprovider",
        "-c",
        "/dev/null",
        "--rootdir",
        str(folder),
        "-q",
    ]
    if ignored:  # as in a background job
        command = ["sh", "-c", "trap '' INT; exec \"$@\"", "sh", *command]
    done = subprocess.run(
        [*command, str(folder)],
        env={
            "PATH": "/usr/bin:/bin",
            "TURTLE_LESSON_PATIENCE": str(patience),
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",  # they take longer to import than the tests to run
        },
        capture_output=True,
        text=True,
        check=False,
        start_new_session=True,
    )
    return done.returncode, done.stdout + done.stderr


def test_a_test_that_hangs_is_ended_with_its_stack_and_the_next_one_runs(tmp_path: Path) -> None:
    text = "import threading\ndef test_hangs():\n    threading.Event().wait()\ndef test_next():\n    pass\n"
    code, said = run_pytest(tmp_path, text, patience=1)
    assert code == pytest.ExitCode.TESTS_FAILED
    assert "this did not end in 1 seconds" in said
    assert 'test_it.py", line 3 in test_hangs' in said
    assert "1 failed, 1 passed" in said


def test_where_ctrl_c_is_ignored_it_is_not_for_tests(tmp_path: Path) -> None:
    """Also what they start can be interrupted."""
    child = "import signal; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    said_of_child = f"subprocess.check_output([sys.executable, '-c', {child!r}])"
    text = f"import subprocess, sys\ndef test_it():\n    assert {said_of_child} == b'True\\n'\n"
    code, said = run_pytest(tmp_path, text, ignored=True)
    assert code == pytest.ExitCode.OK, said


def test_after_ctrl_c_what_failed_is_listed_although_something_cannot_be_closed(tmp_path: Path) -> None:
    text = """
import os, signal, pytest

@pytest.fixture(scope="session")
def browser():
    yield
    raise RuntimeError("its driver is gone")

def test_fails(browser):
    assert 1 == 2

def test_is_interrupted(browser):
    os.kill(os.getpid(), signal.SIGINT)
    while True:
        pass
"""
    code, said = run_pytest(tmp_path, text)
    assert code == pytest.ExitCode.INTERRUPTED
    assert re.search("(?m)^FAILED .*test_it.py::test_fails", said), said
    assert "not closed in order: RuntimeError: its driver is gone" in said
    assert "INTERNALERROR" not in said and signal.Signals.SIGINT.name not in said
