"""`rosidl_runtime_py`: interfaces by name, messages as text, and text as messages (facts: rosidl_runtime_py of Humble)."""

# ruff: noqa: F401

from .convert import get_message_slot_types, message_to_csv, message_to_ordereddict, message_to_yaml
from .import_message import import_message_from_namespaced_type
from .set_message import set_message_fields
