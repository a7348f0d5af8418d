"""JupyterLab for a learner's folder, on this machine only."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from ..files import OPENED
from .pages import PageError

JUPYTER = Path(__file__).resolve().parent / "jupyter"
"""Holds the kernel that says which cell to run after a restart, and settings: no news, and no look for updates."""

FIRST = "00_welcome.ipynb"


def serve(folder: Path, port: int | None, browser: bool, more: Sequence[str]) -> int:
    """Run JupyterLab on the first page of a folder until it is stopped; where the system can, in place of this process.

    Args:
        folder: all that it shows.
        port: None takes 8888, or the next one that is free.
        browser: whether to open one.
        more: further options of JupyterLab's.
    """
    words = [sys.executable, "-P", "-m", "jupyterlab", "--Application.log_level=ERROR", *more]
    words.append(f"--LabApp.default_url=/lab/tree/{FIRST}")
    words += [f"--ServerApp.root_dir={folder.resolve()}", "--ServerApp.ip=127.0.0.1"]
    if port is not None:
        _check_free(port)
        words += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0"]
    if not browser:
        words.append("--no-browser")
    environment = dict(os.environ) | {OPENED: str(folder.resolve())}
    for name in ("JUPYTER_PATH", "JUPYTER_CONFIG_PATH"):
        environment[name] = os.pathsep.join([str(JUPYTER), *filter(None, [os.environ.get(name)])])
    sys.stdout.flush()
    if os.name == "posix":
        os.execve(sys.executable, words, environment)
    return subprocess.call(words, env=environment)


def _check_free(port: int) -> None:
    with socket.socket() as probe:
        if os.name == "posix":  # as Jupyter's own: a port that was used a moment ago is free
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except (OSError, OverflowError) as error:
            reason = (getattr(error, "strerror", None) or str(error)).lower().rstrip(".")
            raise PageError(f"port {port} cannot be used: {reason}. Without --port, a free one is found.") from None
