"""Files that are run by their name: `./draw.py`, `./commands.sh`, `bash commands.sh`, and `source commands.sh`."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

NOT_EXECUTABLE = 126
"""bash's exit code for a file that is there and may not be run."""

_SHELLS = ("bash", "sh")
_OWN_SETUP = re.compile(r"(local_)?setup\.\w+")
"""What `colcon build` makes, which is not read line by line."""
_BLOCK = re.compile(r"\s*(for|while|until|if|case|select|function)\s|\s*\w+\s*\(\)")
_ARGUMENT = re.compile(r"\$[1-9@*#]|\$\{[1-9@*#]")


def with_its_program(words: Sequence[str]) -> list[str]:
    """`./FILE …` as the command that the first line of this file asks for, such as `python3 ./FILE …`; other words as
    they are. A file without such a line is a script of the shell, as for bash.

    Raises PermissionError if the file may not be run.
    """
    if "/" not in words[0] or not Path(words[0]).is_file():
        return list(words)
    if not os.access(words[0], os.X_OK):
        raise PermissionError(f"bash: {words[0]}: Permission denied. Make it executable: chmod +x {words[0]}")
    with Path(words[0]).open(encoding="utf-8", errors="replace") as file:
        first = file.readline(200)
    if not first.startswith("#!"):
        return ["bash", *words]
    program = re.search(r"(python|bash|sh)[\d.]*\s*$", first)
    return [program[1].replace("python", "python3"), *words] if program else list(words)


def commands_in(words: Sequence[str]) -> str | None:
    """The commands in the file that `bash FILE`, `sh FILE` or `source FILE.sh` names; None for all other words.

    Raises ValueError if the file has what this terminal does not do: loops, conditions, functions and arguments.
    """
    sourced = words[0] in ("source", ".")
    if len(words) < 2 or not (sourced or words[0] in _SHELLS) or not Path(words[1]).is_file():
        return None
    if sourced and (Path(words[1]).suffix not in (".sh", ".bash") or _OWN_SETUP.fullmatch(Path(words[1]).name)):
        return None
    text = Path(words[1]).read_text(encoding="utf-8")
    for number, line in enumerate(text.splitlines(), 1):
        if not line.lstrip().startswith("#") and (_BLOCK.match(line) or _ARGUMENT.search(line)):
            raise ValueError(
                f"{words[1]}: line {number}: this simulated terminal runs commands one after the other; it has no loops, "
                "conditions, functions and arguments ($1). Write the commands without them, or as a program in Python"
            )
    return text
