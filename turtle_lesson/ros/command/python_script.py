"""`python3 FILE.py …`: runs a file as a program of this world, as `ros2 run` does with those of packages."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import CellOutput

if TYPE_CHECKING:
    from ..world import World

_PYTHON = re.compile(r"python(3(\.\d+)?)?")


def names_a_script(words: Sequence[str]) -> bool:
    """Whether a command is Python with a file that is there, and not `python3 -m …`, which the computer would have to do."""
    return len(words) > 1 and _PYTHON.fullmatch(words[0]) is not None and _is_file(words[1])


def _is_file(name: str) -> bool:
    return not name.startswith("-") and len(name) < 1000 and Path(name).is_file()


def run_script(world: World, words: Sequence[str]) -> int:
    """Start the program, let it begin, and leave it running; the exit code of one that has ended at once."""
    from .group_run_launch import leave

    path, output = Path(words[1]), CellOutput(world.sim)
    process = world.spawn(path, name=path.stem, argv=list(words[1:]), stdout=output, stderr=output)
    return leave(process, " ".join(words), None)
