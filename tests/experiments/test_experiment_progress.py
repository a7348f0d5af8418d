"""The bar of an experiment: only where somebody watches, and nothing is left of it."""

from __future__ import annotations

import io
import os
import sys
import threading
from typing import Any

import pytest
from jupyter_client.manager import start_new_kernel
from kernels import ROOT, end

from turtle_lesson.experiments.experiment import bar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def use() -> None:
    with bar(3) as shown:
        for _ in range(3):
            shown.update()


@pytest.mark.parametrize(
    ("stream", "ci", "shown"),
    [(Terminal(), False, True), (Terminal(), True, False), (io.StringIO(), False, False)],
)
def test_a_terminal_gets_a_line_that_goes_away(
    stream: io.StringIO, ci: bool, shown: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.delenv("CI", raising=False)
    if ci:
        monkeypatch.setenv("CI", "true")
    before = threading.active_count()
    use()
    said = stream.getvalue()
    assert ("0/3" in said) == shown
    assert not said.split("\r")[-1].strip(), "the line is empty in the end"
    assert threading.active_count() == before


def test_a_live_notebook_gets_a_bar_of_which_nothing_is_left_and_a_page_that_is_run_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("CI", raising=False)
    manager, client = start_new_kernel(kernel_name="python3", env=dict(os.environ))
    outputs: list[tuple[str, Any]] = []

    def hear(message: dict[str, Any]) -> None:
        if message["msg_type"] in {"stream", "display_data", "update_display_data", "error"}:
            outputs.append((message["msg_type"], message["content"].get("data", message["content"])))

    cell = (
        f"import sys; sys.path.insert(0, {str(ROOT)!r})\nfrom turtle_lesson.experiments.experiment import bar\n"
        "with bar(3) as shown:\n    shown.update()\n    shown.set_postfix_str('1 failed', refresh=False)\n    shown.update()"
    )
    try:
        client.execute_interactive(cell, output_hook=hear, allow_stdin=False, timeout=300)
        assert outputs == []
        client.execute_interactive(cell, output_hook=hear, allow_stdin=True, timeout=300)
    finally:
        end(manager, client)
    assert [kind for kind, _ in outputs] == ["display_data", "update_display_data"]
    assert "application/vnd.jupyter.widget-view+json" in outputs[0][1]
    assert outputs[1][1] == {"text/plain": ""}
