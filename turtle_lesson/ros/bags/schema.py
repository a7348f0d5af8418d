"""Message definitions as a bag carries them: one text that holds a message's definition and all that it is made of.

Facts: rosbag2_cpp's message_definitions/local_message_definition_source.cpp and https://mcap.dev/spec/registry
(encoding `ros2msg`): the definition itself, then for each other message a line of 80 `=`, a line `MSG: package/Name`
and its definition. The hash is that of REP 2011, version 1 (RIHS01).
"""

from __future__ import annotations

from typing import Any

from .errors import UnrecordableType

SEPARATOR = "=" * 80


def schema_text(message_class: Any) -> str:
    """The `ros2msg` text of a message class: its definition with those of its fields' messages."""
    parts = [_own_text(message_class)]
    for name, part in _messages_within(message_class).items():
        package, _, base = name.split("/")
        parts.append(f"MSG: {package}/{base}\n{_own_text(part)}")
    return f"{SEPARATOR}\n".join(parts)


def type_hash(message_class: Any, text: str) -> str:
    """The RIHS01 hash of a message whose schema text is `text`.

    Raises UnrecordableType for what no bag's reader understands, such as a wstring.
    """
    from rosbags.typesys import get_types_from_msg
    from rosbags.typesys.store import Typestore

    name = message_class._TYPE_NAME
    try:
        store = Typestore()
        store.register(get_types_from_msg(text, name))
        return str(store.hash_rihs01(name))
    except Exception as error:
        wide = " (it has a wstring)" if "wstring" in text else ""
        raise UnrecordableType(f"messages of type {name} cannot be recorded{wide}: {error}") from error


def _messages_within(message_class: Any, found: dict[str, Any] | None = None) -> dict[str, Any]:
    """The classes of the messages that a message is made of, at any depth, by type name."""
    found = {} if found is None else found
    for kind in message_class._KINDS:
        part = kind.element_class
        if part is not None and hasattr(part, "_KINDS") and part._TYPE_NAME not in found:
            found[part._TYPE_NAME] = part
            _messages_within(part, found)
    return found


def _own_text(message_class: Any) -> str:
    """The definition as its author wrote it; the rules of definitions keep separator lines out of it."""
    text: str = message_class._DEFINITION.text.replace("\r\n", "\n")
    return text if text.endswith("\n") or not text else f"{text}\n"
