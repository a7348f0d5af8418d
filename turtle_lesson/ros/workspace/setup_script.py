"""Reads a `setup.py` by running it in a process of its own (see `setup_runner`), as colcon does, and a `setup.cfg`."""

from __future__ import annotations

import configparser
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from ..core.tracebacks import shown_path

_RUNNER = Path(__file__).with_name("setup_runner.py")
LONGEST = 10.0
"""What a setup.py may take, in s of real time."""


class SetupError(Exception):
    """A setup.py that fails; the text is Python's, shortened to the file's own lines."""


def read_setup(folder: Path) -> dict[str, Any]:
    """What the package's `setup.py` gives to `setup(…)`.

    Raises:
        SetupError: it fails, does not end, or never calls `setup`.
    """
    with tempfile.TemporaryDirectory() as scratch:
        answer = Path(scratch) / "answer.json"
        command = [sys.executable, "-I", "-X", "utf8", str(_RUNNER), str(folder.resolve()), str(answer)]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST, check=False)
        except subprocess.TimeoutExpired:
            text = f"setup.py did not end within {LONGEST:g} s: is there a loop in it, or a wait?\n"
            raise SetupError(text) from None
        result = json.loads(answer.read_text(encoding="utf-8")) if answer.is_file() else {}
    if "error" in result:
        raise SetupError(result["error"])
    if "setup" not in result:
        ended = f" and ended Python with exit code {done.returncode}" if done.returncode else ""
        raise SetupError(f"{shown_path(str(folder / 'setup.py'))} never calls setup(…){ended}\n")
    setup: dict[str, Any] = result["setup"]
    return setup


def install_scripts(folder: Path) -> str | None:
    """Where `setup.cfg` puts programs, such as `lib/demo`; None if it does not say."""
    config = configparser.ConfigParser(interpolation=None)
    try:
        config.read(folder / "setup.cfg", encoding="utf-8")
    except (configparser.Error, UnicodeDecodeError) as error:
        raise SetupError(f"setup.cfg: {error}\n") from None
    for option in ("install_scripts", "install-scripts"):
        if config.has_option("install", option):
            return config.get("install", option).strip().removeprefix("$base").strip("/")
    return None
