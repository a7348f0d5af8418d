"""`ros2 param dump` and `load`: all parameters of a node, to and from a file."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from ..runtime import files
from . import param_values
from .param_values import arguments_of_all, ask, find_node, listed, set_values, with_reason
from .typed_values import MAX_LENGTH, read_yaml
from .verb import CommandError, direct_node, suggest


def dump_arguments(parser: ArgumentParser) -> None:
    """The arguments of dump."""
    arguments_of_all(parser)
    parser.add_argument("--output-dir", help="Deprecated: write a file named after the node into this folder")
    parser.add_argument("--print", action="store_true", help="Deprecated, and without effect")


def dump(args: Namespace) -> None:
    """`ros2 param dump`."""
    import yaml

    if args.output_dir is not None and not Path(args.output_dir).is_dir():
        raise CommandError(f"'{args.output_dir}' is not a valid directory.")
    with direct_node(args) as node:
        name = find_node(node, args)
        names = listed(node, name)
        values = ask(node, name, "GetParameters", names=names).values
    pairs = zip(names, map(param_values.to_python, values), strict=False)
    tree = {name: {"ros__parameters": param_values.nested(list(pairs))}}
    text = yaml.safe_dump(tree, default_flow_style=False, allow_unicode=True)
    if args.print:
        print("WARNING: '--print' is deprecated; this utility prints to stdout by default", file=sys.stderr)
    if args.output_dir is None or args.print:
        print(text)
        return
    print("WARNING: '--output-dir' is deprecated; use redirection to save to a file", file=sys.stderr)
    file = Path(args.output_dir) / f"{name.lstrip('/').replace('/', '__')}.yaml"
    print("Saving to: ", file)
    try:
        files.save(file, text)
    except (OSError, ValueError) as error:
        raise CommandError(f"cannot write {file}: {getattr(error, 'strerror', None) or error}") from None


def load_arguments(parser: ArgumentParser) -> None:
    """The arguments of load."""
    arguments_of_all(parser)
    parser.add_argument("parameter_file", help="A file as `ros2 param dump` prints it")
    parser.add_argument(
        "--no-use-wildcard", action="store_true", help="Leave out what the file says for all nodes (/**)"
    )


def load(args: Namespace) -> None:
    """`ros2 param load`."""
    with direct_node(args) as node:
        name = find_node(node, args)
        parameters = _read_file(args.parameter_file, name, wildcard=not args.no_use_wildcard)
        messages = [(each, param_values.from_python(value, str(value))) for each, value in parameters]
        for (each, _), result in zip(messages, set_values(node, name, messages), strict=True):
            if result.successful:
                print(with_reason(f"Set parameter {each} successful", result))
            else:
                print(with_reason(f"Set parameter {each} failed", result), file=sys.stderr)


def _read_file(path: str, node_name: str, *, wildcard: bool) -> list[tuple[str, Any]]:
    """The parameters that a file has for a node. Raises CommandError if it has none."""
    content = read_yaml(_text_of(path), path)
    if not isinstance(content, dict):
        raise CommandError(
            f"{path} is not a parameter file: expected a line '{node_name}:' and ros__parameters below it"
        )
    keys = [key for key in (["/**"] if wildcard else []) + [node_name] if key in content]
    if not keys:
        raise CommandError(
            f"Param file does not contain parameters for {node_name},  only for nodes: {content.keys()}",
            suggest(node_name, map(str, content)) and f"Write the name with its slash: {node_name}",
        )
    found: dict[str, Any] = {}
    for key in keys:
        if not isinstance(content[key], dict) or not isinstance(content[key].get("ros__parameters"), dict):
            raise CommandError(
                f"Invalid structure of parameter file for node {key}expected same format as provided by ros2 param dump"
            )
        found.update(param_values.flat(content[key]["ros__parameters"]))
    return list(found.items())


def _text_of(path: str) -> str:
    """The text of a file. Devices are not read, and of a file no more than YAML may have: some never end."""
    file = Path(path)
    try:
        if file.exists() and not file.is_file():
            raise CommandError(f"cannot read {path}: it is a folder or a device, not a file")
        with file.open(encoding="utf-8") as stream:
            return stream.read(MAX_LENGTH + 1)
    except FileNotFoundError:
        raise CommandError(f"[Errno 2] No such file or directory: '{path}'") from None
    except (OSError, ValueError) as error:
        raise CommandError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from None
