"""A script taken apart into pipelines of commands, and files that are run by their name."""

from __future__ import annotations

import contextlib
import glob
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .lexer import HereText, Operator, Token, Word
from .terminal_io import with_values

# -- script -------------------------------------------------------------------------------------------------------
# A script taken apart into pipelines of commands, and what their words stand for.


class ShellSyntaxError(ValueError):
    """A line that cannot be taken apart into commands."""


@dataclass
class Command:
    """One simple command: its words, and where its input and output go."""

    words: list[Word] = field(default_factory=list)
    given: str | None = None
    stdin: Word | None = None
    stdout: tuple[str, Word] | None = None
    stderr: Word | None = None
    background: bool = False


def pipelines(found: Sequence[Token]) -> Iterator[tuple[str, list[Command]]]:
    """The pipelines of a script, each with the sign before it that decides whether it runs."""
    condition, pipeline = "", [Command()]
    for token in [*found, Operator("\n")]:
        command = pipeline[-1]
        if isinstance(token, Word) and _WANTED not in (command.stdin, command.stderr, *(command.stdout or ())):
            command.words.append(token)
        elif isinstance(token, Word):
            _take_file(command, token)
        elif isinstance(token, HereText):
            command.given = token.text
        elif token.text == "|":
            _check(command, "|")
            pipeline.append(Command())
        elif token.text in {">", ">>", "2>", "&>", "<"}:
            _expect_file(command, token.text)
        elif token.text == "2>&1":
            command.stderr = TO_STDOUT
        elif command.words or len(pipeline) > 1:
            _check(command, token.text)
            command.background = token.text == "&"
            yield condition, pipeline
            condition, pipeline = token.text if token.text in {"&&", "||"} else "", [Command()]
        elif token.text != "\n":
            raise ShellSyntaxError(f"there is no command before {token.text!r}")
    if condition or len(pipeline) > 1:
        raise ShellSyntaxError(f"there is no command after {condition or '|'!r}")


TO_STDOUT = Word("&1", "&1")
_WANTED = Word("\0wanted", "\0wanted")


def _expect_file(command: Command, sign: str) -> None:
    if sign == "<":
        command.stdin = _WANTED
    elif sign == "2>":
        command.stderr = _WANTED
    else:
        command.stdout = (sign, _WANTED)
        command.stderr = TO_STDOUT if sign == "&>" else command.stderr


def _take_file(command: Command, word: Word) -> None:
    """A word is the file that a `<` or `>` waits for."""
    if command.stdin == _WANTED:
        command.stdin = word
    elif command.stdout is not None and command.stdout[1] == _WANTED:
        command.stdout = (command.stdout[0], word)
    else:
        command.stderr = word


def _check(command: Command, sign: str) -> None:
    if not command.words:
        raise ShellSyntaxError(
            f"there is no command before {sign!r}" if sign != "\n" else "there is no command after '|'"
        )
    if command.stdin == _WANTED:
        raise ShellSyntaxError("'<' needs the name of a file")
    if _WANTED in (command.stderr, *(command.stdout or ())):
        raise ShellSyntaxError("'>' needs the name of a file")


# -- what a word stands for --------------------------------------------------------------------------------------------


def expand(word: Word, *, home: Path, exit_code: int) -> list[str]:
    """The words that a word stands for: `~`, `$?`, `$NAME` and patterns are replaced, all else stays as it is typed."""
    if word.text == word.pattern == "$?":
        return [str(exit_code)]
    if "$" in word.pattern and (text := with_values(word.pattern)) != word.pattern:
        return [unquoted] if (unquoted := re.sub(r"\\(.)", r"\1", text)) else []
    if word.text == word.pattern and (word.text == "~" or word.text.startswith("~/")):
        return [str(home) + word.text[1:]]
    if len(word.pattern) < 1000 and re.search(r"(?<!\\)[*?]", word.pattern):
        pattern = re.sub(r"\\(.)", lambda match: glob.escape(match[1]), word.pattern.replace("[", "[[]"))
        with contextlib.suppress(OSError, ValueError, re.error):
            return sorted(glob.glob(pattern)) or [word.text]
    return [word.text]


# -- script files -------------------------------------------------------------------------------------------------
# Files that are run by their name: `./draw.py`, `./commands.sh`, `bash commands.sh`, and `source commands.sh`.

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
