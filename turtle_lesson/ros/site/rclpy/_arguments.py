"""ROS arguments of a process: `--ros-args -r from:=to -p name:=value --params-file file --log-level level`.

Facts: https://docs.ros.org/en/humble/How-To-Guides/Node-arguments.html.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from turtle_lesson.ros.graph.names import Remap

from .exceptions import RCLError, UnknownROSArgsError


@dataclass
class Arguments:
    """What the ROS arguments say: remappings, parameter values (node pattern, name, value), the log level."""

    remaps: list[Remap] = field(default_factory=list)
    parameters: list[tuple[str, str, Any]] = field(default_factory=list)
    log_levels: dict[str, str] = field(default_factory=dict)


def parse_arguments(words: list[str]) -> Arguments:
    """Read the ROS arguments among a process's arguments; what is not between `--ros-args` and `--` is skipped."""
    found = Arguments()
    inside = False
    iterator = iter(words)
    for word in iterator:
        if word == "--ros-args":
            inside = True
        elif word == "--":
            inside = False
        elif inside:
            _take(word, iterator, found)
    return found


def _take(word: str, following: Iterator[str], found: Arguments) -> None:
    if word in {"-r", "--remap"}:
        found.remaps.append(_remap(_next(word, following)))
    elif word in {"-p", "--param"}:
        found.parameters.append(_parameter(_next(word, following)))
    elif word == "--params-file":
        found.parameters.extend(read_parameter_file(_next(word, following)))
    elif word == "--log-level":
        name, _, level = _next(word, following).rpartition(":=")
        found.log_levels[name] = level
    elif word in {"-e", "--enclave", "--log-config-file"}:
        _next(word, following)
    elif word not in _SWITCHES:
        raise UnknownROSArgsError(f"Found unknown ROS arguments: [{word}]; known are -r, -p, --params-file, --log-level")


_SWITCHES = {
    f"--{state}-{what}-logs" for state in ("enable", "disable") for what in ("rosout", "stdout", "external-lib")
}


def _next(word: str, following: Iterator[str]) -> str:
    for value in following:
        return value
    raise RCLError(f"Couldn't parse trailing {word} flag: it must be followed by a value")


def _remap(rule: str) -> Remap:
    match, separator, replacement = rule.partition(":=")
    if not separator or not match or not replacement:
        raise RCLError(f"Couldn't parse remap rule: '-r {rule}'; a rule looks like old_name:=new_name")
    node, colon, name = match.partition(":")
    if colon and not name.startswith("//"):
        return Remap(name, replacement, node)
    return Remap(match, replacement)


def _parameter(rule: str) -> tuple[str, str, Any]:
    name, separator, value = rule.partition(":=")
    if not separator or not name:
        raise RCLError(f"Couldn't parse parameter override rule: '-p {rule}'; a rule looks like name:=value")
    node, colon, own = name.partition(":")
    return (f"/**/{node}" if colon else "/**", own if colon else name, _yaml_value(value))


def _yaml_value(text: str) -> Any:
    import yaml

    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise RCLError(f"Couldn't parse the parameter value '{text}': it is no YAML ({error})") from None


def read_parameter_file(path: str) -> list[tuple[str, str, Any]]:
    """The values in a YAML parameter file: node pattern, parameter name (nested ones joined by dots), value."""
    import yaml

    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise RCLError(f"Error opening YAML file: {path}: {error.strerror}") from None
    except yaml.YAMLError as error:
        raise RCLError(f"Error parsing the YAML file {path}: {error}") from None
    if not isinstance(content, dict):
        raise RCLError(f"the parameter file {path} should map node names to `ros__parameters:`, found {content!r}")
    return list(_entries(content, "", path))


def _entries(content: dict[str, Any], pattern: str, path: str) -> Iterator[tuple[str, str, Any]]:
    for key, value in content.items():
        if key == "ros__parameters":
            for name, leaf in _flatten(value or {}, ""):
                yield (pattern, name, leaf)
        elif isinstance(value, dict):
            yield from _entries(value, f"{pattern}/{str(key).strip('/')}", path)
        else:
            raise RCLError(f"{path}: '{key}: {value}' stands outside of `ros__parameters:`; indent it beneath that word")


def _flatten(values: dict[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield (f"{prefix}{key}", value)


def pattern_matches(pattern: str, full_name: str) -> bool:
    """Whether a node pattern such as `/**`, `/*/navigator` or `/navigator` means the node of this full name."""
    import re

    expression = ""
    for part in pattern.strip("/").split("/"):
        expression += {"**": r"(/\w+)*", "*": r"/\w+"}.get(part, "/" + re.escape(part))
    return re.fullmatch(expression, full_name) is not None
