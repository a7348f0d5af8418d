"""What `colcon build` makes of an `ament_python` package: its modules, its data files, and a program an entry point."""

from __future__ import annotations

import importlib.util
import os
import re
from glob import glob
from pathlib import Path, PurePosixPath
from typing import Any

from ..idl.names import did_you_mean
from ..sim.errors import shown_path
from .install_tree import PYTHON, PYTHON_FOLDERS, Environment, Item, Outcome, check_targets, names_in, with_hint
from .manifest import Found
from .package import BuildFailure, filled
from .setup_py import SetupError, install_scripts, read_setup

SITE = PYTHON_FOLDERS["python"]
_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*(\[.*\])?\s*")
_EXAMPLES: dict[str, list[Any] | dict[str, Any]] = {
    "packages": ["my_package"],
    "package_dir": {"": "src"},
    "package_data": {"my_package": ["*.yaml"]},
    "data_files": [("share/my_package", ["package.xml"])],
    "entry_points": {"console_scripts": ["my_node = my_package.my_node:main"]},
}
"""What the options look like that are carried out."""


def build_ament_python(found: Found, environment: Environment) -> Outcome:
    """Build one package: what it prints, and what is to be installed if nothing is refused."""
    try:
        return _Build(found, environment).run()
    except SetupError as error:
        text, where = str(error), shown_path(str(found.path / "setup.py"))
        hint = "" if "setup.cfg" in text else f"In {where}."
        if "SyntaxError" in text:
            hint = f"In {where}: look at this line and at the end of the one before: is a comma or a bracket missing?"
        return Outcome(1, with_hint(text, [hint]), seconds=0.3)
    except BuildFailure as failure:
        return Outcome(failure.code, with_hint(failure.text, [failure.hint]), seconds=failure.seconds)


class _Build:
    """The build of one package."""

    def __init__(self, found: Found, environment: Environment) -> None:
        self.found = found
        self.environment = environment
        self.hints: list[str] = []
        self.warnings: list[str] = []
        self.setup: dict[str, Any] = {}
        self.packages: list[str] = []
        self.entries: dict[str, list[str]] = {}

    def run(self) -> Outcome:
        folder, fault = self.found.path, self.found.xml_error
        if fault:
            until = "Until it is corrected, colcon takes the folder for a Python package without ROS."
            end = "" if fault.endswith("?") else "."
            self.hints.append(f"{shown_path(str(folder / 'package.xml'))}: {fault}{end} {until}")
        if not (folder / "setup.py").is_file():
            hint = "A package that is built from a CMakeLists.txt says <build_type>ament_cmake</build_type> in package.xml."
            raise BuildFailure(f"error: there is no setup.py in {shown_path(str(folder))}\n", hint, seconds=0.1)
        self.setup = read_setup(folder)
        self._check_options()
        name = str(self.setup.get("name", ""))
        if name.replace("-", "_") != self.found.name.replace("-", "_"):
            self.hints.append(
                f"setup.py says name='{name}', but package.xml says '{self.found.name}': write the same name in both."
            )
        if self.setup.get("cmdclass"):
            self.hints.append("setup.py has commands of its own (cmdclass=…), which are not carried out here.")
        items = [*self._modules(), *self._data(), *self._programs()]
        check_targets(items, self.found.name)
        text = with_hint("".join(self.warnings), self.hints)
        return Outcome(stderr=text, seconds=1.7 if self.environment.symlink else 1.3, items=items)

    def _check_options(self) -> None:
        for option, example in _EXAMPLES.items():
            given = self.setup[option] = self.setup.get(option) or type(example)()
            if not isinstance(given, type(example)):
                raise self._wrong(option, given)
        # setuptools takes a/b for a.b, too.
        self.packages = [str(name).replace("/", ".").strip(".") for name in self.setup["packages"]]
        for name in self.packages:
            if not all(map(str.isidentifier, name.split("."))):
                raise self._wrong("packages", name)
        groups = self.setup["entry_points"].items()
        self.entries = {group: [*map(str, lines if isinstance(lines, list) else [lines])] for group, lines in groups}
        if self.setup.get("py_modules"):
            hint = "Put the modules into a package, a folder with an __init__.py, and name that in packages=[…]."
            raise _refused("error: py_modules=… is not carried out in this simulation", hint)

    def _wrong(self, option: str, given: object) -> BuildFailure:
        text = f"error in {self.found.name} setup command: {option!r} cannot have {str(given)[:80]!r}"
        return _refused(text, f"It looks like {option}={_EXAMPLES[option]}.".replace("my_package", self.found.name))

    # -- modules ---------------------------------------------------------------------------------------------------

    def _modules(self) -> list[Item]:
        items = []
        top = sorted({name.partition(".")[0] for name in self.packages})
        for name in self.packages:
            if not self._folder(name).is_dir():
                place = self._folder(name).relative_to(self.found.path).as_posix()
                hint = f"setup.py names it in packages=…; make {place}/__init__.py."
                raise _refused(f"error: package directory '{place}' does not exist", hint)
        for name in top if self.environment.symlink else dict.fromkeys(self.packages):
            folder = self._folder(name)  # with --symlink-install, colcon puts the whole source folder on the path
            files = names_in(folder) if self.environment.symlink else self._files_of(name)
            place = f"{SITE}/{name.replace('.', '/')}"
            items += [Item(f"{place}/{file}", folder / file) for file in files]
        version = self.setup.get("version", "0.0.0")
        texts = {
            "PKG-INFO": f"Metadata-Version: 2.1\nName: {self.found.name}\nVersion: {version}\n",
            "entry_points.txt": "\n".join(
                "\n".join([f"[{group}]", *map(str.strip, lines), ""]) for group, lines in self.entries.items()
            ),
        }
        info = f"{SITE}/{self.found.name}-{version}-py{PYTHON.removeprefix('python')}.egg-info"
        return items + [Item(f"{info}/{name}", text=text) for name, text in texts.items()]

    def _files_of(self, package: str) -> list[str]:
        """What is installed of a package: its own modules, and the other files that `package_data=` names."""
        folder, patterns = self._folder(package), self.setup["package_data"]
        wanted = ["*.py", *_texts(patterns.get("")), *_texts(patterns.get(package))]
        matches = {match for pattern in wanted for match in glob(pattern, root_dir=folder, recursive=True)}
        found = {Path(os.path.normpath(folder / match)) for match in matches if not match.endswith(".pyc")}
        inside = [file for file in found if file.is_file() and file.is_relative_to(folder)]
        return sorted(file.relative_to(folder).as_posix() for file in inside)

    def _folder(self, package: str) -> Path:
        """Where a package lies: in its own folder, unless `package_dir=` says otherwise."""
        places = {name: str(place) for name, place in self.setup["package_dir"].items()}
        top, *inner = package.split(".")
        place = places.get(top) or "/".join(filter(None, (places.get("", ""), top)))
        folder = self.found.path.joinpath(place, *inner)
        if not folder.resolve().is_relative_to(self.found.path.resolve()):
            text = f"error: package_dir: '{place[:80]}' lies outside the package's folder"
            raise _refused(text, "Put the modules into the package.")
        return folder

    # -- data files ------------------------------------------------------------------------------------------------

    def _data(self) -> list[Item]:
        items = []
        for entry in self.setup["data_files"]:
            place, files = entry if isinstance(entry, list) and len(entry) == 2 else ("", None)
            if not isinstance(files, list) or not all(isinstance(name, str) for name in [place, *files]):
                raise self._wrong("data_files", entry)
            items += [self._data_file(place, name) for name in files]
        # What ROS 2 finds the package by, which colcon adds where setup.py does not name it.
        name = self.found.name
        targets = {item.target for item in items}
        marker = f"share/ament_index/resource_index/packages/{name}"
        start = f"WARNING:colcon.colcon_ros.task.ament_python.build:Package '{name}' doesn't explicitly install"
        end = "(colcon-ros currently does it implicitly but that fallback will be removed in the future)\n"
        xml = Item(f"share/{name}/package.xml", self.found.path / "package.xml")
        for what, item in (("a marker in the package index", Item(marker)), ("the 'package.xml' file", xml)):
            if item.target in targets:
                continue
            if self.found.kind != "python":
                self.warnings.append(f"{start} {what} {end}")
                items.append(item)
            elif item.target == marker:
                entry = f"('{marker.rpartition('/')[0]}', ['resource/{name}'])"
                self.hints.append(f"ros2 does not find {name} on a robot: add {entry} to data_files in setup.py.")
        return items

    def _data_file(self, place: str, name: str) -> Item:
        source = self.found.path / name
        if Path(name).is_absolute():
            text = f"AssertionError: 'data_files' must be relative, '{name}' is absolute"
            raise _refused(text, "Give the path relative to the folder of setup.py.")
        if not source.is_file():
            hint = f"setup.py names it in data_files. {did_you_mean(name, names_in(self.found.path))}".strip()
            raise _refused(f"error: can't copy '{name}': doesn't exist or not a regular file", hint)
        can_run = os.name != "nt" and os.access(source, os.X_OK)  # a program stays one
        return Item((PurePosixPath(place.replace(os.sep, "/")) / source.name).as_posix(), source, program=can_run)

    # -- programs --------------------------------------------------------------------------------------------------

    def _programs(self) -> list[Item]:
        place = install_scripts(self.found.path)
        items = []
        for name in _texts(self.setup.get("scripts")):
            source = self.found.path / name
            if not source.is_file():
                raise _refused(f"error: file '{source}' does not exist", f"setup.py names {name} in scripts=….")
            items.append(Item(f"{place or 'bin'}/{source.name}", source, program=True))
        for line in [*self.entries.get("console_scripts", []), *self.entries.get("gui_scripts", [])]:
            match = _ENTRY.fullmatch(line)
            if match is None:
                text = f"error in {self.found.name} setup command: ('Invalid entry point: ', {line!r})"
                raise _refused(text, f"It looks like 'my_node = {self.found.name}.my_node:main'.")
            name, module, function = match[1], match[2], match[3]
            self._check_entry(name, module, function)
            text = filled("entry point", line=line.strip(), module=module, function=function)
            items.append(Item(f"{place or 'bin'}/{name}", text=text, program=True))
        if items and place != f"lib/{self.found.name}":
            self.hints.append(
                f"setup.cfg puts programs into {place or 'bin'}/, where ros2 run does not look: write in it [develop] "
                f"script_dir=$base/lib/{self.found.name} and [install] install_scripts=$base/lib/{self.found.name}."
            )
        return items

    def _check_entry(self, name: str, module: str, function: str) -> None:
        """A real build does not look; the program would end with an error when it is run."""
        file = self._folder(module)
        source = file.with_suffix(".py") if file.with_suffix(".py").is_file() else file / "__init__.py"
        own = module.partition(".")[0] in {each.partition(".")[0] for each in self.packages}
        if source.is_file():
            text = source.read_text(encoding="utf-8", errors="replace")
            if not re.search(rf"\b{re.escape(function.partition('.')[0])}\b", text):
                self.hints.append(f"entry point '{name}': {module} has no {function}(), so `ros2 run` will fail.")
        elif own or importlib.util.find_spec(module.partition(".")[0]) is None:
            modules = [file.removesuffix(".py").replace("/", ".") for file in names_in(self.found.path, ".py")]
            close = did_you_mean(module, modules)
            self.hints.append(
                f"entry point '{name}': there is no module {module}, so `ros2 run` will fail. {close}".strip()
            )


def _refused(text: str, hint: str) -> BuildFailure:
    return BuildFailure(f"{text}\n", hint, seconds=0.5)


def _texts(given: Any) -> list[str]:
    """The texts of an option that may be a list, a text or left out."""
    return [given] if isinstance(given, str) else [each for each in given or [] if isinstance(each, str)]
