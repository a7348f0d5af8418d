"""What all widgets have in common: their files, their views and ticks, their orders, their text and their picture."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from typing import Any, ClassVar

import anywidget
import numpy as np
import traitlets
from ipywidgets import CallbackDispatcher
from numpy.typing import ArrayLike

from ...ros.stdlib.clocks import real_monotonic
from ..drawing import Picture
from .backend import Link, Message

KEPT = 20
"""Of the widgets whose system has ended and that no page shows, so many can still be shown: a page that is run as a whole
shows all of its widgets only after its last cell. Older ones are closed."""

PATIENCE = 150.0
"""Seconds without a sign of life after which a view counts as gone: its window was closed, or its network broke.

A view gives one every 20 s, and a browser may hold up those of a hidden window for a minute.
"""

_LAST = vars(traitlets.HasTraits()).keys() | {"is_made", "_last_words"}
"""The attributes that a closed widget still needs: those of traitlets, and two of its own."""

_ended: list[LiveWidget] = []


def pack(numbers: ArrayLike) -> bytes:
    """Numbers in their order as little-endian 32-bit floats; JavaScript reads them as a Float32Array."""
    return np.ascontiguousarray(numbers, dtype="<f4").tobytes()


@cache
def source(kind: str, *names: str) -> str:
    """The files of a widget one after another: its scripts ("js"), as one module, or its style sheets ("css")."""
    return "\n".join((Path(__file__).with_name("js") / f"{name}.{kind}").read_text(encoding="utf-8") for name in names)


class LiveWidget(anywidget.AnyWidget):
    """A widget that shows a running system and acts on it.

    The browser sends orders (`{"do": "goal", "x": …}`), each of which is a method `do_goal(x=…)` here; state goes the other
    way, as traits. While at least one view is open, `tick()` is called 30 times a second to bring the traits up to date, for
    all widgets of a system in one go.

    When its system ends, it stays on the page as it is and says what it said last, but lets go of the system.
    """

    _esm = traitlets.Unicode().tag(sync=True)
    _css = traitlets.Unicode().tag(sync=True)
    _anywidget_id = traitlets.Unicode().tag(sync=True)

    words = traitlets.Unicode().tag(sync=True)
    """What has just happened, in words: a screen reader speaks it."""
    ended = traitlets.Bool(False).tag(sync=True)
    """The world that it showed is gone."""

    SCRIPTS: ClassVar[tuple[str, ...]]
    STYLES: ClassVar[tuple[str, ...]]
    """Its files in `js`."""
    RATE: ClassVar[float] = 30.0
    """Ticks a second, at most."""
    is_made = False
    _last_words: str | None = None
    """What it said last, once its system has ended."""

    def __init__(self, backend: Link, **traits: Any) -> None:
        self.backend = backend
        self._esm, self._css = source("js", *self.SCRIPTS), source("css", *self.STYLES)
        self._paces: dict[str, float] = {}
        self._shown: dict[str, object] = {}
        self._views: dict[str, float] = {}  # when each gave its last sign of life
        self._is_open = False
        self._stop_ticking: Callable[[], object] = lambda: None
        super().__init__(**traits)
        self.on_msg(partial(backend.loop.soon, self._order))
        self.is_made = True

    @traitlets.default("_anywidget_id")
    def _class_name(self) -> str:
        return f"{type(self).__module__}.{type(self).__qualname__}"

    # -- for subclasses to override ------------------------------------------------------------------------------------

    def tick(self) -> None:
        """Bring the traits up to date."""

    def opened(self) -> None:
        """The first view was opened: begin to listen."""

    def closed(self) -> None:
        """The last view was closed: stop listening."""
        self.left()

    def left(self) -> None:
        """Let go of publishers, clients and the like: the widget, or its system, is taken away. May be called again."""

    def _text(self) -> str:
        """The state of the running system in one exact sentence or two."""
        raise NotImplementedError

    def _picture(self) -> Picture | None:
        """The running system as a picture."""
        return None

    def text(self) -> str:
        """The state in one exact sentence or two, after the system's end the last one: what print shows and nbval compares."""
        return self._text() if self._last_words is None else self._last_words

    def picture(self) -> Picture | None:
        """What to show where there is no kernel; nothing after the system's end."""
        return self._picture() if self._last_words is None else None

    # -- ticks and views -----------------------------------------------------------------------------------------------

    def due(self, what: str, hertz: float) -> bool:
        """Whether it is time again for what is done so many times a second of real time at most."""
        now = real_monotonic()
        if now < self._paces.get(what, -1.0):
            return False
        self._paces[what] = now + 1 / hertz
        return True

    def is_new(self, what: str, value: object) -> bool:
        """Whether a value has changed since it was last asked about, so that it has to be shown again."""
        changed = what not in self._shown or self._shown[what] != value
        self._shown[what] = value
        return changed

    @property
    def is_seen(self) -> bool:
        """Whether a page shows the widget."""
        limit = real_monotonic() - PATIENCE
        return any(time > limit for time in self._views.values())

    def _send(self, msg: dict[str, Any], buffers: list[bytes] | None = None) -> None:
        """Send a message to the views; in a frame, have it wait for those of the other widgets."""
        outbox = self.backend.loop.outbox
        if outbox is None:
            super()._send(msg, buffers)
        else:
            outbox.append((self, msg, buffers or []))

    @staticmethod
    def send_together(outbox: list[Message]) -> None:
        """Send messages of several widgets. Of those that are on the same pages, the first one's views hand them out there."""
        by_pages: dict[frozenset[str], list[Message]] = {}
        for message in outbox:
            if message[0].comm is not None:  # or it was closed since then
                # a view is named by its page, a slash, and a name of its own
                pages = frozenset(view.partition("/")[0] for view in message[0]._views)
                by_pages.setdefault(pages, []).append(message)
        for messages in by_pages.values():
            first, data, buffers = messages[0]
            if len(messages) == 1:
                first._send(data, buffers)
                continue
            parts, joined = list[Any](), list[bytes]()
            for widget, data, buffers in messages:
                parts.append([widget.model_id, data, len(joined), len(joined) + len(buffers)])
                joined += buffers
            first.send({"messages": parts}, joined)

    def _tick(self) -> None:
        if self.backend.ended:
            self.end()
            return
        try:
            with self.hold_sync():
                self.tick()
        except Exception as error:  # or the widget would stand still without a word
            self.words = f"This widget could not be updated: {error}"

    def _beat(self) -> None:
        """Tick while a view gives signs of life."""
        if not self.is_seen and not self.backend.ended:
            self._views.clear()
            self._rest()
        else:
            self._tick()

    def _rest(self) -> None:
        """No view is there any more."""
        if self._is_open:
            self._is_open = False
            self._stop_ticking()
            self.closed()

    def set_state(self, sync_data: dict[str, Any]) -> None:
        """Take no state from a page: what a widget shows is Python's alone to say, and a page sends orders."""

    def _order(self, widget: object, content: Any, buffers: object) -> None:
        """Carry out what a view asks for. What it cannot understand it says in `words`: nothing from outside may break it."""
        if not isinstance(content, dict):
            return
        order = dict(content)
        name, view = order.pop("do", None), str(order.pop("view", ""))
        if self.backend.ended:
            self.end()
        if name in ("open", "alive"):
            self._views[view] = real_monotonic()
            if not self.backend.ended:
                if not self._is_open:
                    self._is_open = True
                    self.opened()
                    self._stop_ticking = self.backend.loop.every(1 / self.RATE, self._beat)
                self._tick()
        elif name == "close":
            if self._views.pop(view, None) is not None and not self._views:
                self._rest()
        elif not self.backend.ended:
            self._carry_out(name, order)

    def _carry_out(self, name: object, order: dict[str, Any]) -> None:
        if not isinstance(name, str) or not hasattr(self, f"do_{name}"):
            self.words = f"This widget cannot {name!r}."
            return
        try:
            getattr(self, f"do_{name}")(**order)
        except Exception as error:
            self.words = f"{error}"
        self._tick()

    def end(self) -> None:
        """The system ends now: show its last state from now on."""
        if not self.ended and self.comm is not None:
            with suppress(Exception):  # a real ROS 2 that a signal has shut down answers nothing any more
                self.tick()
            self._let_go()
            self.ended = True
            put_aside(self)

    def add_traits(self, **traits: Any) -> None:
        """Add those traits that the class does not have: anywidget adds its own to each widget, which makes a class of each."""
        new = {name: trait for name, trait in traits.items() if not self.has_trait(name)}
        if new:
            super().add_traits(**new)

    def close(self) -> None:
        """Take the widget away: its views close, it listens no more, and lets go of what it has."""
        if self.is_made and self.comm is not None:  # traitlets' __del__ closes what was refused while it was made, too
            self._let_go()
            layout = self.layout
            super().close()
            layout.close()
            self._forget()

    def _forget(self) -> None:
        """Keep the last words only: a notebook's `Out` holds each widget that was shown for as long as its kernel lives."""
        values = vars(self)["_trait_values"]
        self._trait_values = {name: values[name] for name in ("comm", "layout", "words", "ended") if name in values}
        for name in vars(self).keys() - _LAST:
            delattr(self, name)
        self._msg_callbacks = CallbackDispatcher()

    def _let_go(self) -> None:
        """Keep the last words, and nothing of the system."""
        for step in (self._rest, self.left):
            with suppress(Exception):  # what has broken down must not keep the next system from starting
                step()
        last = "This widget has ended."
        with suppress(Exception):
            last = self.text()
        self.backend.cut()
        self._last_words = last

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


def put_aside(widget: LiveWidget) -> None:
    """Keep a widget that will show nothing new as long as a page shows it, or may do so soon; then it is closed."""
    alive = (each for each in (*_ended, widget) if each.comm is not None)  # some are closed by hand
    _ended[:] = dict.fromkeys(alive)  # one is here already if an interrupt stopped this the last time
    unseen = [each for each in _ended if not each.is_seen]
    for each in unseen[:-KEPT]:
        each.close()
