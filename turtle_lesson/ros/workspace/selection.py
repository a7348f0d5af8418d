"""Which of the packages found `colcon` is to take: `--packages-select` and its kin."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable

from .discover import ColconError, Found, in_order, needed_by
from .errors import did_you_mean

Warn = Callable[[str], None]


class UnknownPackageError(ColconError):
    """A package that an option names, and without which nothing makes sense."""


def add_selection(parser: argparse.ArgumentParser) -> None:
    """The options that choose packages."""
    parser.add_argument("--base-paths", nargs="*", metavar="PATH", help="folders to look for packages in (default: .)")
    for option, text in _MANY.items():
        parser.add_argument(option, nargs="*", metavar="PATTERN" if "regex" in option else "PKG_NAME", help=text)
    parser.add_argument("--packages-start", metavar="PKG_NAME", help="this package and those that come after it")
    parser.add_argument("--packages-end", metavar="PKG_NAME", help="this package and those that come before it")


_MANY = {
    "--packages-ignore": "packages to ignore, as if they did not exist",
    "--packages-up-to": "these packages and all that they depend on",
    "--packages-above": "these packages and all that depend on them",
    "--packages-select": "only these packages",
    "--packages-skip": "all packages except these",
    "--packages-select-regex": "only packages whose names match",
    "--packages-skip-regex": "all packages except those whose names match",
}


def choose(args: argparse.Namespace, found: list[Found], warn: Warn) -> list[Found]:
    """The packages that are left. What is named and is not there is told to `warn`.

    Raises:
        UnknownPackageError: an option that needs its package names one that is not there.
        ColconError: a pattern is no regular expression.
    """
    found = [each for each in found if each.name not in set(args.packages_ignore or [])]
    names = {each.name for each in found}
    _check_names(args, names, warn)
    chosen = set(names)
    if args.packages_select is not None:
        chosen &= set(args.packages_select)
    if args.packages_up_to is not None:
        chosen &= needed_by(found, args.packages_up_to)
    if args.packages_above is not None:
        chosen &= _above(found, args.packages_above)
    if args.packages_select_regex is not None:
        chosen &= _matching(names, args.packages_select_regex)
    chosen -= set(args.packages_skip or []) | _matching(names, args.packages_skip_regex or [])
    if args.packages_start or args.packages_end:
        chosen &= _between(found, args.packages_start, args.packages_end)
    return [each for each in found if each.name in chosen]


def advice(name: str, names: Iterable[str]) -> str:
    """What was perhaps meant, or all that there is."""
    names = sorted(names)
    return did_you_mean(name, names) or (f"There are: {', '.join(names)}." if names else "")


def _check_names(args: argparse.Namespace, names: set[str], warn: Warn) -> None:
    for option in ("--packages-up-to", "--packages-above", "--packages-start", "--packages-end"):
        given = getattr(args, option.removeprefix("--").replace("-", "_")) or []
        for name in [given] if isinstance(given, str) else given:
            if name not in names:
                text = f"Package '{name[:80]}' specified with {option} was not found"
                raise UnknownPackageError(f"{text}\nHint: {advice(name, names)}" if names else text)
    for option in ("packages_select", "packages_skip"):
        for name in getattr(args, option) or []:
            if name not in names:
                flag = "--" + option.replace("_", "-")
                hint = advice(name, names)
                warn(f"ignoring unknown package '{name[:80]}' in {flag}" + (f"\nHint: {hint}" if hint else ""))


def _above(found: list[Found], names: list[str]) -> set[str]:
    return {each.name for each in found if needed_by(found, [each.name]).intersection(names)}


def _matching(names: set[str], patterns: list[str]) -> set[str]:
    try:
        return {name for name in names if any(re.fullmatch(pattern, name) for pattern in patterns)}
    except re.error as error:
        raise ColconError(f"{' '.join(patterns)[:80]} is not a regular expression: {error}") from None


def _between(found: list[Found], start: str | None, end: str | None) -> set[str]:
    ordered = [each.name for each in in_order(found)]
    first = ordered.index(start) if start else 0
    return set(ordered[first : ordered.index(end) + 1 if end else None])
