"""One call of a service, from the question to the answer."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(eq=False)
class Call:
    """Times are in ns since the world's start; None for what has not happened.

    Attributes:
        service, kind: the service's full name, and its type's.
        caller: the node that asked, by its full name; for a command its words.
        asked: when the request was sent.
        request: the request.
        server: the node that got the request, by its full name, and its process's number.
        received: when the request reached it.
        answered: when it sent its answer.
        response: the answer.
        told: when the answer reached the caller.
    """

    service: str
    kind: str
    caller: str
    asked: int
    request: Any
    server: str = ""
    process: int = 0
    received: int | None = None
    answered: int | None = None
    response: Any = None
    told: int | None = None
    others: int = field(default=0)
    """How many more servers got the same request."""
