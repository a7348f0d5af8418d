"""The process that runs pages (`__main__.py`), as tests see it."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

TESTS = Path(__file__).resolve().parents[1]


class PageServer:
    """One process that has imported the lesson, and a fork of it for each page."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self._address = str(Path(self._folder.name, "socket"))
        environ = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])}
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(self._address)
            listener.listen()
            number = listener.fileno()
            self._process = subprocess.Popen(
                [sys.executable, "-m", "answers", str(number)], pass_fds=[number], env=environ, cwd=TESTS
            )

    def page(self, name: str, **options: bool) -> RunningPage:
        """A page in a fresh folder."""
        return RunningPage(self._address, {"page": name, **options})

    def results(self, cells: Sequence[tuple[str, bool]], folder: Path) -> list[str]:
        """Run cells in a folder, each with whether an error is wanted: the texts of their results."""
        running = RunningPage(self._address, {"cells": cells, "folder": str(folder)})
        found = running.reply()
        running.close()
        assert "broken" not in found, found["broken"]
        said: list[str] = found["said"]
        return said

    def close(self) -> None:
        """End it; pages that still run end with their connections."""
        self._process.terminate()
        self._process.wait()
        self._folder.cleanup()


class RunningPage:
    """A page in a process of its own."""

    def __init__(self, address: str, wanted: dict[str, Any]) -> None:
        with socket.socket(socket.AF_UNIX) as connection:
            connection.connect(address)
            self._stream = connection.makefile("rw", encoding="utf-8")
        self._send(wanted)

    def _send(self, request: dict[str, Any]) -> None:
        self._stream.write(json.dumps(request) + "\n")
        self._stream.flush()

    def ask(self, request: dict[str, Any]) -> dict[str, Any]:
        """The reply to a request."""
        self._send(request)
        return self.reply()

    def reply(self) -> dict[str, Any]:
        """The next reply; where the page's process has ended, that, as "broken"."""
        line = self._stream.readline()
        found: dict[str, Any] = json.loads(line) if line else {"broken": "the process that runs the page has ended"}
        return found

    def close(self) -> None:
        """End it."""
        self._stream.close()
