"""The files that building interfaces installs: the definitions, their index, and Python modules."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ..interfaces.names import module_name
from .discover import Found
from .outcome import PYTHON, Item


def definitions(folder: Path) -> Iterator[Path]:
    """The definition files of a package, where they are looked for."""
    for kind in ("msg", "srv", "action"):
        yield from sorted((folder / kind).glob(f"*.{kind}"))


def interface_items(found: Found, files: list[str]) -> list[Item]:
    """What is installed for the interface files of a package, such as `msg/TurtleStatus.msg`."""
    name = found.name
    # Copied, as the classes are made from these: with --symlink-install, too, a new field counts after a build.
    items = [Item(f"share/{name}/{file}", found.path / file, copied=True) for file in files]
    for file in files:
        items += _parts(found, file)
    listed = sorted(item.target.removeprefix(f"share/{name}/") for item in items)
    items.append(Item(f"share/ament_index/resource_index/rosidl_interfaces/{name}", text="\n".join(listed)))
    return items + _modules(name, files)


def _parts(found: Found, file: str) -> list[Item]:
    """`NavigateTo_Request.msg` and `NavigateTo_Response.msg` of a service."""
    path = Path(file)
    if path.suffix != ".srv":
        return []
    request, _, response = (found.path / file).read_text(encoding="utf-8").partition("\n---")
    texts = {"Request": request.removeprefix("---"), "Response": response.partition("\n")[2]}
    stem = f"share/{found.name}/{path.with_suffix('').as_posix()}"
    return [Item(f"{stem}_{part}.msg", text=text.strip("\n") + "\n") for part, text in texts.items()]


def _modules(package: str, files: list[str]) -> list[Item]:
    """The Python package, whose modules get their classes from the simulation."""
    folder = f"local/lib/{PYTHON}/dist-packages/{package}"
    items = [Item(f"{folder}/__init__.py")]
    kinds: dict[str, list[str]] = {}
    for file in files:
        kind, _, rest = file.partition("/")
        kinds.setdefault(kind, []).append(rest.rpartition(".")[0])
    for kind, names in kinds.items():
        lines = [f"from {package}.{kind}.{module_name(name)} import {name}  # noqa: F401\n" for name in names]
        items.append(Item(f"{folder}/{kind}/__init__.py", text="".join(lines)))
        for name in names:
            text = _MODULE.format(package=package, kind=kind, name=name)
            items.append(Item(f"{folder}/{kind}/{module_name(name)}.py", text=text))
    return items


_MODULE = '''\
"""{package}/{kind}/{name}: made from {kind}/{name}.{kind} by colcon build."""

from turtle_lesson.ros.interfaces.registry import registry

{name} = registry.get("{package}/{kind}/{name}")
'''
