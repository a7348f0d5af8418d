"""Page 01: a publisher at a rate, and a subscriber that answers on another topic."""

from __future__ import annotations

from .parts import no_errors, node, publishes, subscribes
from .registry import Expectation, check
from .streams import rate, relays, steps

PAGE = "01_publish_and_subscribe"
NUMBER = "std_msgs/msg/Int32"


@check("counter", page=PAGE, points=3, limit=15)
def counter() -> list[Expectation]:
    """A node that counts aloud, twice a second."""
    return [
        node("/counter"),
        publishes("/count", NUMBER, by="/counter"),
        rate("/count", NUMBER, hz=2, seconds=4.0),
        steps("/count", NUMBER, "data", 1),
        no_errors(),
    ]


@check("doubler", page=PAGE, points=3, limit=15)
def doubler() -> list[Expectation]:
    """A node that hears a number and says twice as much."""
    pairs = [
        ({"data": given}, lambda message, given=given: message.data == 2 * given, f"{given} → {2 * given}")
        for given in (21, -500, 0, 123456)
    ]
    step = "In the callback make a new message, set its data to 2 * message.data, and publish it."
    return [
        node("/doubler"),
        subscribes("/count", NUMBER, by="/doubler"),
        publishes("/doubled", NUMBER, by="/doubler"),
        relays("/count", NUMBER, "/doubled", NUMBER, pairs, step),
        no_errors(),
    ]
