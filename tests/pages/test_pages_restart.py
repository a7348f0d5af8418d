"""A page whose kernel was restarted: the set-up cell and then any section, on the files that earlier sections left."""

from __future__ import annotations

import pytest
from answers.client import PageServer
from answers.restart import sections
from test_pages import PAGES

LESSONS = [page.stem for page in PAGES if page.stem[0].isdigit()]


@pytest.mark.parametrize("page", LESSONS)
def test_each_section_runs_after_a_restart(page_server: PageServer, page: str) -> None:
    set_up, _ = sections(page)[0][1][0]
    assert set_up.startswith("%load_ext turtle_lesson"), "a page begins with its set-up cell"
    assert len(set_up.splitlines()) <= 3
    running = page_server.page(page, restart=True)
    found = running.reply()
    running.close()
    assert not found, found
