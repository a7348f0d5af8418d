"""`validate_full_topic_name`: rclpy's check of a topic's or service's full name."""

from .exceptions import InvalidServiceNameException, InvalidTopicNameException
from .validate_topic_name import validate_topic_name


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """True for a good full name; raises InvalidTopicNameException or InvalidServiceNameException, with a caret."""
    if not name.startswith("/"):
        kind = InvalidServiceNameException if is_service else InvalidTopicNameException
        raise kind(name, "topic name must be absolute, it must lead with a '/'", 0)
    return validate_topic_name(name, is_service=is_service)
