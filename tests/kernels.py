"""What the tests that run cells in a real kernel share."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from jupyter_client.blocking.client import BlockingKernelClient
from jupyter_client.manager import KernelManager, start_new_kernel
from jupyter_core.utils import ensure_event_loop


def end(manager: KernelManager, client: BlockingKernelClient) -> None:
    """End a kernel, and close the event loop that jupyter_client leaves open."""
    client.stop_channels()
    manager.shutdown_kernel(now=True)
    ensure_event_loop().close()


ROOT = Path(__file__).resolve().parents[1]
Ask = Callable[..., tuple[str, str]]


@contextmanager
def running(folder: Path, set_up: Sequence[str], error: Callable[[dict[str, Any]], str]) -> Iterator[Ask]:
    """A kernel in a folder, where these cells have been run.

    It gives `ask(cell, stop_after=None)`, which runs a cell, presses the stop button after some seconds if told so, and
    returns what the cell printed and what `error` makes of the messages' contents.
    """
    manager, client = start_new_kernel(cwd=str(folder), kernel_name="python3")

    def ask(cell: str, stop_after: float | None = None) -> tuple[str, str]:
        said: dict[str, str] = {"out": "", "error": ""}

        def hear(message: dict[str, Any]) -> None:
            content = message["content"]
            said["out"] += content.get("text", "")
            said["error"] += error(content)

        timer = threading.Timer(stop_after or 0.0, os.kill, [manager.provisioner.pid, signal.SIGINT])
        if stop_after is not None:
            timer.start()
        client.execute_interactive(cell, output_hook=hear, timeout=540, allow_stdin=False)
        timer.cancel()
        return said["out"], said["error"]

    for cell in (f"import sys; sys.path.insert(0, {str(ROOT)!r})", *set_up):
        ask(cell)
    yield ask
    end(manager, client)
