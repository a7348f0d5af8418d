"""What `deploy` and `binder` hold: options that exist, the commands of README, and versions that are those of the project."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml
from traitlets.config.loader import PyFileConfigLoader

from turtle_lesson.teaching.main import JUPYTER
from turtle_lesson.teaching.pages import NAMES

ROOT = Path(__file__).resolve().parents[2]
HUB = ROOT / "deploy" / "jupyterhub"
SHARED = "turtle_lesson_config.py"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
needs_jupyterhub = pytest.mark.skipif(sys.platform == "win32", reason="JupyterHub does not run on Windows")
needs_sh = pytest.mark.skipif(sys.platform == "win32", reason="these are programs for Linux")


def text(name: str) -> str:
    return (HUB / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def shared() -> dict[str, Any]:
    return PyFileConfigLoader(SHARED, path=str(HUB)).load_config()


@pytest.fixture(scope="module")
def values() -> dict[str, Any]:
    return yaml.safe_load(text("z2jh.yaml"))


# -- JupyterHub ----------------------------------------------------------------------------------------------------------


@needs_jupyterhub
def test_the_shared_part_names_options_that_jupyterhub_has(shared: dict[str, Any]) -> None:
    from jupyterhub.app import JupyterHub
    from jupyterhub.spawner import Spawner

    classes = {each.__name__: each for each in (JupyterHub, Spawner)}
    options = [(name, option) for name, section in shared.items() for option in section]
    assert options
    assert [each for each in options if each[1] not in classes[each[0]].class_trait_names(config=True)] == []
    Spawner(config=shared, user=None)  # each value is of its option's kind


@needs_jupyterhub
def test_memory_limits_are_understood_and_the_same_everywhere(values: dict[str, Any]) -> None:
    from jupyterhub.spawner import Spawner

    memory = values["singleuser"]["memory"]
    spawner = Spawner(mem_guarantee=memory["guarantee"], mem_limit=memory["limit"], user=None)
    assert 0 < spawner.mem_guarantee < spawner.mem_limit
    assert f"tljh-config set limits.memory {memory['limit']}\n" in text("tljh.sh")
    assert f"services.cull.timeout {values['cull']['timeout']}" in text("tljh.sh")
    assert f"services.cull.max_age {values['cull']['maxAge']}" in text("tljh.sh")


def test_every_place_starts_the_command_that_the_package_installs(
    shared: dict[str, Any], values: dict[str, Any]
) -> None:
    program, *words = command = shared["Spawner"]["cmd"]
    assert Path(program).name in PROJECT["scripts"] and words == ["open", "--hub"]
    home = program.partition("/.venv/bin/")[0]
    assert f"\ncd {home}\n" in text("tljh.sh")
    assert f"\nWORKDIR {home}\n" in text("Dockerfile")
    assert json.loads(re.findall(r"^CMD (.*)$", text("Dockerfile"), re.MULTILINE)[-1]) == command
    assert f"{HUB.relative_to(ROOT)}/{SHARED} " in text("tljh.sh")
    (file,) = values["hub"]["extraFiles"].values()
    assert Path(file["mountPath"]).name == SHARED


@pytest.mark.parametrize("name", ["Dockerfile", "tljh.sh"])
def test_the_lesson_is_installed_as_readme_does(name: str) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    first = re.findall(r"<!-- first command -->\n```sh\n(.*)\n```", readme)[0]
    make, install, _ = first.split(" && ")
    given = text(name).replace("--no-cache-dir ", "").replace("/opt/tljh/user/bin/", "")
    assert make in given
    assert install in given
    assert given.index(make) < given.index(install)


def test_versions_are_those_of_the_project(values: dict[str, Any]) -> None:
    pins = (ROOT / "tests" / "environment.txt").read_text(encoding="utf-8")
    (jupyterhub,) = re.findall(r"^jupyterhub==(\S+)", pins, re.MULTILINE)
    assert set(re.findall(r"JUPYTERHUB=(\S+)", text("Dockerfile"))) == {jupyterhub}
    assert values["singleuser"]["image"]["tag"] == PROJECT["version"]
    assert f"{values['singleuser']['image']['name']}:{PROJECT['version']}" in text("Dockerfile")


def test_what_the_image_copies_is_enough_to_install_the_lesson(tmp_path: Path) -> None:
    for *sources, target in (line.split() for line in re.findall(r"^COPY (.*)$", text("Dockerfile"), re.MULTILINE)):
        for each in sources:
            if (ROOT / each).is_dir():
                shutil.copytree(
                    ROOT / each, tmp_path / target, ignore=shutil.ignore_patterns("__pycache__", "workspace")
                )
            else:
                shutil.copy(ROOT / each, tmp_path / target)
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="it is for Linux, and uses GNU's install")
def test_the_script_for_the_littlest_jupyterhub_installs_the_hubs_version_and_sets_its_limits(tmp_path: Path) -> None:
    """In a folder that stands for /opt, with stand-ins for the Littlest JupyterHub's programs that note how they are called."""
    said, opt = tmp_path / "said", tmp_path / "opt"
    note = f'echo "${{0##*/}} $*" >> {said}'
    stand_ins = {
        "tljh/hub/bin/python": "echo 5.4.3",
        "tljh/user/bin/python3": f'{note}\nmkdir -p .venv/bin\ntest "$1" != -m -o "$2" != venv || cp "$0" .venv/bin/python',
        "bin/tljh-config": note,
    }
    for name, what in stand_ins.items():
        (opt / name).parent.mkdir(parents=True)
        (opt / name).write_text(f"#!/bin/sh\n{what}\n")
        (opt / name).chmod(0o755)
    shutil.copytree(HUB, opt / "turtle-lesson" / "deploy" / "jupyterhub")
    script = text("tljh.sh").replace("/opt/", f"{opt}/")
    subprocess.run(["bash", "-c", script], check=True, env={"PATH": f"{opt / 'bin'}:{os.environ['PATH']}"})
    assert said.read_text().splitlines() == [
        "python3 -m venv .venv",
        "python -m pip install -r environment.txt jupyterhub==5.4.3",
        "python -m compileall -q turtle_lesson",
        "tljh-config set limits.memory 1G",
        "tljh-config set services.cull.timeout 3600",
        "tljh-config set services.cull.max_age 28800",
        "tljh-config reload hub",
    ]
    assert (opt / "tljh" / "config" / "jupyterhub_config.d" / SHARED).read_text() == text(SHARED)


# -- Binder --------------------------------------------------------------------------------------------------------------


@needs_sh
def test_binder_makes_the_learners_folder_and_starts_its_server_with_the_lessons_kernel(tmp_path: Path) -> None:
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python").write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} "$@"\n')
    (tmp_path / "bin" / "python").chmod(0o755)
    environment = {"PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}", "HOME": str(tmp_path), "PYTHONPATH": str(ROOT)}

    def run(*words: str | Path) -> str:
        return subprocess.run(
            words, cwd=tmp_path, env=environment, check=True, capture_output=True, text=True, timeout=300
        ).stdout

    run(ROOT / "binder" / "postBuild")
    assert set(NAMES) <= {each.name for each in (tmp_path / "my-lesson").iterdir()}
    said = run(ROOT / "binder" / "start", "python", "-m", "jupyter_client.kernelspecapp", "list", "--json")
    assert json.loads(said)["kernelspecs"]["python3"]["resource_dir"] == str(JUPYTER / "kernels" / "python3")
    opened = "from turtle_lesson.ros.runtime import files; print(files._opened)"
    assert run(ROOT / "binder" / "start", "python", "-c", opened).strip() == str(tmp_path / "my-lesson")


def test_binder_installs_what_readme_does() -> None:
    lines = (ROOT / "binder" / "requirements.txt").read_text(encoding="utf-8").splitlines()
    (required,) = [line for line in lines if not line.startswith("#")]
    file = required.removeprefix("-r ")
    assert (ROOT / "binder" / file).resolve() == ROOT / "environment.txt"
    python = (ROOT / "binder" / "runtime.txt").read_text(encoding="utf-8").strip().removeprefix("python-")
    assert python in re.findall(r"python:(3\.\d+)", text("Dockerfile"))
