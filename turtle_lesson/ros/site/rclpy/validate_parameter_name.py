"""`validate_parameter_name`: rclpy's check of a parameter's name."""

from .exceptions import InvalidParameterException


def validate_parameter_name(name: str) -> bool:
    """True for a good name; raises InvalidParameterException for an empty one, the only kind that is bad."""
    if not name:
        raise InvalidParameterException(name)
    return True
