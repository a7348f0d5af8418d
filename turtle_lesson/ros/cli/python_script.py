"""`python3 FILE.py …` and `python3 -m MODULE …`: run a file, or a module of a package that was sourced, as a program of this
world, as `ros2 run` does with those of packages.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..ament.index import current_packages
from ..ament.install_tree import python_folders
from ..ament.package import PythonProgram
from .jobs import lasting

if TYPE_CHECKING:
    from ..runtime.world import World


_PYTHON = re.compile(r"python(3(\.\d+)?)?")
_AS_MODULE = """\
from importlib.util import find_spec

__spec__ = find_spec({name!r})
if __spec__.submodule_search_locations is not None:
    __spec__ = find_spec({name!r} + ".__main__")
__file__, __package__, __loader__ = __spec__.origin, __spec__.parent, __spec__.loader
del find_spec
exec(__loader__.get_code(__spec__.name))
"""
"""Runs a module in the place of the main program. (runpy would change `sys.modules` when the program is interrupted,
at a time when those of the notebook are in it.)"""


def names_a_script(words: Sequence[str]) -> bool:
    """Whether a command is Python with a file or module that is there; all else the computer would have to do."""
    return len(words) > 1 and _PYTHON.fullmatch(words[0]) is not None and _script(words[1:]) is not None


def _script(arguments: Sequence[str]) -> Path | None:
    """The file that Python would run."""
    name = arguments[0]
    if name == "-m":
        return _module(arguments[1]) if len(arguments) > 1 else None
    return Path(name) if not name.startswith("-") and len(name) < 1000 and Path(name).is_file() else None


def _module(name: str) -> Path | None:
    """The file of a module beside which the terminal stands, or of a package that was sourced."""
    if not all(part.isidentifier() for part in name.split(".")):
        return None
    prefixes = [package.prefix for package in current_packages() if package.prefix is not None]
    folders = [Path.cwd(), *(folder for prefix in prefixes for folder in python_folders(prefix))]
    inner = Path(*name.split("."))
    places = (folder / file for folder in folders for file in (inner.with_suffix(".py"), inner / "__main__.py"))
    return next((place for place in places if place.is_file()), None)


def run_script(world: World, words: Sequence[str], stdin: str | None, stdout: Any, stderr: Any) -> int:
    """Start the program, let it begin, and leave it running; the exit code of one that has ended at once.

    It reads `stdin` as its input, or the keyboard if there is none, and prints into the cell, or into files behind `>`.
    """
    from .group_run_launch import leave, reader_of

    path = _script(words[1:])
    assert path is not None
    target: Path | PythonProgram = path
    name, arguments = path.stem, list(words[1:])
    if arguments[0] == "-m":
        name, arguments = arguments[1].rpartition(".")[2], [str(path), *arguments[2:]]
        target = PythonProgram(path, (Path.cwd(),), _AS_MODULE.format(name=words[2]))
    out, error = lasting(stdout, world.sim), lasting(stderr, world.sim)
    process = world.spawn(target, name=name, argv=arguments, stdin=reader_of(stdin), stdout=out, stderr=error)
    return leave(process, " ".join(words), None)
