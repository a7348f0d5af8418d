"""The panel with the topics: how often messages come on each, beside how often they should."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import traitlets

from ..recording import NANOSECONDS, OBSTACLE_TOPIC, SCAN_TOPIC, STATUS_TOPIC
from ..system import EVERYWHERE, is_hidden
from ..table import Table
from .ear import Ear
from .frequency import PAUSE, frequency, verdict
from .live_widget import LiveWidget
from .pace import Pace

MOST_ROWS = 12
"""Topics that are shown; each of those without an expected rate costs a subscription while the panel is seen."""
MOST_MESSAGES = 1000


class RatesPanel(LiveWidget):
    """Measures rates, from what the recorder has heard where it hears a topic, by a subscription of its own elsewhere."""

    rates = traitlets.List(traitlets.Dict()).tag(sync=True)
    """A row a topic: "topic", "hertz", "expected" (0: none), a "state" in words, and a "note"."""
    rates_more = traitlets.Int(0).tag(sync=True)
    """How many topics are not shown."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        self._rates_pace, self._topics_pace = Pace(4), Pace(1)
        self._ears: dict[str, Ear] | None = None
        super().__init__(*arguments, **traits)

    def opened(self) -> None:
        """Listen to the topics that nobody hears yet, from the next look at the graph on."""
        super().opened()
        self._ears = {}

    def closed(self) -> None:
        """Listen no more."""
        super().closed()
        for ear in (self._ears or {}).values():
            ear.close()
        self._ears = None

    def tick(self) -> None:
        """Look which topics there are, now and then, and measure."""
        super().tick()
        if self._ears is not None and self._topics_pace.due():
            self._follow_topics(self._ears)
        if self._rates_pace.due():
            self.rates = [*self._expected_rows(), *self._other_rows()]

    def _now(self) -> int:
        return self.station.recorder.origin + round(self.station.now * NANOSECONDS)

    def _expected_rows(self) -> list[dict[str, Any]]:
        recorder = self.station.recorder
        known: list[tuple[str, Table, float]] = [
            (recorder.pose_topic, recorder.poses, 62.5),
            (STATUS_TOPIC, recorder.statuses, 10.0),
            (SCAN_TOPIC, recorder.scans, 5.0),
            (recorder.command_topic, recorder.commands, 10.0),
        ]
        now = self._now()
        rows = []
        for topic, table, expected in known:
            hertz = frequency(table.newest(MOST_MESSAGES)["stamp"], now, PAUSE)
            state = verdict(hertz, expected)
            if topic == recorder.command_topic and state == "silent":
                state = "at rest"  # nobody drives: no command is due
            elif state == "silent" and self.station.now < PAUSE:
                state = "just begun"
            rows.append(_row(topic, hertz, expected, state))
        return rows

    def _other_rows(self) -> list[dict[str, Any]]:
        now, rows = self._now(), []
        worlds = self.station.recorder.worlds
        stamps = {topic: ear.stamps for topic, ear in (self._ears or {}).items()}
        if len(worlds):
            stamps[OBSTACLE_TOPIC] = worlds.newest(MOST_MESSAGES)["stamp"]
        for topic in sorted(stamps):
            hertz = frequency(stamps[topic], now)
            ear = (self._ears or {}).get(topic)
            state = "not heard" if ear is not None and ear.trouble else "quiet" if hertz == 0 else "heard"
            rows.append(_row(topic, hertz, 0.0, state, ear.trouble if ear is not None else ""))
        return rows

    def _follow_topics(self, ears: dict[str, Ear]) -> None:
        """Have an ear at each topic that somebody publishes and the recorder does not hear."""
        node, recorder = self.station.node, self.station.recorder
        heard = {recorder.pose_topic, recorder.command_topic, STATUS_TOPIC, SCAN_TOPIC, OBSTACLE_TOPIC}
        found = {
            topic: types[0]
            for topic, types in sorted(node.get_topic_names_and_types())
            if topic not in heard | EVERYWHERE and not is_hidden(topic) and node.count_publishers(topic)
        }
        shown = dict(list(found.items())[: MOST_ROWS - len(heard)])
        self.rates_more = len(found) - len(shown)
        for topic in [topic for topic in ears if topic not in shown]:
            ears.pop(topic).close()
        for topic, kind in shown.items():
            if topic not in ears:
                ears[topic] = Ear(self.station, topic, kind)


def _row(topic: str, hertz: float, expected: float, state: str, note: str = "") -> dict[str, Any]:
    shown = None if math.isnan(hertz) else float(np.round(hertz, 1))
    return {"topic": topic, "hertz": shown, "expected": expected, "state": state, "note": note}
