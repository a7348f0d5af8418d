"""YAML that somebody else may have written: how large it may be.

With aliases (`*name`) a few lines can stand for billions of values, and brackets can be nested until Python's stack ends.
"""

from __future__ import annotations

from typing import Any

import yaml

LONGEST = 1_000_000
"""How many characters are read."""

DEEPEST = 100
"""How deeply lists and mappings may be nested."""

MOST = 100_000
"""How many values all aliases together may stand for."""


class BoundedLoader(yaml.SafeLoader):
    """PyYAML's safe loader, with limits. Raises yaml.YAMLError beyond them."""

    def __init__(self, text: str) -> None:
        if len(text) > LONGEST:
            raise yaml.YAMLError(f"it has {len(text):,} characters, and at most {LONGEST:,} are read")
        super().__init__(text)
        self._depth = 0
        self._values = 0  # as many as there would be if each alias were written out
        self._written_out = 0
        self._sizes: dict[str, int] = {}  # how many of them an anchor stands for

    def compose_node(self, parent: Any, index: Any) -> Any:
        """The next value, or the one that an alias stands for."""
        event = self.peek_event()
        if isinstance(event, yaml.AliasEvent):
            self._count_alias(event)
            return super().compose_node(parent, index)
        before = self._values
        self._values += 1
        self._depth += 1
        if self._depth > DEEPEST:
            raise _refused(f"lists and mappings are nested more than {DEEPEST} deep", event)
        node = super().compose_node(parent, index)
        self._depth -= 1
        if event.anchor is not None:
            self._sizes[event.anchor] = self._values - before
        return node

    def _count_alias(self, event: Any) -> None:
        if event.anchor in self.anchors and event.anchor not in self._sizes:
            raise _refused(f"*{event.anchor} stands for a value that contains it, which has no end", event)
        size = self._sizes.get(event.anchor, 0)
        self._values += size
        self._written_out += size
        if self._written_out > MOST:
            reason = f"its aliases stand for more than {MOST:,} values: *{event.anchor} alone for {size:,}"
            raise _refused(f"{reason}. Write out what is needed", event)


def _refused(reason: str, event: Any) -> yaml.MarkedYAMLError:
    return yaml.composer.ComposerError(None, None, reason, event.start_mark)


def safe_load(text: str) -> Any:
    """The value of a text, as `yaml.safe_load` gives it. Raises yaml.YAMLError, also for what is too much."""
    return yaml.load(text, BoundedLoader)
