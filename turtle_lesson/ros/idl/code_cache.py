"""Compiled code of generated classes, kept in the user's cache folder: to compile it takes most of the time of a start.

Each Python has a folder of its own. A file is named by a hash of the source text, so that a changed definition and a newer
lesson have another one, and begins with a hash of its content: a damaged file counts as none. Where the folder cannot be
written nothing is kept. `TURTLE_LESSON_CACHE=off` switches the cache off, as grading does.
"""

from __future__ import annotations

import marshal
import os
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.util import MAGIC_NUMBER
from io import FileIO
from pathlib import Path
from types import CodeType

from .. import hooks

VARIABLE = "TURTLE_LESSON_CACHE"
"""The environment variable that switches the cache off: `off`."""

DIGEST = sha256().digest_size


def compiled(source: str, file: str) -> CodeType:
    """The code of a module's text, as `compile` makes it; `file` is its name in tracebacks."""
    if (folder := cache_folder()) is None:
        return compile(source, file, "exec")
    path = os.path.join(folder, sha256(f"{file}\n{source}".encode()).hexdigest())
    code = _read(path)
    if code is None:
        code = compile(source, file, "exec")
        if not sys.dont_write_bytecode:
            _write(path, marshal.dumps(code))
    return code


def _read(path: str) -> CodeType | None:
    try:
        with FileIO(path) as file:  # without a buffer, in a fifth of the time
            content = file.readall()
    except OSError:
        return None
    if sha256(content[DIGEST:]).digest() != content[:DIGEST]:  # marshal would not always notice
        return None
    code: CodeType = marshal.loads(content[DIGEST:])
    return code


def _write(path: str, content: bytes) -> None:
    """Write a file in one step, so that no other process ever sees a part of it."""
    beside = Path(f"{path}.{os.getpid()}")
    with suppress(OSError):
        try:
            beside.write_bytes(sha256(content).digest() + content)
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


@cache
def cache_folder() -> str | None:
    """The folder to use, made if need be; None where nobody else must be able to put code into it, and somebody could."""
    if os.environ.get(VARIABLE) == "off":
        return None
    folder = _user_folder()
    with suppress(OSError, RuntimeError):
        if not folder.is_absolute() or folder.resolve().is_relative_to(hooks.learners_folder().resolve()):
            return None  # it may have come with the learner's files
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.stat()
        if sys.platform == "win32" or (found.st_uid == os.getuid() and not found.st_mode & 0o022):
            return str(folder)
    return None


def _user_folder() -> Path:
    """Where this user's programs keep what they can make again."""
    if sys.platform == "win32":
        place = os.environ.get("LOCALAPPDATA", r"~\AppData\Local")
    elif sys.platform == "darwin":
        place = "~/Library/Caches"
    else:
        place = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    python = f"{sys.implementation.cache_tag}-{MAGIC_NUMBER.hex()}-{sys.flags.optimize}"
    return Path(place).expanduser() / "turtle-lesson" / "messages" / python
