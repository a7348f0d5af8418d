"""The scene as one page of HTML, which needs neither kernel nor network: the widget's own view, with its state inside."""

from __future__ import annotations

import base64
import html
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .live_widget import script, styles

if TYPE_CHECKING:
    from .scene import Scene

PARTS = ("stage", "trail", "tip", "scan", "obstacles", "goal")
HEIGHT = 560
"""Pixels in a notebook."""

# The page may run what is written in it and show pictures that it made, and nothing else: no address is ever asked.
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:"
)

FRAME = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<title>{title}</title>
<style>
{css}
</style>
</head>
<body>
<main id="page"></main>
<script type="application/json" id="state">
{state}
</script>
<script>
{script}
</script>
</body>
</html>
"""


class ScenePage:
    """A page of HTML, and the same in words. `html` is the page, `text` says what it shows."""

    def __init__(self, title: str, text: str, state: dict[str, Any]) -> None:
        from .scene import SCRIPTS

        self.text = text
        self.html = FRAME.format(
            policy=POLICY,
            title=html.escape(title),
            css=styles("base", "scene", "scene_page"),
            state=json.dumps(_written(state), sort_keys=True).replace("<", "\\u003c"),
            script=script(*SCRIPTS, "scene_page"),
        )

    def save(self, path: str | Path) -> Path:
        """Write the page to a file that any browser opens; returns the path."""
        path = Path(path)
        path.write_text(self.html, encoding="utf-8")
        return path

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        """The page in a frame of its own, which the notebook's styles do not reach."""
        frame = 'style="width: 100%; max-width: 1100px; border: 0"'
        return (
            f'<iframe title="{html.escape(self.text)}" {frame} height="{HEIGHT}" allow="fullscreen" '
            f'srcdoc="{html.escape(self.html)}"></iframe>'
        )


def snapshot_page(scene: Scene) -> ScenePage:
    """The scene as it is now, as a page."""
    scene.redraw()
    return ScenePage("3-D scene", f"Snapshot of the {scene.text()}", state_of(scene))


def state_of(scene: Scene) -> dict[str, Any]:
    """What a view needs to know."""
    state: dict[str, Any] = {name: getattr(scene, name) for name in ("bundle", "turtle", *PARTS)}
    return {**state, "description": scene.description, "words": "", "ended": False}


def _written(value: Any) -> Any:
    """Bytes as text that JavaScript's `atob` reads, marked as such."""
    if isinstance(value, bytes):
        return {"base64": base64.b64encode(value).decode("ascii")}
    if isinstance(value, list):
        return [_written(each) for each in value]
    if isinstance(value, dict):
        return {name: _written(each) for name, each in value.items()}
    return value
