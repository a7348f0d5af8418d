"""What a subscription is told of its content filter (since Kilted)."""

from __future__ import annotations

from typing import NamedTuple


class ContentFilterOptions(NamedTuple):
    """Which messages to let in: `x > %0 AND x < %1`, and the texts that stand for %0, %1 and so on."""

    filter_expression: str
    expression_parameters: list[str]
