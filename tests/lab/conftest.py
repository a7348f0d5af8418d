"""What the lab's tests look at."""

from __future__ import annotations

import pytest

from turtle_lesson import Lesson, start


@pytest.fixture
def lesson() -> Lesson:
    """The whole system, after its first second."""
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    return lesson
