"""Loads the plugin that makes a test of each seed, and has the tests find the package's modules."""

import sys
from pathlib import Path

pytest_plugins = ["turtle_lesson.experiments.pytest_plugin"]

sys.path.insert(0, str(Path(__file__).parent / "src" / "patrol"))
