"""Whether `import launch` finds the simulation's package: a real ROS 2, or something else, may come first."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

from .errors import LaunchError

SITE = Path(__file__).resolve().parents[1] / "site"


def check() -> None:
    """Make the simulation's packages importable, after all others.

    Raises:
        LaunchError: if another package named launch or launch_ros hides the simulation's.
    """
    if str(SITE) not in sys.path:
        sys.path.append(str(SITE))
    for name in ("launch", "launch_ros", "launch_xml", "launch_yaml"):
        spec = find_spec(name)
        if spec is None or not spec.origin or SITE not in Path(spec.origin).resolve().parents:
            raise LaunchError(
                f"`import {name}` finds {spec.origin if spec else 'nothing'}, not the simulation's package",
                None,
                "If a real ROS 2 is sourced, start Jupyter from a terminal without it; if pip installed it, "
                f"pip uninstall {name}.",
            )
