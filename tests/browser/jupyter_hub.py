"""A plain JupyterHub on this machine, and people who log in there: what its tests and the benchmark of a class share.

It has the configuration of deploy/jupyterhub, and its proxy comes from npm.
"""

from __future__ import annotations

import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import requests
from jupyter_pages import free_port, isolated, wait_until_it_answers
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SHARED = ROOT / "deploy" / "jupyterhub" / "turtle_lesson_config.py"
PROXY = "configurable-http-proxy"
FIRST_UID = 60801
"""From here on no system gives numbers to users of its own accord."""


@dataclass(frozen=True)
class Hub:
    """A running JupyterHub."""

    address: str
    homes: Path
    """Its users' home folders."""
    log: Path
    process: subprocess.Popen[bytes]
    separate: bool
    """Whether each server runs as a system user of its own."""

    def folder(self, name: str) -> Path:
        """The folder with a user's pages."""
        return self.homes / name / "my-lesson"


def find_proxy() -> str | None:
    """The path of the hub's proxy, if npm has installed it: into the folder of this file, or for all of this machine."""
    return shutil.which(PROXY, path=HERE / "node_modules" / ".bin") or shutil.which(PROXY)


def python_for_everyone(folder: Path) -> Path | None:
    """A Python with this one's packages that every user of this computer may start; None if there is none.

    Root's virtual environments often run a Python of root's. Then the system's, of the same version, is put in its place, by a
    virtual environment that is made in `folder` and is otherwise the same.
    """
    there = folder / "environment" / "bin" / "python"
    there.parent.mkdir(parents=True)
    there.symlink_to(f"/usr/bin/python3.{sys.version_info.minor}")
    (folder / "environment" / "pyvenv.cfg").write_text("home = /usr/bin\n")
    for name in ("lib", "etc", "share"):
        (folder / "environment" / name).symlink_to(Path(sys.prefix, name))
    for each in (Path(sys.executable), there):
        command = [each, "-c", "import jupyterlab, turtle_lesson"]
        with suppress(OSError, subprocess.CalledProcessError):
            subprocess.run(
                command,
                cwd="/",
                env={},
                user=FIRST_UID,
                group=FIRST_UID,
                extra_groups=[],
                check=True,
                capture_output=True,
            )
            return each
    return None


@contextmanager
def jupyterhub(folder: Path, users: Sequence[str], proxy: str, python: Path | None) -> Iterator[Hub]:
    """A JupyterHub with these users, whose homes are in `folder`; its own files are in a folder `hub` there.

    Args:
        folder: an empty one.
        users: any password is right for them.
        proxy: the program.
        python: what runs the servers, each as a system user of its own, which only root can do; None runs all of them as the
            user of this process, with this Python.
    """
    own, homes = folder / "hub", folder / "homes"
    own.mkdir()
    homes.mkdir()
    port, api, hub_port = free_port(), free_port(), free_port()
    options = {
        "JupyterHub.bind_url": f"http://127.0.0.1:{port}",
        "JupyterHub.hub_ip": "127.0.0.1",
        "JupyterHub.hub_port": hub_port,
        "ConfigurableHTTPProxy.api_url": f"http://127.0.0.1:{api}",
        "ConfigurableHTTPProxy.command": proxy,
        "JupyterHub.authenticator_class": "dummy",
        "JupyterHub.spawner_class": "hub_users.Spawner" if python else "simple",
        "SimpleLocalProcessSpawner.home_dir_template": str(homes / "{username}"),
        "Spawner.args": "--LanguageServerManager.autodetect=False",
    }
    words = [f"--{name}={value}" for name, value in options.items()]
    words += [f"--Authenticator.allowed_users={name}" for name in users]
    words += [
        f"--Spawner.cmd={word}" for word in (str(python or sys.executable), "-m", "turtle_lesson", "open", "--hub")
    ]
    words += ["--Spawner.args=--LabApp.expose_app_in_browser=True", "--Spawner.args=--ServerApp.allow_root=True"]
    paths = os.pathsep.join(map(str, (ROOT, HERE)))
    environment = isolated(own) | {"HUB_USERS": str(own / "users"), "PYTHONPATH": paths}
    lines = []
    for uid, name in enumerate(users, FIRST_UID):
        (homes / name).mkdir(mode=0o755)  # as many systems make them: everybody may look into it
        lines.append(f"{name}:x:{uid}:{uid}::{homes / name}:/bin/sh\n")
        if python:
            os.chown(homes / name, uid, uid)
    (own / "users").write_text("".join(lines))
    with (own / "log").open("w") as log:
        command = [sys.executable, "-m", "jupyterhub", "-f", str(SHARED), *words]
        process = subprocess.Popen(command, cwd=own, env=environment, stdout=log, stderr=log)
    address = f"http://127.0.0.1:{port}"
    try:
        wait_until_it_answers(f"http://127.0.0.1:{hub_port}/hub/health", process, own / "log")
        while not requests.get(f"{address}/hub/health", timeout=100).ok:  # the proxy does not know the hub yet
            time.sleep(0.1)
        yield Hub(address, homes, own / "log", process, python is not None)
    finally:
        process.terminate()  # it stops its servers and its proxy
        process.wait(100)


class Person:
    """Somebody who has logged in at a hub, without a browser."""

    def __init__(self, hub: Hub, name: str) -> None:
        """Log in by the form, as a browser does."""
        self.server = f"{hub.address}/user/{name}"
        self._hub, self._session = hub, requests.Session()
        form = self._session.get(f"{hub.address}/hub/login")
        (token,) = re.findall(r'name="_xsrf" value="([^"]+)"', form.text)
        answer = self._session.post(
            f"{hub.address}/hub/login", {"_xsrf": token, "username": name, "password": "any"}, allow_redirects=False
        )
        if answer.status_code != 302:
            raise RuntimeError(f"{name} cannot log in: {answer.status_code} {answer.text}")

    def start_server(self, seconds: float = 300) -> None:
        """Have the hub start this person's server, and wait until its JupyterLab is there."""
        self.get(f"{self._hub.address}/hub/spawn")
        deadline = time.monotonic() + seconds
        while (page := self.get(f"{self.server}/lab")).status_code != 200 or not page.url.startswith(self.server):
            if time.monotonic() > deadline or self._hub.process.poll() is not None:
                raise RuntimeError(
                    f"{page.url}: {page.status_code}. The hub's log:\n{self._hub.log.read_text()[-3000:]}"
                )
            time.sleep(0.5)

    def get(self, address: str) -> requests.Response:
        """What is at an address; logins on the way to it are followed."""
        return self._session.get(address, timeout=100)

    def kernel(self) -> str:
        """Start a kernel for a page; its id."""
        (token,) = (each.value for each in self._session.cookies if each.name == "_xsrf" and each.path != "/hub/")
        answer = self._session.post(
            f"{self.server}/api/kernels", json={"path": "lab.ipynb"}, headers={"X-XSRFToken": token}
        )
        answer.raise_for_status()
        return answer.json()["id"]

    @contextmanager
    def connected(self, kernel: str) -> Iterator[Channels]:
        """The kernel's channels, through the hub's proxy."""
        address = f"{self.server}/api/kernels/{kernel}/channels"
        cookies = self._session.prepare_request(requests.Request("GET", address)).headers["Cookie"]
        headers, protocol = {"Cookie": cookies}, Subprotocol("v1.kernel.websocket.jupyter.org")
        address = address.replace("http", "ws", 1)
        with connect(address, additional_headers=headers, subprotocols=[protocol], max_size=None) as socket:
            yield Channels(socket)


class Channels:
    """What a page has of its kernel: a web socket, with the messages that JupyterLab sends and gets."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket

    def send(self, kind: str, content: dict[str, Any]) -> str:
        """Send a message to the kernel; its id."""
        header = {"msg_id": uuid.uuid4().hex, "msg_type": kind, "username": "", "session": "page", "version": "5.4"}
        parts = [b"shell", *(json.dumps(each).encode() for each in (header, {}, {}, content))]
        begins = itertools.accumulate(map(len, parts), initial=8 * (len(parts) + 2))
        self._socket.send(b"".join(each.to_bytes(8, "little") for each in (len(parts) + 1, *begins)) + b"".join(parts))
        return header["msg_id"]

    def messages(self) -> Iterator[tuple[str, dict[str, Any], bytes]]:
        """What comes from the kernel, as long as it is asked for: a message's type, its parent's header, and its content."""
        for frame in self._socket:
            assert isinstance(frame, bytes)
            amount = int.from_bytes(frame[:8], "little")
            ends = [int.from_bytes(frame[at : at + 8], "little") for at in range(8, 8 + 8 * amount, 8)]
            _, header, parent, _, content, *_ = (frame[begin:end] for begin, end in itertools.pairwise(ends))
            yield json.loads(header)["msg_type"], json.loads(parent), content

    def run(self, cell: str) -> str:
        """What a cell prints, or its traceback."""
        asked = self.send("execute_request", {"code": cell, "silent": False, "allow_stdin": False})
        said = ""
        for kind, parent, content in self.messages():
            if parent.get("msg_id") == asked:
                if kind in ("stream", "error"):
                    told = json.loads(content)
                    said += told.get("text", "") + "\n".join(told.get("traceback", []))
                elif kind == "status" and json.loads(content)["execution_state"] == "idle":
                    break
        return said
