"""Runs a `setup.py` with a stand-in for setuptools, and writes what `setup(…)` was given as JSON.

It is a program of its own (`python -I setup_runner.py FOLDER ANSWER`), so that a setup.py that loops, ends the process or
changes Python's modules does no harm; it imports nothing of this library.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from fnmatch import fnmatchcase
from pathlib import Path
from types import ModuleType
from typing import Any


def main(folder: str, answer: str) -> None:
    """Run the folder's setup.py; the file `answer` gets `{"setup": …}` or `{"error": …}`."""
    given: list[dict[str, Any]] = []
    result: dict[str, Any] = {}
    os.chdir(folder)
    sys.path.insert(0, folder)
    sys.argv = ["setup.py"]
    _put_stand_ins(given)
    try:
        source = Path("setup.py").read_bytes()
        exec(compile(source, "setup.py", "exec"), {"__name__": "__main__", "__file__": "setup.py"})
    except BaseException as error:
        result["error"] = _text(error)
    else:
        if given:
            result["setup"] = given[-1]
    Path(answer).write_text(json.dumps(result, default=_plain), encoding="utf-8")


def _plain(value: Any) -> Any:
    return sorted(value, key=str) if isinstance(value, (set, frozenset)) else str(value)


def _put_stand_ins(given: list[dict[str, Any]]) -> None:
    """Have `import setuptools` and `from distutils.core import setup` find the stand-in."""

    def setup(**options: Any) -> None:
        given.append(options)

    setup.__qualname__ = "setup"
    for name in ("setuptools", "distutils", "distutils.core"):
        module = ModuleType(name)
        module.__dict__.update(setup=setup, find_packages=find_packages, find_namespace_packages=find_packages)
        module.__path__ = []
        sys.modules[name] = module


def find_packages(where: str = ".", exclude: Any = (), include: Any = ("*",)) -> list[str]:
    """The names of the packages in a folder, as setuptools finds them."""
    found = []
    for file in sorted(Path(where).rglob("__init__.py")):
        parts = file.parent.relative_to(where).parts
        inside = all((Path(where).joinpath(*parts[:end]) / "__init__.py").is_file() for end in range(1, len(parts)))
        name = ".".join(parts)
        wanted = any(fnmatchcase(name, pattern) for pattern in include)
        if name and inside and wanted and not any(fnmatchcase(name, pattern) for pattern in exclude):
            found.append(name)
    return found


def _text(error: BaseException) -> str:
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == "setup.py"]
    lines = ["Traceback (most recent call last):\n"] if frames else []
    file = Path("setup.py")
    source = file.read_text(encoding="utf-8", errors="replace").splitlines() if file.is_file() else []
    for frame in frames[-5:]:
        lines.append(f'  File "setup.py", line {frame.lineno}, in {frame.name}\n')
        if frame.lineno and frame.lineno <= len(source):
            lines.append(f"    {source[frame.lineno - 1].strip()}\n")
    return "".join([*lines, *traceback.format_exception_only(error)])


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
