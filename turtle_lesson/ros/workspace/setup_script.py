"""Reads a `setup.py` by running it with a stand-in for setuptools, which notes what `setup(…)` was given."""

from __future__ import annotations

import configparser
import contextlib
import io
import sys
import traceback
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from types import ModuleType
from typing import Any

from ..core.tracebacks import shown_path


class SetupError(Exception):
    """A setup.py that fails; the text is Python's, shortened to the file's own lines."""


def read_setup(folder: Path) -> dict[str, Any]:
    """What the package's `setup.py` gives to `setup(…)`.

    Raises:
        SetupError: it fails, or never calls `setup`.
    """
    file = folder / "setup.py"
    given: list[dict[str, Any]] = []
    try:
        code = compile(file.read_bytes(), "setup.py", "exec")
        with contextlib.chdir(folder), _stand_ins(given), contextlib.redirect_stdout(io.StringIO()):
            exec(code, {"__name__": "__main__", "__file__": "setup.py"})
    except (Exception, SystemExit) as error:
        raise SetupError(_python_text(error, folder)) from None
    if not given:
        raise SetupError(f"{shown_path(str(file))} never calls setup(…)\n")
    return given[-1]


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


@contextlib.contextmanager
def _stand_ins(given: list[dict[str, Any]]) -> Iterator[None]:
    """Have `import setuptools` and `from distutils.core import setup` find the stand-in for a while."""

    def setup(**options: Any) -> None:
        given.append(options)

    modules = {}
    for name in ("setuptools", "distutils", "distutils.core"):
        modules[name] = module = ModuleType(name)
        module.__dict__.update(setup=setup, find_packages=_find_packages, find_namespace_packages=_find_packages)
        module.__path__ = []
    before = {name: sys.modules.get(name) for name in modules}
    sys.modules.update(modules)
    try:
        yield
    finally:
        for name, module_before in before.items():
            sys.modules.pop(name)
            if module_before is not None:
                sys.modules[name] = module_before


def _find_packages(where: str = ".", exclude: Any = (), include: Any = ("*",)) -> list[str]:
    found = []
    for file in sorted(Path(where).rglob("__init__.py")):
        name = ".".join(file.parent.relative_to(where).parts)
        inside = all((Path(where).joinpath(*name.split(".")[:i]) / "__init__.py").is_file() for i in range(1, 99))
        wanted = any(fnmatchcase(name, pattern) for pattern in include)
        if name and inside and wanted and not any(fnmatchcase(name, pattern) for pattern in exclude):
            found.append(name)
    return found


def _python_text(error: BaseException, folder: Path) -> str:
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == "setup.py"]
    lines = ["Traceback (most recent call last):\n"] if frames else []
    source = (folder / "setup.py").read_text(encoding="utf-8", errors="replace").splitlines()
    for frame in frames:
        lines.append(f'  File "setup.py", line {frame.lineno}, in {frame.name}\n')
        if frame.lineno and frame.lineno <= len(source):
            lines.append(f"    {source[frame.lineno - 1].strip()}\n")
    return "".join([*lines, *traceback.format_exception_only(error)])
