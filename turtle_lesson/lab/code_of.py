"""The source text of what a learner means: a file, a folder, a function, a class, a node, or the text itself."""

from __future__ import annotations

import ast
import inspect
import linecache
from collections.abc import Iterable
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

SUFFIXES = (".py", ".msg", ".srv", ".xml", ".txt", ".yaml")
"""What of a package's folder is code: programs, interfaces, package.xml and CMakeLists.txt."""

MOST = 60_000
"""Characters in all: more is no help in a chat."""


def code_of(what: Any) -> dict[str, str]:
    """Source texts by a name for each.

    `what` is a path (of a file, or of a folder: its programs, interfaces and package files), a function, a class, an
    instance (its class), a text that is code, or a list of these.

    Raises ValueError for what has no source, and for a path that leads nowhere.
    """
    found: dict[str, str] = {}
    for each in what if isinstance(what, (list, tuple)) else [what]:
        found.update(_texts(each))
    size = sum(map(len, found.values()))
    if size > MOST:
        raise ValueError(
            f"that is {size} characters of code, too much for a chat: name the files or classes that matter, "
            'such as code="src/robot_controller/robot_controller/navigator_node.py"'
        )
    return found


def _texts(what: Any) -> dict[str, str]:
    if isinstance(what, Path) or (isinstance(what, str) and _is_path(what)):
        return _files(Path(what))
    if isinstance(what, str):
        return {"code": f"{what.strip()}\n"}
    target = what if isinstance(what, (type, FunctionType)) else getattr(what, "__func__", type(what))
    return {target.__qualname__: _source(target)}


def _is_path(text: str) -> bool:
    return "\n" not in text and len(text) < 300 and (Path(text).exists() or text.endswith(SUFFIXES))


def _files(path: Path) -> dict[str, str]:
    if not path.exists():
        raise ValueError(f"there is no file {path} here ({Path.cwd().name}/): look with ls, or give the class itself")
    if path.is_file():
        return {path.name: _read(path)}
    return {file.relative_to(path).as_posix(): _read(file) for file in _code_files(path)}


def _code_files(folder: Path) -> Iterable[Path]:
    hidden = {"build", "install", "log", "__pycache__"}
    files = (file for file in folder.rglob("*") if file.is_file() and file.suffix in SUFFIXES)
    return sorted(file for file in files if not hidden & set(file.relative_to(folder).parts))


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} is not a text file") from None


def _source(target: Any) -> str:
    """The source of a function or class, also of a class from a cell, which Python 3.11's inspect does not find."""
    if isinstance(target, type):
        for code in _codes(target):
            tree_text = "".join(linecache.getlines(code.co_filename))
            if tree_text and (text := _class_in(tree_text, target.__name__)):
                return text
    try:
        return inspect.getsource(target)
    except (OSError, TypeError):
        raise ValueError(f"the source of {target!r} cannot be found: give the file, or the text itself") from None


def _codes(kind: type) -> Iterable[CodeType]:
    for value in vars(kind).values():
        function = getattr(value, "__func__", value)
        if isinstance(function, FunctionType):
            yield function.__code__


def _class_in(text: str, name: str) -> str | None:
    try:
        tree = ast.parse(text)
    except SyntaxError:
        return None
    for statement in ast.walk(tree):
        if isinstance(statement, ast.ClassDef) and statement.name == name:
            return f"{ast.get_source_segment(text, statement)}\n"
    return None
