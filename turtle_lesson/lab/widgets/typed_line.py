"""What a form does, as a line for the terminal."""

from __future__ import annotations

import shlex
from typing import Any


def publish_line(topic: str, type_name: str, values: dict[str, Any], rate: float | None) -> str:
    """The `ros2 topic pub` that publishes these values: once, or so often a second."""
    how = "--once" if rate is None else f"--rate {rate:g}"
    return f"ros2 topic pub {how} {topic} {type_name} {_yaml(values)}"


def call_line(service: str, type_name: str, values: dict[str, Any]) -> str:
    """The `ros2 service call` that asks with these values."""
    return f"ros2 service call {service} {type_name} {_yaml(values)}"


def _yaml(values: dict[str, Any]) -> str:
    """Values as one word of a shell: in double quotes as in ROS's own examples, unless a sign there has a meaning."""
    import yaml

    def dumped(allow_unicode: bool) -> str:
        options: dict[str, Any] = {"default_flow_style": True, "width": float("inf"), "sort_keys": False}
        return yaml.safe_dump(values, allow_unicode=allow_unicode, **options).strip()

    text = dumped(allow_unicode=True)
    if yaml.safe_load(text) != values:  # some rare signs, such as U+0085, come back as blanks if they are not escaped
        text = dumped(allow_unicode=False)
    return shlex.quote(text) if set(text) & set('"$`\\!') else f'"{text}"'
