"""What `ros2 topic` and `ros2 service` say alike of the names in the graph and their types."""

from __future__ import annotations

import sys

from .common import CommandError, suggest
from .types import unknown_type


def unknown(kind: str, name: str, known: dict[str, list[str]]) -> CommandError:
    """What is said of a topic or service (`kind`) that does not exist."""
    return CommandError(f"Unknown {kind} '{name}'", suggest(name, known))


def print_types(kind: str, name: str, known: dict[str, list[str]]) -> None:
    """The types of a name. For an unknown one the real tool says nothing, and ends with exit code 1."""
    if name not in known:
        raise unknown(kind, name, known)
    print(*known[name], sep="\n")


def print_names(type_name: str, folder: str, known: dict[str, list[str]], *, count: bool) -> None:
    """The names that have a type, or only how many these are; `folder` is the kind of type: "msg" or "srv"."""
    found = [name for name, types in known.items() if type_name in types]
    if count:
        print(len(found))
    elif found:
        print(*found, sep="\n")
    elif about := unknown_type(type_name, folder):
        print(about, file=sys.stderr)
