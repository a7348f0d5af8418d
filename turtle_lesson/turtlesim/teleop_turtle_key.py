"""`ros2 run turtlesim turtle_teleop_key`: says what to use instead, since a program in a notebook has no keyboard."""

from __future__ import annotations

import sys

TEXT = (
    "turtle_teleop_key reads the keys of its terminal, and in a notebook a program has none. "
    "lesson.teleop() drives the turtle with the arrow keys or a stick."
)


def main() -> None:
    """Say so, and end."""
    sys.exit(TEXT)
