"""The parts of meshcat that the scene uses: its geometry, its commands and where its viewer lies.

Importing any of it also imports its server, which is never started here, and with that a module of pyzmq that warns of its
own age.
"""

from __future__ import annotations

import warnings
from pathlib import Path

from ...ros.sim.defer_sigint import defer_sigint

with defer_sigint(), warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)
    import meshcat
    from meshcat import geometry
    from meshcat.animation import Animation, AnimationClip, AnimationTrack
    from meshcat.commands import Delete, SetAnimation, SetObject, SetProperty, SetTransform
    from meshcat.path import Path as ScenePath

VIEWER = Path(meshcat.__file__).with_name("viewer") / "dist"

__all__ = [
    "VIEWER",
    "Animation",
    "AnimationClip",
    "AnimationTrack",
    "Delete",
    "ScenePath",
    "SetAnimation",
    "SetObject",
    "SetProperty",
    "SetTransform",
    "geometry",
]
