"""What all widgets that draw have in common: the views that show them, their ticks, their text and their picture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import anywidget
import traitlets

from ..picture import Picture
from .views import Views

if TYPE_CHECKING:
    from .station import Station

FOLDER = Path(__file__).with_name("js")


def script(*names: str) -> str:
    """The JavaScript of a widget: its files one after another, as one module."""
    return "\n".join((FOLDER / f"{name}.js").read_text(encoding="utf-8") for name in names)


def styles(*names: str) -> str:
    """The style sheets of a widget."""
    return "\n".join((FOLDER / f"{name}.css").read_text(encoding="utf-8") for name in names)


class LiveWidget(anywidget.AnyWidget):
    """A widget that shows a running system and acts on it.

    The browser sends orders (`{"do": "goal", "x": …}`), each of which is a method `do_goal(x=…)` here; state goes the other
    way, as traits. While at least one view is open, `tick()` is called 30 times a second to bring the traits up to date.
    """

    words = traitlets.Unicode().tag(sync=True)
    """What has just happened, in words: a screen reader speaks it."""
    ended = traitlets.Bool(False).tag(sync=True)
    """The world that it showed is gone."""

    RATE: ClassVar[float] = 30.0
    is_made = False

    def __init__(self, station: Station, **traits: Any) -> None:
        self.station = station
        super().__init__(**traits)
        self._views = Views(station.loop, 1 / self.RATE, self._tick, self.opened, self.closed)
        self.on_msg(station.loop.hopping(self._order))
        self.is_made = True

    # -- for the widgets ---------------------------------------------------------------------------------------------

    def tick(self) -> None:
        """Bring the traits up to date."""

    def opened(self) -> None:
        """The first view was opened: begin to listen."""

    def closed(self) -> None:
        """The last view was closed: stop listening."""

    def left(self) -> None:
        """The widget is taken away for good, while its world goes on: let go of publishers, clients and the like."""

    def text(self) -> str:
        """The state in one exact sentence or two: what print shows and nbval compares."""
        raise NotImplementedError

    def picture(self) -> Picture | None:
        """What to show where there is no kernel."""
        return None

    # -- the machinery -------------------------------------------------------------------------------------------------

    def _tick(self) -> None:
        if self.station.ended:
            self._views.clear()
            self.ended = True
            return
        try:
            with self.hold_sync():
                self.tick()
        except Exception as error:  # or the widget would stand still without a word
            self.words = f"This widget could not be updated: {error}"

    def _order(self, widget: object, content: Any, buffers: object) -> None:
        """Carry out what a view asks for. What it cannot understand it says in `words`: nothing from outside may break it."""
        if self.station.ended:
            self.ended = True  # a view that was opened after the end has to be told
        if not isinstance(content, dict) or self.station.ended:
            return
        order = dict(content)
        name = order.pop("do", None)
        view = order.pop("view", "")
        if name in ("open", "alive"):
            self._views.heard(view)
        elif name == "close":
            self._views.gone(view)
        else:
            self._carry_out(name, order)

    def _carry_out(self, name: object, order: dict[str, Any]) -> None:
        method: Callable[..., None] | None = getattr(self, f"do_{name}", None) if isinstance(name, str) else None
        if method is None:
            self.words = f"This widget cannot {name!r}."
            return
        try:
            method(**order)
        except Exception as error:
            self.words = f"{error}"
        self._tick()

    def close(self) -> None:
        """Take the widget away: its views close, it listens no more, and lets go of what it has."""
        if not self.is_made:  # traitlets' __del__ closes what was refused while it was made, too
            return
        self._views.clear()
        if not self.station.ended:
            self.left()
        super().close()

    def __repr__(self) -> str:
        return self.text()

    def _repr_mimebundle_(self, **options: Any) -> Any:
        bundle = super()._repr_mimebundle_(**options)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle or {}, {})
        data = {**data, "text/plain": self.text()}
        picture = self.picture()
        if picture is not None and picture.figure is not None:
            shown, size = picture._repr_mimebundle_()
            data["image/png"] = shown["image/png"]
            metadata = {**metadata, **size}
        return data, metadata
