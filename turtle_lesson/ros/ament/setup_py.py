"""What a package's `setup.py` and `setup.cfg` say.

A `setup.py` is read by running it, as colcon does, with a stand-in for setuptools. This file is also the program that does so
(`python -I setup_py.py FOLDER ANSWER`), so that a setup.py that loops, ends the process or changes Python's modules does no
harm; it imports nothing of this library.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from fnmatch import fnmatchcase
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar

LONGEST = 10.0
"""What a setup.py may take, in s of real time."""


class SetupError(Exception):
    """A setup.py that fails; the text is Python's, shortened to the file's own lines."""


def read_setup(folder: Path) -> dict[str, Any]:
    """What `setup.py` gives to `setup(…)`. Raises SetupError where it fails, does not end, or never calls `setup`."""
    import subprocess  # which the program does not need: it starts sooner
    import tempfile

    with tempfile.TemporaryDirectory() as scratch:
        answer = Path(scratch) / "answer.json"
        command = [sys.executable, "-I", "-X", "utf8", __file__, str(folder.resolve()), str(answer)]
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
        raise SetupError(f"setup.py never calls setup(…){ended}\n")
    setup: dict[str, Any] = result["setup"]
    return setup


def install_scripts(folder: Path) -> str | None:
    """Where `setup.cfg` puts programs, such as `lib/demo`; None if it does not say."""
    import configparser

    config = configparser.ConfigParser(interpolation=None)
    try:
        config.read(folder / "setup.cfg", encoding="utf-8")
    except (configparser.Error, UnicodeDecodeError) as error:
        raise SetupError(f"setup.cfg: {error}\n") from None
    given = config["install"] if config.has_section("install") else {}
    found = given.get("install_scripts", given.get("install-scripts"))
    return None if found is None else found.strip().removeprefix("$base").strip("/")


# -- the program that runs a setup.py ------------------------------------------------------------------------------------


def main(folder: str, answer: str) -> None:
    """Run the folder's setup.py; the file `answer` gets `{"setup": …}` or `{"error": …}`."""
    result: dict[str, Any] = {}
    os.chdir(folder)
    sys.path.insert(0, folder)
    sys.argv = ["setup.py"]
    _put_stand_ins(result)
    try:
        source = Path("setup.py").read_bytes()
        exec(compile(source, "setup.py", "exec"), {"__name__": "__main__", "__file__": "setup.py"})
    except BaseException as error:
        result["error"] = _text(error)
    Path(answer).write_text(json.dumps(result, default=_plain), encoding="utf-8")


def _plain(value: Any) -> Any:
    return sorted(value, key=str) if isinstance(value, (set, frozenset)) else str(value)


def _put_stand_ins(result: dict[str, Any]) -> None:
    """Have `import setuptools` and `distutils`, which setuptools brings, find the stand-ins; `setup` notes what it is given."""

    def setup(**options: Any) -> None:
        result["setup"] = options

    setup.__qualname__ = "setup"
    finders = {"find_packages": find_packages, "find_namespace_packages": find_packages}
    for name in ("setuptools", "distutils", "distutils.core"):
        _put(name, setup=setup, Command=Command, **finders)
    _put("distutils.log", __getattr__=lambda name: lambda *args: None)  # what is logged is seen nowhere here
    for package in ("setuptools", "distutils"):
        _put(f"{package}.command")
        for name in ("build_ext", "build_py", "develop", "egg_info", "install", "sdist", "test"):
            _put(f"{package}.command.{name}", **{name: type(name, (Command,), {})})


class Command:
    """What a setup.py's own commands are derived from; it is not carried out, as only `setup(…)` is looked at."""

    user_options: ClassVar[list[Any]] = []


def _put(name: str, **content: Any) -> None:
    """Make a module that can be imported, and is an attribute of the one above it."""
    module = ModuleType(name)
    module.__dict__.update(content)
    module.__path__ = []
    sys.modules[name] = module
    above, _, own = name.rpartition(".")
    if above:
        setattr(sys.modules[above], own, module)


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
    # Without columns, so that no Python marks them by ^^^^.
    shown = [traceback.FrameSummary(each.filename, each.lineno, each.name, line=each.line) for each in frames[-5:]]
    lines = ["Traceback (most recent call last):\n", *traceback.format_list(shown)] if frames else []
    return "".join([*lines, *traceback.format_exception_only(error)])


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
