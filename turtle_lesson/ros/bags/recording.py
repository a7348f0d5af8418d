"""`lesson.record(…)`: a recording that goes on while the page's cells run the world."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import BagError
from .recorder import HIDDEN_NODE, Recorder, Selection, checked_names, record
from .writer import BagWriter, is_there

if TYPE_CHECKING:
    from ..core import Process
    from ..world import World


class Recording:
    """A bag that is being recorded, until `stop()` or the end of a `with` block.

    `topics`: names of those to record, None for all but the hidden ones. Raises BagError where there is a file or folder
    of that name.
    """

    def __init__(
        self, world: World, path: str | Path, topics: Iterable[str] | None = None, storage: str = "mcap"
    ) -> None:
        selection = Selection(() if topics is None else checked_names(topics))
        if topics is not None and not selection.topics:
            raise BagError("topics names no topic: leave it out to record all of them")
        self.path = Path(path).expanduser().absolute()
        if is_there(self.path):
            raise BagError(
                f"Output folder '{path}' already exists. A bag is never overwritten: choose another name, or delete it "
                f"first, with shutil.rmtree({str(path)!r})"
            )
        self._shown = str(path)
        self._writer = BagWriter(self.path, storage)
        self._recorder: Recorder | None = None
        self._process: Process | None = world.spawn(lambda: self._main(selection), name="rosbag2_recorder")
        world.at_close.append(self._let_go)
        world.sim.settle()

    def _main(self, selection: Selection) -> None:
        self._recorder = record(self._writer, selection, _keep_warnings_only, node_name=HIDDEN_NODE)

    def _let_go(self) -> None:
        """The world is closed: it ends the recording, which this handle then keeps nothing of."""
        self._process = self._recorder = None

    def __repr__(self) -> str:
        state = "done" if self.done else "going on"
        count = self._writer.count
        return f"<Recording {self._shown}: {count} message{'' if count == 1 else 's'}, {state}>"

    @property
    def done(self) -> bool:
        """Whether the bag is complete."""
        return self._writer.closed

    @property
    def message_count(self) -> int:
        """How many messages the bag holds by now."""
        return self._writer.count

    def stop(self) -> None:
        """End the recording and complete the bag. A second call does nothing."""
        if self._process is None or not self._process.alive:
            return
        self._process.interrupt()
        self._writer.close()
        for sentence in self._recorder.silent() if self._recorder else ():
            warnings.warn(sentence, stacklevel=2)

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()


def _keep_warnings_only(severity: str, text: str) -> None:
    if severity != "INFO":
        warnings.warn(text, stacklevel=2)
