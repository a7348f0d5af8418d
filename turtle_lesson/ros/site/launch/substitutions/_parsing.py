"""The arguments of a substitution as XML and YAML launch files write them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def arguments(tag: str, data: Sequence[Any], names: Sequence[str], least: int) -> dict[str, Any]:
    """What stands behind `$(tag `, by the names of the constructor's arguments.

    Args:
        tag: what the substitution is called.
        data: what stands there.
        names: the constructor's arguments, in order.
        least: how many of them must be given.

    Raises:
        TypeError: if there are too few or too many.
    """
    if not least <= len(data) <= len(names):
        most = len(names)
        number = (
            "no"
            if most == 0
            else str(least)
            if least == most
            else f"{least} or {most}"
            if (most == least + 1)
            else f"{least} to {most}"
        )
        plural = "argument" if number == "1" else "arguments"
        error = TypeError(f"{tag} substitution expects {number} {plural}")
        shown = " ".join(f"<{name}>" for name in names)
        error.hint = f"Write $({f'{tag} {shown}'.strip()}); put an argument with spaces in quotes."  # type: ignore[attr-defined]
        raise error
    return dict(zip(names, data, strict=False))
