"""What is sent to workers: the function with all that it uses of the learner's own, and the learner's folders as archives."""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import linecache
import pickle
import sys
import zlib
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

from ..ros.runtime.files import home
from ..ros.sim.errors import is_learners
from .one_run import PLAIN, ExperimentError, Setting, name_of

MADE = ("build", "install", "log", "kept")
"""Folders of a workspace that are made from the others: each worker builds by itself."""


def setting_for(function: Callable[..., Any], package: str | Path | None = "finished", **options: Any) -> Setting:
    """All that the runs of a function share. Raises ExperimentError where the function cannot be sent."""
    folders: dict[str, bytes] = {}
    if package is not None and package not in ("finished", "mine"):
        folder = Path(package).resolve()
        package = f"packages/{folder.name}"
        folders[package] = archive(folder)
    if (home() / "workspace").is_dir():
        folders["workspace"] = archive(home() / "workspace", MADE)
    return Setting(pickled(function), package, folders=folders, sources=sources_of(function), **options)


def archive(folder: Path, left_out: Collection[str] = ()) -> bytes:
    """The files of a folder, each with its mode, by where they are in it; packed, and always the same for the same files."""
    files = {}
    for path in sorted(folder.rglob("*")):
        place = path.relative_to(folder)
        if path.is_file() and place.parts[0] not in left_out and "__pycache__" not in place.parts:
            files[place.as_posix()] = (path.stat().st_mode & 0o777 | 0o600, path.read_bytes())
    return zlib.compress(pickle.dumps(files, protocol=4), 1)


def hash_of_folders(folders: dict[str, bytes]) -> str:
    """A hash of what is in archives, "" for none."""
    packed = b"".join(name.encode() + data for name, data in folders.items())
    return hashlib.sha256(packed).hexdigest()[:16] if packed else ""


def pickled(function: Callable[..., Any]) -> bytes:
    """The function as cloudpickle sends it; what it uses of modules beside the notebook travels with it.

    Raises ExperimentError, which names what cannot be sent.
    """
    import cloudpickle

    with _travelling(function):
        try:
            return cloudpickle.dumps(function)
        except Exception as error:
            why = f"{type(error).__name__}: {error}"
            for name, value in _explored(function)[1]:
                try:
                    cloudpickle.dumps(value)
                except Exception as its_error:
                    why = f"it uses {name}, a {type(value).__name__} that lives in this process alone ({its_error})"
            raise ExperimentError(f"{name_of(function)} cannot be sent to a worker process: {why}") from None


def hash_of(function: Callable[..., Any]) -> str:
    """A hash of a function's source, and that of the learner's functions, classes and plain values which it uses."""
    own, used = _explored(function)
    texts = sorted(map(_source, own))
    values = sorted(f"{name}={value!r}" for name, value in used if isinstance(value, PLAIN))
    return hashlib.sha256("\n".join(texts + values).encode()).hexdigest()[:16]


def sources_of(function: Callable[..., Any]) -> dict[str, str]:
    """The texts of the cells and files that a function comes from: tracebacks show lines of them."""
    names = {each.__code__.co_filename for each in _explored(function)[0] if isinstance(each, FunctionType)}
    return {name: "".join(lines) for name in sorted(names) if (lines := linecache.getlines(name))}


def _source(thing: Any) -> str:
    try:
        return inspect.getsource(thing)
    except (OSError, TypeError):
        code = getattr(thing, "__code__", None)
        return repr(thing) if code is None else f"{code.co_name} {code.co_code.hex()} {code.co_names}"


def _explored(function: Callable[..., Any]) -> tuple[list[Any], list[tuple[str, Any]]]:
    """The function, with the functions and classes of the learner's own that it uses, directly or not; by name, what all of
    these refer to."""
    own: list[Any] = [inspect.unwrap(function)]
    used: list[tuple[str, Any]] = []
    for each in own:  # which grows
        for name, value in _names_in(each):
            used.append((name, value))
            value = inspect.unwrap(value) if callable(value) else value
            if isinstance(value, (FunctionType, type)) and _is_own(value) and not any(value is one for one in own):
                own.append(value)
    return own, used


def _names_in(thing: Any) -> Iterator[tuple[str, Any]]:
    """By name, what a function refers to outside of itself; what a class is derived from, and its methods refer to."""
    if isinstance(thing, type):
        yield from ((base.__name__, base) for base in thing.__bases__)
    for function in vars(thing).values() if isinstance(thing, type) else [thing]:
        if not isinstance(function, FunctionType):
            continue
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
            with contextlib.suppress(ValueError):  # it has no value yet
                yield name, cell.cell_contents
        for name in _global_names(function.__code__):
            if name in function.__globals__:
                yield name, function.__globals__[name]


def _global_names(code: CodeType) -> list[str]:
    inner = [name for each in code.co_consts if isinstance(each, CodeType) for name in _global_names(each)]
    return list(dict.fromkeys([*code.co_names, *inner]))


def _is_own(thing: Any) -> bool:
    module = sys.modules.get(getattr(thing, "__module__", None) or "")
    file = getattr(module, "__file__", None)
    return module is not None and (module.__name__ == "__main__" or (file is not None and is_learners(file)))


@contextlib.contextmanager
def _travelling(function: Callable[..., Any]) -> Iterator[None]:
    """Within this block cloudpickle sends modules beside the notebook or the function's file as it sends cells: as they are."""
    import cloudpickle

    own, used = _explored(function)
    modules = {sys.modules.get(each.__module__) for each in own}
    modules |= {value for _, value in used if isinstance(value, ModuleType)}
    beside = [home(), *(Path(name).parent for name in sources_of(function))]
    chosen = []
    for module in modules:
        file = getattr(module, "__file__", None)
        if module is None or file is None or module.__name__ == "__main__" or not is_learners(file):
            continue
        place = Path(file)
        if any(map(place.is_relative_to, beside)) and not place.is_relative_to(home() / "workspace"):
            chosen.append(module)
    for module in chosen:
        cloudpickle.register_pickle_by_value(module)
    try:
        yield
    finally:
        for module in chosen:
            cloudpickle.unregister_pickle_by_value(module)
