"""ROS arguments of a process: `--ros-args -r from:=to -p name:=value --params-file file --log-level level`.

Facts: https://docs.ros.org/en/humble/How-To-Guides/Node-arguments.html.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from turtle_lesson.ros.graph.names import Remap

from .exceptions import RCLError, UnknownROSArgsError
from .parameter import Parameter

FAILED = "failed to initialize rcl:"
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")
NAME = re.compile(r"[\w/~{}*]+")


@dataclass
class Arguments:
    """What the ROS arguments say: remappings, parameter values (node pattern, name, value), the log level."""

    remaps: list[Remap] = field(default_factory=list)
    parameters: list[tuple[str, str, Any]] = field(default_factory=list)
    log_levels: dict[str, str] = field(default_factory=dict)

    def parameters_of(self, full_name: str) -> list[Parameter]:
        """The values for the node of this full name; of several for one parameter the last one counts."""
        return [
            Parameter(name, value=value)
            for pattern, name, value in self.parameters
            if pattern_matches(pattern, full_name)
        ]


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
        name, level = _log_level(_next(word, following))
        found.log_levels[name] = level
    elif word in {"-e", "--enclave", "--log-config-file"}:
        _next(word, following)
    elif word not in _SWITCHES:
        raise UnknownROSArgsError(
            f"Found unknown ROS arguments: [{word}]; known are -r, -p, --params-file, --log-level"
        )


_SWITCHES = {
    f"--{state}-{what}-logs" for state in ("enable", "disable") for what in ("rosout", "stdout", "external-lib")
}


def _next(word: str, following: Iterator[str]) -> str:
    for value in following:
        return value
    raise RCLError(f"{FAILED} Couldn't parse trailing {word} flag. It must be followed by a value")


def _remap(rule: str) -> Remap:
    match, separator, replacement = rule.partition(":=")
    node, colon, name = match.partition(":")
    if not colon or name.startswith("//"):
        node, name = "", match
    parts = [part.removeprefix("rostopic://").removeprefix("rosservice://") for part in (name, replacement)]
    if not separator or not all(NAME.fullmatch(part) for part in parts):
        raise RCLError(f"{FAILED} Couldn't parse remap rule: '-r {rule}'. A rule looks like old_name:=new_name")
    if name == "__ns" and not replacement.startswith("/"):
        raise RCLError(
            f"{FAILED} Couldn't parse remap rule: '-r {rule}'. A namespace is given in full: __ns:=/{replacement}"
        )
    return Remap(name, replacement, node or None)


def _parameter(rule: str) -> tuple[str, str, Any]:
    name, separator, text = rule.partition(":=")
    if not separator or not name or not text:
        raise RCLError(f"{FAILED} Couldn't parse parameter override rule: '-p {rule}'. A rule looks like name:=value")
    node, colon, own = name.partition(":")
    try:
        value = load_yaml(text)
    except yaml_error() as error:
        raise RCLError(
            f"{FAILED} Couldn't parse parameter override rule: '-p {rule}'. Its value is no YAML: {error}"
        ) from None
    _check_value(value, f"parameter override rule: '-p {rule}'")
    return (f"/**/{node}" if colon else "/**", own if colon else name, value)


def _log_level(rule: str) -> tuple[str, str]:
    name, _, level = rule.rpartition(":=")
    if level.upper() not in LEVELS:
        raise RCLError(f"{FAILED} Couldn't parse log level: '--log-level {rule}'. Levels are {', '.join(LEVELS)}")
    return name, level


def read_parameter_file(path: str) -> list[tuple[str, str, Any]]:
    """The values in a YAML parameter file: node pattern, parameter name (nested ones joined by dots), value."""
    what = f"params file: '--params-file {path}'"
    try:
        content = load_yaml(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise RCLError(f"{FAILED} Couldn't parse {what}. Error: Error opening YAML file: {error.strerror}") from None
    except yaml_error() as error:
        raise RCLError(f"{FAILED} Couldn't parse {what}. Error: Error parsing the YAML file: {error}") from None
    if not isinstance(content, dict):
        raise RCLError(
            f"{FAILED} Couldn't parse {what}. Error: it should map node names to `ros__parameters:`, found {content!r}"
        )
    found = list(_entries(content, "", what))
    for _, _, value in found:
        _check_value(value, what)
    return found


def _entries(content: dict[str, Any], pattern: str, what: str) -> Iterator[tuple[str, str, Any]]:
    for key, value in content.items():
        if key == "ros__parameters":
            for name, leaf in _flatten(value or {}, ""):
                yield (pattern, name, leaf)
        elif isinstance(value, dict):
            yield from _entries(value, f"{pattern}/{str(key).strip('/')}", what)
        else:
            raise RCLError(
                f"{FAILED} Couldn't parse {what}. Error: Cannot have a value before ros__parameters: "
                f"indent '{key}: {value}' beneath that word"
            )


def _flatten(values: dict[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield (f"{prefix}{key}", value)


def _check_value(value: Any, what: str) -> None:
    """Raise RCLError for a list of several types, and for what no parameter can have as its value."""
    items = value if isinstance(value, list) else [value]
    for item in items:
        if not isinstance(item, (bool, int, float, str)):
            raise RCLError(f"{FAILED} Couldn't parse {what}. Error: {item!r} cannot be the value of a parameter")
    if len({type(item) for item in items}) > 1:
        raise RCLError(
            f"{FAILED} Couldn't parse {what}. Error: Sequence should be of same type, got {value!r}; "
            "write 1.0 for a whole number among others"
        )


def load_yaml(text: str) -> Any:
    """What a YAML text means to ROS, which also takes 1e3 for a number. Raises yaml.YAMLError."""
    import yaml

    class Loader(yaml.SafeLoader):
        pass

    Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?\d+[eE][-+]?\d+$"), list("-+0123456789"))
    return yaml.load(text, Loader)


def yaml_error() -> type[Exception]:
    """The error of a text that is no YAML. (PyYAML is only imported where a YAML text is read.)"""
    import yaml

    return yaml.YAMLError


def pattern_matches(pattern: str, full_name: str) -> bool:
    """Whether a node pattern such as `/**`, `/*/navigator` or `/navigator` means the node of this full name."""
    expression = ""
    for part in pattern.strip("/").split("/"):
        expression += {"**": r"(/\w+)*", "*": r"/\w+"}.get(part, "/" + re.escape(part))
    return re.fullmatch(expression, full_name) is not None
