"""What `colcon build` makes of an `ament_python` package: its modules, its data files, and a program an entry point."""

from __future__ import annotations

import importlib.util
import keyword
import os
import re
from glob import glob
from pathlib import Path, PurePosixPath
from typing import Any

from ..idl.names import did_you_mean
from ..sim.errors import shown_path
from .install_tree import PYTHON, PYTHON_FOLDERS, Environment, Item, Outcome, check_targets, files_in, with_hint
from .manifest import Found
from .package import BuildFailure, filled
from .setup_py import SetupError, install_scripts, read_setup

SITE = PYTHON_FOLDERS["python"]
_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*(\[.*\])?\s*")
_PROGRAMS = ("console_scripts", "gui_scripts")


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

    def run(self) -> Outcome:
        folder, fault = self.found.path, self.found.xml_error
        if fault:
            until = "Until it is corrected, colcon takes the folder for a Python package without ROS."
            self.hints.append(f"{shown_path(str(folder / 'package.xml'))}: {fault}. {until}")
        if not (folder / "setup.py").is_file():
            hint = "An ament_python package is built from its setup.py."
            if (folder / "CMakeLists.txt").is_file():
                hint += " There is a CMakeLists.txt: is <build_type>ament_cmake</build_type> meant in package.xml?"
            raise BuildFailure(f"error: there is no setup.py in {shown_path(str(folder))}\n", hint, seconds=0.1)
        self.setup = read_setup(folder)
        name = str(self.setup.get("name", ""))
        if name.replace("-", "_") != self.found.name.replace("-", "_"):
            self.hints.append(
                f"setup.py says name='{name}', but package.xml says '{self.found.name}': write the same name in both."
            )
        if self.setup.get("cmdclass"):
            self.hints.append("setup.py has commands of its own (cmdclass=…), which are not carried out here.")
        items = [*self._modules(), *self._data(), *self._programs()]
        check_targets(items, self.found.name)
        seconds = 1.7 if self.environment.symlink else 1.3
        text = with_hint("".join(self.warnings), self.hints)
        return Outcome(0, text, [], seconds, items)

    # -- modules ---------------------------------------------------------------------------------------------------

    def _modules(self) -> list[Item]:
        items = []
        packages = self._packages()
        top = sorted({name.partition(".")[0] for name in packages})
        for name in packages:
            if not self._folder(name).is_dir():
                place = self._folder(name).relative_to(self.found.path).as_posix()
                hint = f"setup.py names it in packages=…; make {place}/__init__.py."
                raise _refused(f"error: package directory '{place}' does not exist", hint)
        for name in top if self.environment.symlink else dict.fromkeys(packages):
            folder = self._folder(name)  # with --symlink-install, colcon puts the whole source folder on the path
            files = files_in(folder) if self.environment.symlink else self._files_of(name)
            place = f"{SITE}/{name.replace('.', '/')}"
            items += [Item(f"{place}/{file.relative_to(folder).as_posix()}", file) for file in files]
        if self.setup.get("py_modules"):
            hint = "Put the modules into a package, a folder with an __init__.py, and name that in packages=[…]."
            raise _refused("error: py_modules=… is not carried out in this simulation", hint)
        version = self.setup.get("version", "0.0.0")
        texts = {
            "PKG-INFO": f"Metadata-Version: 2.1\nName: {self.found.name}\nVersion: {version}\n",
            "entry_points.txt": "\n".join(
                f"[{group}]\n" + "".join(f"{line.strip()}\n" for line in lines)
                for group, lines in self._entries().items()
            ),
            "top_level.txt": "".join(f"{name}\n" for name in top),
        }
        info = f"{SITE}/{self.found.name}-{version}-py{PYTHON.removeprefix('python')}.egg-info"
        return items + [Item(f"{info}/{name}", text=text) for name, text in texts.items()]

    def _files_of(self, package: str) -> list[Path]:
        """What is installed of a package: its own modules, and the other files that `package_data=` names."""
        folder = self._folder(package)
        patterns = self.setup.get("package_data") or {}
        patterns = patterns if isinstance(patterns, dict) else {}
        wanted = ["*.py", *_texts(patterns.get("")), *_texts(patterns.get(package))]
        found = [match for pattern in wanted for match in glob(str(folder / pattern), recursive=True)]
        inside = [Path(os.path.normpath(match)) for match in found]
        return sorted(
            {file for file in inside if file.is_file() and file.is_relative_to(folder) and file.suffix != ".pyc"}
        )

    def _packages(self) -> list[str]:
        """What `packages=` lists. setuptools takes `a/b` for `a.b`, too."""
        given = self.setup.get("packages") or []
        names = [str(name).replace("/", ".").strip(".") for name in given] if isinstance(given, list) else [""]
        if not all(map(str.isidentifier, ".".join(names or ["a"]).split("."))):
            text = f"error in {self.found.name} setup command: 'packages' must be a list of module names"
            raise _refused(text, f"Write packages=['{self.found.name}'], with brackets.")
        return names

    def _folder(self, package: str) -> Path:
        """Where a package lies: in its own folder, unless `package_dir=` says otherwise."""
        given = self.setup.get("package_dir") or {}
        places = {str(name): str(place) for name, place in given.items()} if isinstance(given, dict) else {}
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
        given = self.setup.get("data_files") or []
        for entry in given if isinstance(given, list) else [given]:
            place, files = entry if isinstance(entry, list) and len(entry) == 2 else ("", None)
            if isinstance(files, str):
                hint = f"data_files needs a list of files, even for a single one: write ('{place}', ['{files}'])."
                raise _refused("AssertionError", hint)
            if not isinstance(files, list) or not all(isinstance(name, str) for name in [place, *files]):
                text = f"error: data_files has {str(entry)[:80]}, which is not of the form ('folder', ['file', …])"
                raise _refused(text, "Write ('share/' + package_name, ['package.xml']),.")
            items += [self._data_file(place, name) for name in files]
        # What ROS 2 finds the package by, which colcon adds where setup.py does not name it.
        name = self.found.name
        targets = {item.target for item in items}
        marker = f"share/ament_index/resource_index/packages/{name}"
        start = f"WARNING:colcon.colcon_ros.task.ament_python.build:Package '{name}' doesn't explicitly install"
        end = "(colcon-ros currently does it implicitly but that fallback will be removed in the future)\n"
        if self.found.kind == "python":
            if marker not in targets:
                entry = f"('{marker.rpartition('/')[0]}', ['resource/{name}'])"
                self.hints.append(f"ros2 does not find {name} on a robot: add {entry} to data_files in setup.py.")
            return items
        if marker not in targets:
            self.warnings.append(f"{start} a marker in the package index {end}")
            items.append(Item(marker))
        if f"share/{name}/package.xml" not in targets:
            self.warnings.append(f"{start} the 'package.xml' file {end}")
            items.append(Item(f"share/{name}/package.xml", self.found.path / "package.xml"))
        return items

    def _data_file(self, place: str, name: str) -> Item:
        source = self.found.path / name
        if Path(name).is_absolute():
            text = f"AssertionError: 'data_files' must be relative, '{name}' is absolute"
            inside = source.relative_to(self.found.path) if source.is_relative_to(self.found.path) else source.name
            raise _refused(text, f"Give the path relative to the folder of setup.py: '{inside}'.")
        if not source.is_file():
            hint = f"setup.py names it in data_files. {did_you_mean(name, self._there('*'))}".strip()
            raise _refused(f"error: can't copy '{name}': doesn't exist or not a regular file", hint)
        can_run = os.name != "nt" and os.access(source, os.X_OK)  # a program stays one
        return Item((PurePosixPath(place.replace(os.sep, "/")) / source.name).as_posix(), source, program=can_run)

    # -- programs --------------------------------------------------------------------------------------------------

    def _entries(self) -> dict[str, list[str]]:
        """The lines of each group of entry points."""
        groups = self.setup.get("entry_points") or {}
        if not isinstance(groups, dict):
            hint = "Write entry_points={'console_scripts': ['name = package.module:main']},."
            raise _refused("error: entry_points must be a dictionary", hint)
        return {group: list(map(str, lines if isinstance(lines, list) else [lines])) for group, lines in groups.items()}

    def _programs(self) -> list[Item]:
        place = install_scripts(self.found.path)
        items = []
        for name in _texts(self.setup.get("scripts")):
            source = self.found.path / name
            if not source.is_file():
                raise _refused(f"error: file '{source}' does not exist", f"setup.py names {name} in scripts=….")
            items.append(Item(f"{place or 'bin'}/{source.name}", source, program=True))
        groups = self._entries()
        for line in [line for group in _PROGRAMS for line in groups.get(group, [])]:
            match = _ENTRY.fullmatch(line)
            if match is None:
                text = f"error in {self.found.name} setup command: ('Invalid entry point: ', {line!r})"
                raise _refused(text, f"It looks like 'my_node = {self.found.name}.my_node:main'.")
            name, module, function = match[1], match[2], match[3]
            self._check_entry(name, module, function)
            text = filled("entry point", line=line.strip(), imports=_imports(module, function), function=function)
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
        own = module.partition(".")[0] in {each.partition(".")[0] for each in self._packages()}
        if source.is_file():
            text = source.read_text(encoding="utf-8", errors="replace")
            if not re.search(rf"\b{re.escape(function.partition('.')[0])}\b", text):
                self.hints.append(f"entry point '{name}': {module} has no {function}(), so `ros2 run` will fail.")
        elif own or importlib.util.find_spec(module.partition(".")[0]) is None:
            close = did_you_mean(module, [path.removesuffix(".py").replace("/", ".") for path in self._there("*.py")])
            self.hints.append(
                f"entry point '{name}': there is no module {module}, so `ros2 run` will fail. {close}".strip()
            )

    def _there(self, pattern: str) -> list[str]:
        """The files of the package that a pattern fits, as seen from its folder."""
        folder = self.found.path
        return sorted(path.relative_to(folder).as_posix() for path in folder.rglob(pattern) if path.is_file())


def _refused(text: str, hint: str) -> BuildFailure:
    return BuildFailure(f"{text}\n", hint, seconds=0.5)


def _imports(module: str, function: str) -> str:
    """The lines that import `function`. A name such as 2_turtles.py suits no `import`, but is loaded all the same."""
    first = function.partition(".")[0]
    if all(part.isidentifier() and not keyword.iskeyword(part) for part in module.split(".")):
        return f"import sys\n\nfrom {module} import {first}"
    return f"import importlib\nimport sys\n\n{first} = importlib.import_module({module!r}).{first}"


def _texts(given: Any) -> list[str]:
    """The texts of an option that may be a list, a text or left out."""
    return [given] if isinstance(given, str) else [each for each in given or [] if isinstance(each, str)]
