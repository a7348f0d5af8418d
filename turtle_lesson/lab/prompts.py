"""Texts to paste into a chat with an assistant: for debugging, and for a code review. Nothing is sent anywhere."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

_KINDS = {
    "debugging": (
        "I am learning ROS 2 (Humble, rclpy) and my system does not do what it should. Please help me find the cause.",
        "Say in one or two sentences what you think is wrong, and which lines of the error, graph or log say so.",
        "Name the one command (ros2 …) or the one print that would prove or disprove it, and what I should see.",
        "Only then propose a change, the smallest one. Keep to the specification; do not rewrite everything.",
        "If what you need is not here, ask me for it.",
    ),
    "code review": (
        "I am learning ROS 2 (Humble, rclpy). Please review my code against the specification below.",
        "Go through the specification line by line: is it met? Quote the line of code that shows it, or say that none does.",
        "Does any callback sleep, wait or compute for long? What would it hold up?",
        "What happens if the simulator is not running, a second request comes, or a goal makes no sense?",
        "Are angles wrapped, units right (m, rad, s), and does the turtle stop however a drive ends?",
        "List what you would change, the most important first; nothing that the specification does not ask for.",
    ),
}
"""How each kind of prompt begins, and the questions at its end."""


@dataclass(frozen=True)
class Prompt:
    """A text to copy. `print(prompt)` and `str(prompt)` give it; `prompt.text`, too."""

    kind: str
    text: str

    def __repr__(self) -> str:
        return self.text

    def _repr_mimebundle_(self, **options: object) -> dict[str, str]:
        """What Jupyter shows: a field in which one click and Ctrl+A choose all of it."""
        lines = min(24, self.text.count("\n") + 2)
        label = f"A prompt for {self.kind}: click into it, then Ctrl+A and Ctrl+C (⌘A and ⌘C on a Mac) copy it."
        look = (
            "width: 100%; box-sizing: border-box; font-family: monospace; font-size: 0.9em; color: inherit; "
            "background: transparent"
        )
        area = (
            f'<textarea readonly rows="{lines}" spellcheck="false" style="{look}">\n{html.escape(self.text)}</textarea>'
        )
        return {"text/plain": self.text, "text/html": f"<label>{label}{area}</label>"}


def compose(kind: str, code: Mapping[str, str], error: str, graph: str, log: Sequence[str], now: float) -> Prompt:
    """Put a prompt together: specification, code (texts by name), error, graph, and the last lines of the log.

    Raises ValueError for an unknown kind.
    """
    if kind not in _KINDS:
        raise ValueError(f'there are prompts for "debugging" and for "code review", got {kind!r}')
    languages = {".xml": "xml", ".txt": "cmake", ".msg": "", ".srv": "", ".yaml": "yaml"}
    written = "\n\n".join(
        f"{name}:\n\n{_fenced(text, languages.get(Path(name).suffix, 'python'))}" for name, text in code.items()
    )
    opening, *questions = _KINDS[kind]
    parts = [
        opening,
        f"## Specification\n\n{SPECIFICATION.read_text(encoding='utf-8').strip()}",
        f"## Code\n\n{written or '(none chosen)'}",
        f"## Error\n\n{_fenced(error) if error else 'None: nothing has raised an error.'}",
        f"## The running system, after {now:.1f} s\n\n{graph}",
        f"## The last lines of the log\n\n{_fenced(chr(10).join(log)) if log else 'Nothing was logged.'}",
        "## What I ask\n\n" + "\n".join(f"{number}. {text}" for number, text in enumerate(questions, 1)),
    ]
    return Prompt(kind, re.sub(r"\b0x[0-9a-f]{6,}\b", "0x…", "\n\n".join(parts)))


def _fenced(text: str, language: str = "") -> str:
    """Text in a fence that is longer than any fence in it."""
    longest = max((len(fence) for fence in re.findall(r"^\s*(`{3,})", text, re.MULTILINE)), default=2)
    fence = "`" * (longest + 1)
    return f"{fence}{language}\n{text.rstrip()}\n{fence}"


SPECIFICATION = Path(__file__).with_name("specification.md")
"""What the robot's parts are to do, as the prompts quote it."""


SUFFIXES = (".py", ".msg", ".srv", ".xml", ".txt", ".yaml")
"""The files of a package that are code: programs, interfaces, package.xml and CMakeLists.txt."""

MOST = 60_000
"""Characters in all: more is no help in a chat."""


def code_of(what: str | Path | Sequence[str | Path]) -> dict[str, str]:
    """Source texts by a name for each.

    `what` is a path (of a file, or of a folder: its programs, interfaces and package files), a text that is code, or a
    list of these. Raises ValueError for anything else, and for a path that leads nowhere.
    """
    found: dict[str, str] = {}
    for each in [what] if isinstance(what, str) or not isinstance(what, Sequence) else what:
        found.update(_texts(each))
    size = sum(map(len, found.values()))
    if size > MOST:
        raise ValueError(
            f"that is {size} characters of code, too much for a chat: name the files that matter, "
            'such as code="src/robot_controller/robot_controller/navigator_node.py"'
        )
    return found


def _texts(what: str | Path) -> dict[str, str]:
    if isinstance(what, str) and "\n" in what:
        return {"code": f"{what.strip()}\n"}
    if not isinstance(what, (str, Path)) or not (path := Path(what)).exists():
        raise ValueError(f"there is no file {what} here ({Path.cwd().name}/): look with ls, or give the code itself")
    made = {"build", "install", "log", "__pycache__"}
    files = {path.name: path} if path.is_file() else {}
    for file in sorted(path.rglob("*")):
        if file.suffix in SUFFIXES and not made & set(file.relative_to(path).parts):
            files[file.relative_to(path).as_posix()] = file
    return {name: file.read_text(encoding="utf-8", errors="replace") for name, file in files.items()}
