"""For all tests, those of the pages too: a learner's points are kept in no file, so that no run depends on an earlier one."""

import os

os.environ["TURTLE_LESSON_PROGRESS"] = "off"
