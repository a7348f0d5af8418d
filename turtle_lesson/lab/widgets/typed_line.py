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

    text = yaml.safe_dump(values, default_flow_style=True, width=float("inf"), sort_keys=False, allow_unicode=True)
    text = text.strip()
    return shlex.quote(text) if set(text) & set('"$`\\!') else f'"{text}"'
