"""A progress bar while an experiment runs, in a live notebook or a terminal; nothing of it is left afterwards."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol


class Told(Protocol):
    """What is told of each run that is over."""

    def __call__(self, failed: bool) -> None:
        """One more run is over."""


@contextmanager
def bar(total: int, wanted: bool | None) -> Iterator[Told]:
    """Show how many of so many runs are over; `wanted` None: if somebody watches."""
    kernel = _kernel()
    watched = _is_live(kernel) if kernel is not None else sys.stderr.isatty()
    if wanted is False or (wanted is None and (not watched or "CI" in os.environ)):
        yield lambda failed: None
        return
    shown, close = _in_a_notebook(total) if kernel is not None else _in_a_terminal(total)
    failures = 0

    def told(failed: bool) -> None:
        nonlocal failures
        failures += failed
        if failures:
            shown.set_postfix_str(f"{failures} failed", refresh=False)
        shown.update()

    try:
        yield told
    finally:
        close()


def _in_a_terminal(total: int) -> tuple[Any, Any]:
    from tqdm.std import tqdm

    class Bar(tqdm):
        monitor_interval = 0  # no thread stays behind

    shown = Bar(total=total, unit="run", leave=False, dynamic_ncols=True)
    return shown, shown.close


def _in_a_notebook(total: int) -> tuple[Any, Any]:
    """The bar is an output that can be replaced: what is left of it is an empty text."""
    from IPython.display import display
    from tqdm.notebook import tqdm

    class Bar(tqdm):
        monitor_interval = 0

    shown = Bar(total=total, unit="run", leave=False, display=False)
    output = display(shown.container, display_id=True)

    def close() -> None:
        shown.n = shown.total  # or a bar that is stopped would stay, in red
        shown.close()
        output.update({"text/plain": ""}, raw=True)

    return shown, close


def _kernel() -> Any:
    """Jupyter's kernel, if this is one."""
    ipython: Any = sys.modules.get("IPython")
    return getattr(ipython and ipython.get_ipython(), "kernel", None)


def _is_live(kernel: Any) -> bool:
    """Whether the cell that runs could ask for input: those that nbval, nbconvert or a grader runs could not."""
    try:
        return bool(kernel.get_parent("shell")["content"]["allow_stdin"])
    except (AttributeError, KeyError, TypeError):
        return False
