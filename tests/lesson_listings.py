"""The lesson's own listings, taken from its text where that lies beside the checkout (it is not ours to ship).

The text has lost its indentation. It is put back by rules that need no line of code here: what follows a header is
one level deeper, for as many lines as `BODIES` says, or to the end of its method or function.
"""

from __future__ import annotations

import re
from pathlib import Path

TEXT = Path(__file__).resolve().parents[2] / "shared" / "lesson-7.2.txt"
BODIES = {"while ": 2, "if random": 1, "else:": 1, "if self.": 1, "for i in range": 6}
"""How many lines belong to a header inside a method (for a loop, with the headers inside it)."""


def listing(header: str, end: str) -> str:
    """The listing under a header line of the lesson's text, indented again, with our package's name put in."""
    text = TEXT.read_text(encoding="utf-8")
    begin = text.index(f"\n{header}") + len(header) + 2
    return _indented(text[begin : text.index(end, begin)].replace("your_package", "robot_controller").splitlines())


def interface(header: str, end: str) -> str:
    """A message or service definition of the lesson's text."""
    text = TEXT.read_text(encoding="utf-8")
    begin = text.index("\n", text.index(f"\n{header}") + 1)
    return text[begin : text.index(end, begin)].strip() + "\n"


def _indented(lines: list[str]) -> str:
    done: list[str] = []
    level = 0
    open_bodies: list[int] = []
    for line in (line.strip() for line in lines):
        if not line:
            done.append("")
            continue
        level = _level_of(line, level)
        done.append("    " * (level + len(open_bodies)) + line)
        open_bodies = [left - 1 for left in open_bodies if left > 1]
        if re.match(r"(class |def |if __name__)", line):
            level += 1
        for start, size in BODIES.items():
            if line.startswith(start):
                open_bodies.append(size)
    return "\n".join(done) + "\n"


def _level_of(line: str, level: int) -> int:
    """Where a line that may begin a class, method or function stands."""
    if re.match(r"(class |import |from |if __name__|def \w+\((args|\)))", line):
        return 0
    return 1 if line.startswith("def ") else level
