"""What views ask for happens in the notebook's thread, wherever the message arrives; what is shown is shown in frames."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest
import traitlets

from turtle_lesson.lab.widgets import backend
from turtle_lesson.lab.widgets.backend import Link, Loop
from turtle_lesson.lab.widgets.live_widget import LiveWidget


def test_an_order_that_arrives_in_another_thread_is_carried_out_in_the_notebooks() -> None:
    async def cell() -> list[int]:
        loop, done = Loop(), []
        threading.Thread(target=loop.soon, args=(lambda: done.append(threading.get_ident()),)).start()
        while not done:
            await asyncio.sleep(0.001)
        return done

    assert asyncio.run(cell()) == [threading.get_ident()]


class SteppedLoop:
    """An event loop whose time this test lets pass."""

    def __init__(self) -> None:
        self.now = 0.0
        self.timers: list[SimpleNamespace] = []

    def time(self) -> float:
        return self.now

    def call_later(self, delay: float, action: Callable[..., object], *arguments: object) -> SimpleNamespace:
        return self.call_at(self.now + delay, action, *arguments)

    def call_at(self, due: float, action: Callable[..., object], *arguments: object) -> SimpleNamespace:
        self.timers.append(SimpleNamespace(when=lambda: due, call=lambda: action(*arguments)))
        return self.timers[-1]

    def run(self, seconds: float) -> None:
        end = self.now + seconds
        while self.timers and self.timers[0].when() <= end:
            timer = self.timers.pop(0)
            self.now = timer.when()
            with suppress(ZeroDivisionError):
                timer.call()
        self.now = end


@pytest.fixture
def stepped(monkeypatch: pytest.MonkeyPatch) -> SteppedLoop:
    loop = SteppedLoop()
    monkeypatch.setattr(backend.asyncio, "get_running_loop", lambda: loop)
    return loop


def test_all_widgets_of_a_system_tick_in_the_same_frames(stepped: SteppedLoop) -> None:
    loop, ticks = Loop(), {"map": list[float](), "form": list[float]()}
    loop.every(1 / 30, lambda: ticks["map"].append(stepped.now))
    stop = loop.every(1 / 10, lambda: ticks["form"].append(stepped.now))
    stepped.run(1.0)
    assert len(ticks["map"]) in (29, 30) and len(ticks["form"]) in (9, 10)
    assert set(ticks["form"]) < set(ticks["map"])
    stop()
    stepped.run(1.0)
    assert len(ticks["form"]) in (9, 10) and len(ticks["map"]) in (59, 60)


def test_frames_that_cost_much_come_less_often(stepped: SteppedLoop, monkeypatch: pytest.MonkeyPatch) -> None:
    used = cost = 0.0
    monkeypatch.setattr(backend, "thread_time", lambda: used)
    loop, ticks = Loop(), list[float]()

    def draw() -> None:
        nonlocal used
        used += cost
        ticks.append(stepped.now)

    loop.every(1 / 30, draw)
    for each, rate in ((0.001, 30), (0.002, 17.5), (0.1, 10), (0.001, 30)):
        cost = each
        stepped.run(30)  # until the average follows
        ticks.clear()
        stepped.run(2)
        assert len(ticks) / 2 == pytest.approx(rate, abs=1)


def test_an_action_that_raises_does_not_end_the_frames(stepped: SteppedLoop) -> None:
    loop, ticks = Loop(), list[float]()
    loop.every(1 / 30, lambda: ticks.append(stepped.now))
    loop.every(1 / 30, lambda: 1 / 0)
    stepped.run(1.0)
    assert len(ticks) in (29, 30)


class Ticks(LiveWidget):
    """Counts its ticks, as a number and as bytes."""

    SCRIPTS, STYLES = ("dom",), ("base",)
    count = traitlets.Int().tag(sync=True)
    blobs = traitlets.List(traitlets.Bytes()).tag(sync=True)

    def tick(self) -> None:
        self.count += 1
        self.blobs = [b"", b"%d of %s" % (self.count, self.model_id.encode())]

    def text(self) -> str:
        return f"{self.count} ticks"


class Page:
    """What a browser's page gets for the widgets whose views it has, and hands out as `handOut` does (js/dom.js)."""

    def __init__(self, name: str, *widgets: Ticks) -> None:
        self.messages = 0
        self.shown: dict[str, list[tuple[int, bytes]]] = {widget.model_id: [] for widget in widgets}
        for widget in widgets:
            widget.comm.publish_msg = partial(self.hear, widget.model_id)
            widget._order(widget, {"do": "open", "view": name}, [])
        self.messages = 0

    def hear(self, model: str, kind: str, *, data: Any, buffers: Any, **rest: object) -> None:
        if kind != "comm_msg":  # but that it is closed
            return
        self.messages += 1
        joined = data["content"]["messages"] if data["method"] == "custom" else [[model, data, 0, len(buffers)]]
        for each, update, first, end in joined:
            assert (update["method"], update["buffer_paths"]) == ("update", [["blobs", 0], ["blobs", 1]])
            self.shown[each].append((update["state"]["count"], buffers[first:end][1]))


def test_the_messages_of_a_frame_travel_together_to_the_page_that_shows_their_widgets(stepped: SteppedLoop) -> None:
    loop = Loop()
    first, second, alone = widgets = [Ticks(Link(SimpleNamespace(loop=loop, ended=False))) for _ in range(3)]
    page, other_page = Page("page/1", first, second), Page("other/1", alone)
    stepped.run(1.0)
    assert page.messages == other_page.messages == first.count - 1
    for widget in widgets:
        shown = (page if widget is not alone else other_page).shown[widget.model_id]
        assert shown == [(at, b"%d of %s" % (at, widget.model_id.encode())) for at in range(1, widget.count + 1)]
    second.close()
    stepped.run(1.0)
    assert len(page.shown[first.model_id]) == first.count
    first.close(), alone.close()
