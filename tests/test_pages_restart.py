"""A page whose kernel was restarted: the set-up cell and then any section, on the files that earlier sections left."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from answers.restart import sections
from test_pages import PAGES

TESTS = Path(__file__).resolve().parent
LESSONS = [page.stem for page in PAGES if page.stem[0].isdigit()]


@pytest.mark.parametrize("page", LESSONS)
def test_each_section_runs_after_a_restart(page: str) -> None:
    set_up, _ = sections(page)[0][1][0]
    assert set_up.startswith("%load_ext turtle_lesson"), "a page begins with its set-up cell"
    assert len(set_up.splitlines()) <= 3
    environ = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])}
    command = [sys.executable, "-m", "answers.restart", page]
    done = subprocess.run(command, env=environ, cwd=TESTS, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout.splitlines()[-1]) == {}, done.stderr[-3000:]
