"""What all widgets have in common: they outlive their world on the page, and nothing that a page sends breaks them."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator
from inspect import signature
from pathlib import Path
from typing import Any

import comm
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ipywidgets.widgets import widget as registry

from turtle_lesson import Lesson, start
from turtle_lesson.lab.widgets import live_widget
from turtle_lesson.lab.widgets.live_widget import KEPT, LiveWidget

LAUNCH = ("robot_controller", "start_system.launch.py")


@pytest.fixture(autouse=True)
def widgets_of_this_test_only() -> Iterator[None]:
    """Other tests leave widgets open, as pages do."""
    before = set(registry._instances)
    kept, live_widget._ended[:] = [*live_widget._ended], []
    yield
    live_widget._ended[:] = kept
    for name in set(registry._instances) - before:
        registry._instances[name].close() if name in registry._instances else None


def message(widget: LiveWidget, **data: Any) -> None:
    """Let a message come from the page, as Jupyter hands it to the widget."""
    widget.comm.handle_msg({"content": {"data": data}, "buffers": []})


def order(widget: LiveWidget, name: str, /, **content: Any) -> None:
    message(widget, method="custom", content={"do": name, "view": "v", **content})


def all_widgets(lesson: Lesson) -> list[Any]:
    """One of each kind. The lesson's system must run."""
    shown = [lesson.dashboard(), lesson.goal_pad(), lesson.scene(), lesson.teleop(), lesson.parameters("/navigator")]
    shown += [lesson.form("/turtle1/cmd_vel"), lesson.form("/navigate_to"), lesson.live_plot("/turtle1/pose/x")]
    return [*shown, lesson.predict("place", "Where will it be?", on_map=True).widget]


def running() -> Lesson:
    lesson = start()
    lesson.launch(*LAUNCH)
    lesson.run(1)
    return lesson


def test_all_widgets_of_a_system_share_the_frames_of_one_loop() -> None:
    lesson = running()
    *shown, _question = all_widgets(lesson)
    assert len({id(widget.backend.loop) for widget in shown}) == 1


def kept_of_a_world(path: Path) -> tuple[list[Any], list[weakref.ref[Any]]]:
    """What a page keeps of a world in the middle of its work (Jupyter's `Out`, and its views), and that world, weakly."""
    lesson = running()
    dashboard, pad, scene, teleop, parameters, twist, request, plot, question = shown = all_widgets(lesson)
    for widget in shown:
        order(widget, "open")
    order(dashboard, "goal", x=9.0, y=9.0, theta=0.0)
    order(pad, "goal", x=2.0, y=2.0, theta=0.0)
    order(request, "call")
    order(twist, "repeat")
    order(teleop, "drive", forward=1.0, turn=0.0)
    order(question, "guess", value=[1.0, 2.0])
    lesson.run(0.5)
    order(parameters, "set", **{"name": "linear_speed", "value": "1.5"})
    bag = lesson.record(path / "bag")
    pictures = [lesson.plot_path(), lesson.plot_scan(), lesson.plot_graph(), lesson.plot_timeline()]
    pages = [scene.snapshot(), scene.animation(), plot.picture()]
    kept = [*shown, *pictures, *pages, bag, lesson.launch(*LAUNCH), lesson.check("counter")]
    world = lesson._world
    return kept, [
        weakref.ref(each) for each in (world, world.sim, world.graph, lesson, lesson._recording, *world.processes)
    ]


def test_nothing_that_a_page_keeps_keeps_its_world_alive(tmp_path: Path) -> None:
    kept, world = kept_of_a_world(tmp_path)
    start()
    gc.collect()
    assert [each() for each in world if each() is not None] == []
    assert all(repr(each) for each in kept)
    assert all(each.ended for each in kept if isinstance(each, LiveWidget) and not hasattr(each, "guess"))


def test_an_ended_widget_stays_as_it_was() -> None:
    lesson = running()
    scene, pad = lesson.scene(), lesson.goal_pad()
    order(pad, "goal", x=8.0, y=8.0, theta=0.0)
    lesson.run(5.0)  # in a cell, in which no widget ticks
    start()
    assert pad.ended and pad.goals[0]["state"] == "reached"
    said = f"Goal pad at {lesson.now:.2f} s of robot time: the turtle is at (7.98, 7.97) m"
    assert repr(pad).startswith(said) and pad.text() == repr(pad)
    assert set(pad._repr_mimebundle_()[0]) == {"text/plain", "application/vnd.jupyter.widget-view+json"}
    assert "the turtle is at (7.98, 7.97) m" in scene.snapshot().text
    with pytest.raises(RuntimeError, match="this widget has ended, and its system with it: run the cell again"):
        scene.animation()
    assert lesson.goal_pad() is pad, "the old lesson still shows it"


def test_a_teleop_that_is_held_when_its_world_ends_stops() -> None:
    teleop = running().teleop()
    order(teleop, "drive", forward=1.0, turn=0.0)
    start()
    assert not teleop.stick["held"] and "last sent 0.00 m/s and 0.00 rad/s" in repr(teleop)


def test_a_closed_widget_leaves_nothing_and_can_be_shown_again() -> None:
    lesson = running()
    before = len(registry._instances), len(comm.get_comm_manager().comms)
    for widget in all_widgets(lesson):
        order(widget, "open")
        widget.close()
        widget.close()
        assert repr(widget)
    assert (len(registry._instances), len(comm.get_comm_manager().comms)) == before
    again = lesson.dashboard()
    assert again.comm is not None and again is lesson.dashboard()


def test_widgets_of_ended_worlds_are_closed_when_no_page_shows_them(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = 0.0
    monkeypatch.setattr(live_widget, "real_monotonic", lambda: clock)
    ended = [start().teleop() for _ in range(KEPT)]
    for late in ended[1:3]:
        order(late, "alive")  # a page still shows these
    order(ended[2], "close")
    ended += [start().teleop() for _ in range(4)]
    start()
    assert [widget.comm is None for widget in ended] == [True, False, True, True, *[False] * KEPT]
    clock = live_widget.PATIENCE + 1.0  # that page is gone, and has not said so
    start().teleop()
    start()
    assert ended[1].comm is None


def test_a_widget_is_kept_once_if_an_interrupt_has_it_put_aside_again() -> None:
    first = start().teleop()
    start()
    live_widget.put_aside(first)
    ended = [start().teleop() for _ in range(KEPT + 2)]
    start()
    assert first.comm is None and ended[-1].comm is not None


def test_a_question_that_begins_anew_has_one_widget_in_the_end() -> None:
    lesson = start()
    before = len(registry._instances)
    for turn in range(KEPT + 10):
        for _ in range(2):
            shown = lesson.predict("far", f"How far, in turn {turn}?", unit="m").widget
        assert shown is lesson.predict("far", f"How far, in turn {turn}?", unit="m").widget
    assert len(registry._instances) - before == 2 * (KEPT + 1)  # each has a layout, too


def test_a_question_whose_widget_was_closed_can_be_asked_anew() -> None:
    lesson = start()
    lesson.predict("far", "How far?", unit="m").widget.close()
    assert repr(lesson.predict("far", "How far now?", unit="m")) == "How far now? – no guess yet."


# -- what a page sends ---------------------------------------------------------------------------------------------------

LEAVES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
NONSENSE = st.recursive(
    LEAVES,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@pytest.fixture
def shown() -> list[Any]:
    return all_widgets(running())


def check_they_work(shown: list[Any]) -> None:
    """The next orders are carried out, all of them can be drawn, and closed."""
    dashboard, pad, scene, teleop, parameters, twist, request, _, question = shown
    for widget in shown:
        order(widget, "open")
        assert repr(widget) and widget._repr_mimebundle_() and not widget.words.startswith("This widget could not")
    order(dashboard, "goal", x=2.0, y=3.0, theta=0.0)
    order(pad, "world", **{"name": "three pillars"})
    order(teleop, "drive", forward=1.0, turn=0.0)
    order(teleop, "stop")
    order(parameters, "ask")
    order(parameters, "set", **{"name": "linear_speed", "value": "1.25"})
    for form in (twist, request):
        order(form, "reset")
    order(twist, "publish")
    order(question, "guess", value=[1.0, 2.0])
    assert (dashboard.goals[-1]["x"], dashboard.goals[-1]["y"], len(pad.obstacles)) == (2.0, 3.0, 3)
    assert (teleop.words, twist.words) == ("Stopped.", "Published on /turtle1/cmd_vel.")
    assert "linear_speed = 1.25" in repr(parameters) and repr(question).endswith("(1.00, 2.00) m.")
    assert "3 obstacles" in scene.snapshot().text
    for widget in shown:
        widget.close()
        assert widget.comm is None


def test_no_state_that_a_page_sends_is_taken(shown: list[Any]) -> None:
    @given(data=st.data())
    def send(data: st.DataObject) -> None:
        for widget in shown:
            before = widget.get_state()
            message(widget, method="update", state=dict.fromkeys(before, data.draw(NONSENSE)))
            assert widget.get_state() == before

    message(shown[3], method="update", state={"sent": {}})
    assert "last sent" not in repr(shown[3])
    send()
    check_they_work(shown)


def test_no_order_that_a_page_sends_breaks_a_widget(shown: list[Any]) -> None:
    @given(data=st.data())
    def send(data: st.DataObject) -> None:
        for widget in shown:
            names = [each for each in dir(widget) if each.startswith("do_")]
            method = data.draw(st.sampled_from([*names, "", "do_close", "do__order"]))
            parts = signature(getattr(widget, method)).parameters if method in names else ()
            content = {
                name: data.draw(NONSENSE) for name in [*parts, *data.draw(st.lists(st.text(max_size=5), max_size=1))]
            }
            order(widget, method.removeprefix("do_"), **content)
            message(widget, method="custom", content=data.draw(NONSENSE))
            assert repr(widget)

    send()
    check_they_work(shown)


def test_a_thousand_orders_at_once(shown: list[Any]) -> None:
    """`tests/soak/worlds.py` sends ten thousand to a kernel."""
    teleop = shown[3]
    for turn in range(1000):
        order(teleop, "drive", forward=turn / 1000, turn=0.0)
    assert teleop.stick == {"forward": 0.999, "turn": 0.0, "held": True}
    check_they_work(shown)
