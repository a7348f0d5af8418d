"""Driving by hand: a stick and keys in the browser, velocities on a topic."""

from __future__ import annotations

import math
from contextlib import suppress

import traitlets
from geometry_msgs.msg import Twist
from rclpy.timer import Timer

from ...ros.stdlib.clocks import real_monotonic
from ..words import number, within
from .backend import LazyPublisher, Link, let_time_go_on
from .live_widget import LiveWidget

PERIOD = 0.1
"""Seconds of robot time between two velocities while the stick is held."""

SIGN_OF_LIFE = 0.3
"""Seconds of real time after which a stick that says nothing counts as let go: the dead man's switch."""


class Teleop(LiveWidget):
    """Publishes a Twist ten times a second while the stick is held, and one with zeros when it is let go.

    While a program of the world reads keys, those that are pressed on the stick go to that program instead.

    The period is counted on the robot's clock, as every node's timer is; whether somebody still holds the stick is
    counted in real time, since a person does.
    """

    SCRIPTS = ("dom", "small", "teleop")
    STYLES = ("base", "small", "teleop")
    RATE = 10.0

    topic = traitlets.Unicode().tag(sync=True)
    limits = traitlets.Dict({"forward": 2.0, "turn": 2.0}).tag(sync=True)
    """The speeds of a stick that is pushed all the way: "forward" in m/s, "turn" in rad/s."""
    stick = traitlets.Dict({"forward": 0.0, "turn": 0.0, "held": False}).tag(sync=True)
    """Where the stick is, from -1 to 1 (turn: to the left), and whether somebody holds it."""
    sent = traitlets.Dict({"linear": 0.0, "angular": 0.0, "count": 0}).tag(sync=True)
    """The newest velocity on the topic, m/s and rad/s, and how many there were."""
    program = traitlets.Unicode().tag(sync=True)
    """The program that reads the keys that are pressed here; "" if they drive."""
    unheard = traitlets.Unicode().tag(sync=True)
    """Why no node hears it; "" if one does."""

    def __init__(self, backend: Link, topic: str) -> None:
        if not isinstance(topic, str) or not topic:
            raise ValueError(f'the topic to drive on must be a name such as "/turtle1/cmd_vel", got {topic!r}')
        name = backend.node.resolve_topic_name(topic)
        self._publisher = LazyPublisher(backend, name, Twist, "geometry_msgs/msg/Twist")
        self._timer: Timer | None = None
        self._last_sign = -math.inf
        super().__init__(backend, topic=name)
        if backend.keyboard is not None:
            backend.keyboard.has_keys = True
        self.tick()

    def do_drive(self, forward: float, turn: float) -> None:
        """The stick is held, and is here: both from -1 to 1, turning to the left positive."""
        place = {"forward": within("stick's forward", forward, -1, 1), "turn": within("stick's turn", turn, -1, 1)}
        self._last_sign = real_monotonic()
        changed = place != {name: self.stick[name] for name in place}
        self.stick = {**place, "held": True}
        if self._timer is None:
            self.words = f"Driving on {self.topic}."
            self._timer = self.backend.node.create_timer(PERIOD, self._drive)
            self._publish()
            let_time_go_on(self.backend)
        elif changed and not any(place.values()):
            self._publish()

    def do_release(self) -> None:
        """The stick was let go: stop."""
        if self._timer is not None:
            self._stop("Stopped.")

    def do_key(self, key: str, down: bool) -> None:
        """A key, by the browser's name for it, was pressed or let go of: pass it on to the program that reads keys."""
        keyboard = self.backend.keyboard
        if keyboard is None or not keyboard.reader:
            return
        with suppress(ValueError):  # browsers know many keys that no program asks for
            keyboard.press(key, down)
        self.words = f"Keys go to {keyboard.reader}."
        let_time_go_on(self.backend)

    def do_stop(self) -> None:
        """Send zeros, whatever drives."""
        self._stop("Stopped.")

    def do_limits(self, **speeds: float) -> None:
        """Set the highest speeds: forward (m/s), turn (rad/s)."""
        for name, value in speeds.items():
            if name not in self.limits:
                raise ValueError(f"A highest speed is one of forward and turn, got {name}.")
            self.limits = {**self.limits, name: within(f"highest speed ({name})", value, 0.01, 10)}

    def tick(self) -> None:
        self._watch()
        if self.backend.keyboard is not None:
            self.program = self.backend.keyboard.reader
        self._publisher.flush()
        if self.due("listeners", 2):
            self.unheard = self._publisher.why_unheard()

    def left(self) -> None:
        self.do_release()
        self._publisher.close()

    def _drive(self) -> None:
        self._watch()
        if self._timer is not None:
            self._publish()

    def _watch(self) -> None:
        if self._timer is not None and real_monotonic() - self._last_sign > SIGN_OF_LIFE:
            self._stop(f"Stopped: no sign of the stick for {SIGN_OF_LIFE} s.")

    def _stop(self, words: str) -> None:
        if self._timer is not None:
            self.backend.node.destroy_timer(self._timer)
            self._timer = None
        self.stick = {"forward": 0.0, "turn": 0.0, "held": False}
        self.words = words
        self._publish()

    def _publish(self) -> None:
        message = self._publisher.message_class()
        message.linear.x = self.stick["forward"] * self.limits["forward"]
        message.angular.z = self.stick["turn"] * self.limits["turn"]
        self._publisher.publish(message)
        self.sent = {"linear": message.linear.x, "angular": message.angular.z, "count": self.sent["count"] + 1}

    def _text(self) -> str:
        most = f"at most {number(self.limits['forward'])} m/s and {number(self.limits['turn'])} rad/s"
        last = "nothing sent yet"
        if self.sent["count"]:
            last = f"last sent {number(self.sent['linear'])} m/s and {number(self.sent['angular'])} rad/s"
        keys = f"Keys go to {self.program}. " if self.program else ""
        return f"Teleop on {self.topic}, {most}: {last}. {keys}{self._publisher.why_unheard()}".strip()
