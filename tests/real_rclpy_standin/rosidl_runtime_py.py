"""Of the real rosidl_runtime_py what a form needs: messages as plain values, and plain values put into messages."""

from __future__ import annotations

from typing import Any

import yaml


def message_to_ordereddict(msg: Any) -> dict[str, Any]:
    """The fields of a message and of the messages in it."""
    return {name: _plain(getattr(msg, name)) for name in msg.get_fields_and_field_types()}


def _plain(value: Any) -> Any:
    if hasattr(value, "get_fields_and_field_types"):
        return message_to_ordereddict(value)
    return [_plain(each) for each in value] if isinstance(value, (list, tuple)) else value


def message_to_yaml(msg: Any, *, truncate_length: int | None = None) -> str:
    """A message as YAML."""
    return yaml.safe_dump(message_to_ordereddict(msg), sort_keys=False)


def set_message_fields(msg: Any, values: dict[str, Any]) -> None:
    """Set fields to values as YAML gives them."""
    for name, value in values.items():
        now = getattr(msg, name)
        if isinstance(value, dict):
            set_message_fields(now, value)
        else:
            setattr(msg, name, value if isinstance(value, type(now)) else type(now)(value))
