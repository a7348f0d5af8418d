"""The widgets of a page: goal pad, dashboard, forms, plots, teleoperation and the scene in three dimensions.

A widget sees the system through its `Backend` only: a hidden node, what the recorder heard, and, in the simulation, the
clock. Everything that a widget does happens in the notebook's own event loop (`Loop` in `backend.py`).
"""

from ...ros.sim.defer_sigint import defer_sigint

with defer_sigint():
    import anywidget  # noqa: F401
