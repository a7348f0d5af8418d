"""What lives on a page: pads, dashboards, forms and scenes that show a running system and act on it.

Every widget knows the system through its `Backend` alone: a hidden node, topics, services, parameters, the graph, and a
clock where there is one to turn. All that a widget does happens in the notebook's own event loop (see `loop`).
"""

from ...ros.sim.defer_sigint import defer_sigint

with defer_sigint():
    import anywidget  # noqa: F401
