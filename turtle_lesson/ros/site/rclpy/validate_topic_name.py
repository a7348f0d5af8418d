"""`validate_topic_name`: rclpy's check of a topic's or service's name as a program gives it."""

from turtle_lesson.ros.rmw.names import topic_name_flaw

from .exceptions import InvalidServiceNameException, InvalidTopicNameException


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """True for a good name; raises InvalidTopicNameException or InvalidServiceNameException, with a caret."""
    if (flaw := topic_name_flaw(name)) is not None:
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *flaw)
    return True
