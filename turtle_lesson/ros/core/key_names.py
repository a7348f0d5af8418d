"""The names of keys, as pynput has them (https://pynput.readthedocs.io), and what a terminal sends for each."""

from __future__ import annotations

import difflib

SENT = {
    "space": " ", "enter": "\n", "tab": "\t", "esc": "\x1b", "backspace": "\x7f", "up": "\x1b[A", "down": "\x1b[B",
    "right": "\x1b[C", "left": "\x1b[D", "home": "\x1b[H", "end": "\x1b[F", "insert": "\x1b[2~", "delete": "\x1b[3~",
    "page_up": "\x1b[5~", "page_down": "\x1b[6~", "f1": "\x1bOP", "f2": "\x1bOQ", "f3": "\x1bOR", "f4": "\x1bOS",
    "f5": "\x1b[15~", "f6": "\x1b[17~", "f7": "\x1b[18~", "f8": "\x1b[19~", "f9": "\x1b[20~", "f10": "\x1b[21~",
    "f11": "\x1b[23~", "f12": "\x1b[24~", "ctrl+c": "\x03", "shift": "", "ctrl": "", "alt": "", "cmd": "", "caps_lock": "",
}  # fmt: skip
"""What a terminal sends for the keys that have a name (of xterm); for all others the character itself."""

_OF_CHARACTERS = {
    " ": "space",
    "\n": "enter",
    "\r": "enter",
    "\t": "tab",
    "\x1b": "esc",
    "\x7f": "backspace",
    "\x03": "ctrl+c",
}
_OF_BROWSERS = {
    "escape": "esc",
    "control": "ctrl",
    "pageup": "page_up",
    "pagedown": "page_down",
    "meta": "cmd",
    "capslock": "caps_lock",
}


def key_named(key: object) -> str:
    """The name of a key: of a character, of a name such as "up", or of a browser's such as "ArrowUp".

    Raises:
        ValueError: if there is no such key.
    """
    if not isinstance(key, str):
        raise ValueError(f'a key is one character or a name such as "up", got {key!r}')
    if len(key) == 1:
        return _OF_CHARACTERS.get(key, key)
    name = key.removeprefix("Arrow").lower()
    name = _OF_BROWSERS.get(name, name)
    if name not in SENT:
        close = difflib.get_close_matches(name, SENT, n=1)
        hint = f'Did you mean "{close[0]}"?' if close else f"Several keys are several arguments: press(*{key!r})."
        raise ValueError(f'a key is one character or a name such as "up" or "enter", got {key!r}. {hint}')
    return name
