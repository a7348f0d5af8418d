"""Runs one copy of a page in a kernel, and tells the grader line by line what it finds: `worker FOLDER SECONDS GB`.
The checking code and the notebook come on the standard input.

The calls of `lesson.check` in a copy only say where a check is due. It is carried out by the code in `observer.py`, which the
grader sends, and answered on a line of its own, which is opened after the cells before it have run, with a secret made then.
So nothing that a cell shows, prints or writes counts.

A cell that takes too long is interrupted, and the next ones are run all the same; a kernel that does not listen is killed.
Time is the computing time of the kernel, so that a busy machine changes nothing.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import json
import marshal
import os
import re
import secrets
import shutil
import socket
import sys
import time
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from queue import Empty
from threading import Event
from typing import Any

import psutil

from .copies import LARGEST, MARK, end_all, limit, real_time

SHARE = 0.4
"""What part of the copy's time one cell may take."""

DUE = re.compile(r"^(?![ \t]*#).*?\b(\w+)\.check\(\s*(?:[\"'](\w+)[\"'])?\s*\)", re.MULTILINE)
"""A call of `lesson.check("name")`, or of `case.check()`."""

ALONE = re.compile(r"\n?^(\w+)\.check\([ \t]*[\"'](\w+)[\"'][ \t]*\)[ \t]*;?[ \t]*(?:#.*)?$\n?", re.MULTILINE)
"""A line that is nothing else."""

NO_PYTHON = re.compile(r"^\s*%%(?!time\b|capture\b)")
"""The beginning of a cell that is not run as Python, or not at all."""

ASK = """
import marshal, socket
with socket.socket({family}) as line:
    line.connect({address})
    with line.makefile("rwb") as file:
        question = marshal.load(file)
        space = {{"__name__": "observer"}}
        exec(question["observer"], space)
        file.write(space["answer"](question, names, {key!r}))
"""
"""What the kernel is given to carry a check out. Half of the secret comes with it, half on the line: one that connects in the
kernel's place has not both."""


class EndedEarly(Exception):
    """The copy cannot be run to its end; the message says why."""


def main(arguments: list[str]) -> None:
    """Run a copy; what is found goes to the standard output, which the kernel does not get, as a line of JSON each."""
    folder, seconds, memory = arguments
    grader = os.getppid()
    with open(os.dup(1), "w", encoding="utf-8") as line:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sent = marshal.load(sys.stdin.buffer)
        notebook = sys.stdin.buffer.read()
        limit(float(memory))
        try:
            with contextlib.closing(examine(notebook, Path(folder), float(seconds), sent)) as found:
                for each in found:
                    print(json.dumps(each), file=line, flush=True)
        finally:
            if os.getppid() != grader:  # it was killed, and cannot clean up
                shutil.rmtree(Path(folder).parent, ignore_errors=True)
                end_all([], os.environ.get(MARK, ""))


def examine(content: bytes, folder: Path, seconds: float, sent: dict[str, Any]) -> Generator[dict[str, Any]]:
    """Run a copy for at most `seconds` of computing: its metadata and what it asks for, then what is found, and an end."""
    kernel = Kernel(folder, seconds, sent)
    try:
        notebook = _parsed(content)
        numbered = enumerate(notebook["cells"], start=1)
        cells = [(number, cell) for number, cell in numbered if cell["cell_type"] == "code"]
        asked = [name for _, cell in cells for _, _, name in _parts("".join(cell["source"])) if name]
        yield {"metadata": notebook.get("metadata"), "asked": asked}
        yield {"kernel": kernel.start()}
        for number, cell in cells:
            yield from _run(kernel, number, cell)
        yield {"end": True}
    except EndedEarly as reason:
        yield {"problem": str(reason), "end": True}
    except Exception as error:  # whatever a damaged notebook can do to what runs it
        words = " ".join(str(error).split())[:120]
        yield {"problem": f"it could not be run: {type(error).__name__}: {words}", "end": True}
    finally:
        kernel.stop()


def _parsed(content: bytes) -> dict[str, Any]:
    """The notebook in a file's content. Raises EndedEarly where it is none."""
    with contextlib.suppress(ValueError, RecursionError, AttributeError, KeyError, TypeError):
        found = json.loads(content)  # nbformat would take seconds to import
        if found["nbformat"] == 4 and all({"cell_type", "source"} <= cell.keys() for cell in found["cells"]):
            return dict(found)
    raise EndedEarly("is not a notebook of Jupyter's format 4")


def _run(kernel: Kernel, number: int, cell: Any) -> Iterator[dict[str, Any]]:
    """Run one cell, and carry out the checks that are due in it, up to the first error."""
    for source, variable, name in _parts("".join(cell["source"])):
        if source.strip():
            reply, stopped = kernel.run(source)
            if stopped:
                yield {"error": f"cell {number} took more than {round(SHARE * kernel.seconds)} s, and was stopped"}
            elif reply.get("status") == "error" and "raises-exception" not in cell.get("metadata", {}).get("tags", []):
                words = " ".join(str(reply.get("evalue")).split())[:120]
                yield {"error": f"cell {number} raised {reply.get('ename')}: {words}"}
            if reply.get("status") != "ok":
                return
        if name:
            yield {"check": name, **kernel.look(variable, name)}


def _parts(source: str) -> list[tuple[str, str, str]]:
    """A cell's code up to each check that is due, the name of the lesson there, and the check's; "" for none at the end."""
    if NO_PYTHON.match(source):
        return [(source, "", "")]
    parts = []
    pieces = iter([*ALONE.split("\n".join(source.splitlines())), "", ""])
    for code, variable, name in zip(pieces, pieces, pieces, strict=True):
        within = [(lesson, check or "trouble") for lesson, check in DUE.findall(code)]
        for due in [*within, (variable, name)]:
            parts.append((code, *due))
            code = ""
    return [part for part in parts if any(part)]


class Kernel:
    """A copy's kernel. It is asked on the channel for orders alone; what cells print or show is never received."""

    def __init__(self, folder: Path, seconds: float, sent: dict[str, Any]) -> None:
        self.seconds = seconds
        self._folder, self._sent = folder, sent
        from jupyter_client.manager import KernelManager  # here, since it takes long to import

        self._manager = KernelManager(kernel_name="python3")
        self._client: Any = None
        self._began = time.monotonic()
        self._grader = os.getppid()
        self._process: Any = None

    def start(self) -> int:
        """Start it; returns the number of its process."""
        self._manager.start_kernel(cwd=str(self._folder))
        self._process = psutil.Process(self._manager.provisioner.pid)  # type: ignore[union-attr]
        self._client = self._manager.blocking_client()
        self._client.start_channels(iopub=False, stdin=False, hb=False)
        self._reply(self._client.kernel_info())
        # checking code needs numpy, which cannot be imported any more where cells have replaced built-in functions
        self.run("__import__('numpy')", silent=True)
        return int(self._process.pid)

    def stop(self) -> None:
        """End it, whatever it does."""
        if self._client is not None:
            self._client.stop_channels()
        with contextlib.suppress(Exception):
            self._manager.shutdown_kernel(now=True)

    def run(self, source: str, silent: bool = False) -> tuple[dict[str, Any], bool]:
        """Run some code; returns the kernel's reply, and whether it was interrupted because it took too long."""
        options = {"silent": silent, "store_history": not silent, "allow_stdin": False, "stop_on_error": False}
        return self._reply(self._client.execute(source, **options))

    def _reply(self, asked: str) -> tuple[dict[str, Any], bool]:
        began, stopped = self._used(), 0
        while True:
            with contextlib.suppress(Empty):
                reply = self._client.get_shell_msg(timeout=0.1)
                if reply["parent_header"].get("msg_id") == asked:
                    return reply["content"], bool(stopped)
            used = self._used()
            if os.getppid() != self._grader:
                raise EndedEarly("its grader has ended")
            if used > self.seconds:
                raise EndedEarly(f"it had not finished after {self.seconds:g} s, and was stopped")
            if used - began > SHARE * self.seconds + stopped:
                stopped += 1  # and again after another second
                self._manager.interrupt_kernel()

    def _used(self) -> float:
        """Seconds of computing so far; of real time, if it waited so long that this is more. Raises EndedEarly if it died."""
        try:
            if self._process.status() == psutil.STATUS_ZOMBIE:
                raise EndedEarly("its kernel died")
            times = self._process.cpu_times()
        except psutil.NoSuchProcess:
            raise EndedEarly("its kernel died") from None
        return max(times.user + times.system, self.seconds * (time.monotonic() - self._began) / real_time(self.seconds))

    def look(self, variable: str, name: str) -> dict[str, Any]:
        """Carry a check out: its rows, and what the copy has replaced; no rows if it did not answer."""
        secret, key = secrets.token_bytes(16), secrets.token_bytes(16)
        question = {**self._sent, "check": name, "variable": variable, "secret": secret}
        here = str(self._folder.with_name(secrets.token_hex(8)))  # an address that was not known before
        is_unix, over = hasattr(socket, "AF_UNIX"), Event()
        with socket.socket(socket.AF_UNIX if is_unix else socket.AF_INET) as listener, ThreadPoolExecutor(1) as pool:
            listener.settimeout(0.2)
            listener.bind(here if is_unix else ("127.0.0.1", 0))
            listener.listen()
            answered = pool.submit(_answer, listener, marshal.dumps(question), secret + key, over)
            code = ASK.format(family=int(listener.family), address=repr(listener.getsockname()), key=key)
            try:
                self.run(f"exec({code!r}, {{'names': globals()}})", silent=True)
            finally:
                over.set()
            return dict(answered.result())


def _answer(listener: socket.socket, question: bytes, secret: bytes, over: Event) -> dict[str, Any]:
    """Send the question to each that connects, until one gives an answer that is signed; no rows if none does."""
    with contextlib.suppress(TimeoutError):
        while not over.is_set():
            said = b""
            with contextlib.suppress(ConnectionError), _when(over, listener.accept)[0] as connection:
                connection.settimeout(10)
                connection.sendall(question)
                connection.settimeout(0.2)
                while len(said) < LARGEST and (more := _when(over, partial(connection.recv, 65536))):
                    said += more
            text = said[32:]
            if hmac.compare_digest(said[:32], hmac.digest(secret, text, hashlib.sha256)):
                return dict(json.loads(text))
    return {"rows": [], "replaced": []}


def _when(over: Event, receive: Callable[[], Any]) -> Any:
    """What `receive` gives. Raises TimeoutError where it gives nothing before it is over."""
    while True:
        ended = over.is_set()
        with contextlib.suppress(TimeoutError):
            return receive()
        if ended:
            raise TimeoutError


if __name__ == "__main__":
    main(sys.argv[1:])
