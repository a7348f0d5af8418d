"""Usage and help texts of `ros2` and of its commands. Those of the verbs are made by argparse."""

from __future__ import annotations

from .groups import GROUPS, Group

WIDTH = 78


def _usage(prog: str, options: str) -> str:
    """A usage text as argparse of Python 3.11 breaks it: a placeholder that is too long on a line of its own."""
    indent = " " * len(f"usage: {prog} ")
    placeholder = f"Call `{prog} <command> -h` for more detailed usage. ..."
    whole = f"usage: {prog} {options} {placeholder}"
    if len(whole) <= WIDTH:
        return whole
    words = placeholder.split()
    lines, line = [f"usage: {prog} {options}"], indent[:-1]
    for word in words:
        if len(line) + 1 + len(word) > WIDTH:
            lines.append(line)
            line = indent[:-1]
        line += f" {word}"
    return "\n".join([*lines, line])


def top_usage() -> str:
    """The usage of `ros2`."""
    return _usage("ros2", "[-h] [--use-python-default-buffering]")


def group_usage(group: Group) -> str:
    """The usage of a command with verbs."""
    return _usage(f"ros2 {group.name}", "[-h]" + (f" [{group.flag[0]}]" if group.flag else ""))


def top_help() -> str:
    """What `ros2` alone prints."""
    about = "ros2 is the command line of ROS 2: each command looks at, or changes, the system that is running."
    buffering = ("--use-python-default-buffering", "accepted, but without effect here")
    return _help(top_usage(), about, [buffering], {group.name: group.help for group in GROUPS.values()}, "ros2")


def group_help(group: Group) -> str:
    """What a command alone prints: its verbs."""
    verbs = {name: verb.help for name, verb in group.verbs.items()}
    return _help(group_usage(group), group.help, [group.flag] if group.flag else [], verbs, f"ros2 {group.name}")


def _help(usage: str, about: str, options: list[tuple[str, str]], commands: dict[str, str], prog: str) -> str:
    lines = [usage, "", about, "", "options:"]
    for option, text in [("-h, --help", "show this help and do nothing"), *options]:
        lines += [f"  {option:<20}  {text}"] if len(option) <= 20 else [f"  {option}", f"{'':24}{text}"]
    width = max(map(len, commands))
    lines += ["", "Commands:", *(f"  {name:<{width}}  {text}" for name, text in commands.items())]
    return "\n".join([*lines, "", f"  Call `{prog} <command> -h` for more detailed usage."])
