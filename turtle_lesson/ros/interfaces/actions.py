"""The services and messages that ROS derives from an action: how goal, result and feedback travel.

Which fields they have follows `rosidl_parser.definition.Action`.
"""

from __future__ import annotations

from turtle_lesson.ros.interfaces.model import ActionDefinition, Field, FieldType, MessageDefinition

GOAL_ID = Field(FieldType("UUID", "unique_identifier_msgs"), "goal_id")
STAMP = Field(FieldType("Time", "builtin_interfaces"), "stamp")
ACCEPTED = Field(FieldType("bool"), "accepted")
STATUS = Field(FieldType("int8"), "status")


def derived_parts(action: ActionDefinition) -> tuple[MessageDefinition, ...]:
    """Requests and responses of the services SendGoal and GetResult, then the feedback message."""
    return (
        _part(action, "SendGoal_Request", GOAL_ID, _own(action, "goal")),
        _part(action, "SendGoal_Response", ACCEPTED, STAMP),
        _part(action, "GetResult_Request", GOAL_ID),
        _part(action, "GetResult_Response", STATUS, _own(action, "result")),
        _part(action, "FeedbackMessage", GOAL_ID, _own(action, "feedback")),
    )


def _own(action: ActionDefinition, part: str) -> Field:
    return Field(FieldType(f"{action.name}_{part.capitalize()}", action.package, folder="action"), part)


def _part(action: ActionDefinition, suffix: str, *fields: Field) -> MessageDefinition:
    text = "".join(f"{field}\n" for field in fields)
    name = f"{action.name}_{suffix}"
    return MessageDefinition(action.package, name, fields, (), text, "action", action.file)
