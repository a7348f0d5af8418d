"""`ros2 pkg create`: a new package's folder, with the files and the console output of ROS 2 Humble's.

The files' texts are Humble's where they are code, and in our own words else.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO
from xml.sax.saxutils import escape, quoteattr

from ..runtime import files
from ..sim.errors import shown_path

LICENCES = (
    "Apache-2.0", "BSL-1.0", "BSD-2.0", "BSD-2-Clause", "BSD-3-Clause", "GPL-3.0-only", "LGPL-3.0-only", "MIT", "MIT-0",
)  # fmt: skip
TO_DO_LICENCE = "TODO: License declaration"
TO_DO_DESCRIPTION = "TODO: Package description"
USER = "user"
"""The maintainer unless told otherwise: the real tool asks the computer, ours must say the same on each."""
_GOOD_NAME = re.compile(r"[a-z][a-z0-9_]*")
_UNWRITABLE = re.compile(r"[/\\\0\n\r]|^\.{0,2}$")

MODEL = "http://download.ros.org/schema/package_format{format}.xsd"
LINTERS = ("ament_lint_auto", "ament_lint_common")
PYTHON_LINTERS = ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of `ros2 pkg create`."""
    parser.add_argument("package_name", help="name of the new package, in small letters with '_'")
    parser.add_argument("--package-format", "--package_format", default="3", choices=["2", "3"], help="of package.xml")
    parser.add_argument("--description", default=TO_DO_DESCRIPTION, help="one sentence that says what it is for")
    parser.add_argument("--license", default=TO_DO_LICENCE, help="such as Apache-2.0; '?' lists the known ones")
    parser.add_argument("--destination-directory", default=os.curdir, help="folder in which to create it")
    parser.add_argument(
        "--build-type",
        default="ament_cmake",
        choices=["cmake", "ament_cmake", "ament_python"],
        help="how it is built: ament_cmake can have interfaces, ament_python is simpler for Python only",
    )
    parser.add_argument("--dependencies", nargs="+", default=[], help="packages that it depends on")
    parser.add_argument("--maintainer-email", help="e-mail address of the maintainer")
    parser.add_argument("--maintainer-name", default=USER, help="name of the maintainer")
    parser.add_argument("--node-name", help="also create a first program with this name")
    parser.add_argument("--library-name", help="also create a C++ library with this name")


def parse(words: list[str]) -> argparse.Namespace:
    """The arguments for `create_package`, from the words after `ros2 pkg create`."""
    parser = argparse.ArgumentParser("ros2 pkg create", description="Create a new ROS 2 package")
    add_arguments(parser)
    return parser.parse_args(words)


def create_package(
    args: argparse.Namespace, *, cwd: Path | None = None, stdout: TextIO | None = None, stderr: TextIO | None = None
) -> int:
    """Make the package that `args` (see `add_arguments`) asks for; return the exit code.

    Args:
        args: what was asked for.
        cwd: the folder that relative paths begin in.
        stdout, stderr: where the real tool's words go; the process's own streams unless given.
    """
    out, err = stdout or sys.stdout, stderr or sys.stderr
    if args.license == "?":
        print("Supported licenses:", *LICENCES, sep="\n", file=out)
        return 0
    if problem := _refusal(args, cwd or Path.cwd()):
        print(f"\nAborted!\n{problem}", file=err)
        return 1
    return _Creation(args, cwd or Path.cwd(), out, err).run()


def _refusal(args: argparse.Namespace, cwd: Path) -> str:
    shown = os.path.join(args.destination_directory, args.package_name)
    if _UNWRITABLE.search(args.package_name):
        return f"'{args.package_name}' cannot be the name of a folder; a name looks like robot_controller"
    if (cwd / args.destination_directory / args.package_name).exists():
        advice = "Either remove the directory or choose a different destination directory or package name"
        return f"The directory already exists: {shown}\n{advice}"
    for option, value in (("--node-name", args.node_name), ("--library-name", args.library_name)):
        if value and not re.fullmatch(r"[A-Za-z_]\w*", value):
            return f"{option} '{value}' cannot be the name of a program: use letters, digits and '_'"
    if args.build_type == "ament_python" and args.library_name:
        return "--library-name makes a C++ library, which an ament_python package cannot have"
    return ""


class _Creation:
    """One run of the command."""

    def __init__(self, args: argparse.Namespace, cwd: Path, out: TextIO, err: TextIO) -> None:
        self.args = args
        self.name: str = args.package_name
        self.maintainer = (args.maintainer_name, args.maintainer_email or f"{args.maintainer_name}@todo.todo")
        self.dependencies = list(dict.fromkeys(args.dependencies))
        self.destination = cwd / args.destination_directory
        self.folder = self.destination / self.name
        self.out, self.err = out, err

    def run(self) -> int:
        self._introduce()
        try:
            self.folder = files.check(self.folder)
            self._write_all()
            self._licence()
        except OSError as error:
            print(f"\nAborted!\n{self.name} cannot be written: {error.strerror or error}", file=self.err)
            return 1
        if not _GOOD_NAME.fullmatch(self.name):
            rule = "ROS 2 wants small letters, digits and '_', beginning with a letter"
            print(f"[WARNING]: the package name '{self.name}' will be refused by colcon build: {rule}.", file=self.err)
        return 0

    def _say(self, text: str) -> None:
        print(text, file=self.out)

    def _introduce(self) -> None:
        args = self.args
        self._say("going to create a new package")
        self._say(f"package name: {self.name}")
        self._say(f"destination directory: {shown_path(os.path.abspath(self.destination))}")
        self._say(f"package format: {args.package_format}")
        self._say("version: 0.0.0")
        self._say(f"description: {args.description}")
        self._say(f"maintainer: {['{} <{}>'.format(*self.maintainer)]}")
        self._say(f"licenses: {[args.license]}")
        self._say(f"build type: {args.build_type}")
        self._say(f"dependencies: {self.dependencies}")
        if args.node_name:
            self._say(f"node_name: {args.node_name}")
        if args.library_name:
            self._say(f"library_name: {args.library_name}")

    def _path(self, *inner: str) -> str:
        return os.path.join(self.args.destination_directory, self.name, *inner)

    def _folder(self, *inner: str) -> None:
        self._say(f"creating folder {self._path(*inner)}")
        self.folder.joinpath(*inner).mkdir(parents=True, exist_ok=True)

    def _file(self, text: str, *inner: str) -> None:
        self._say(f"creating {self._path(*inner)}")
        self.folder.joinpath(*inner).write_text(text, encoding="utf-8")

    def _write_all(self) -> None:
        args = self.args
        self._folder()
        xml = package_xml(
            self.name,
            build_type=args.build_type,
            description=args.description,
            maintainer=self.maintainer,
            licence=args.license,
            dependencies=self.dependencies,
            package_format=args.package_format,
        )
        self._file(xml, "package.xml")
        if args.build_type == "ament_python":
            self._python_files()
        else:
            self._cmake_files()

    def _python_files(self) -> None:
        args, name = self.args, self.name
        self._say("creating source folder")
        self._folder(name)
        setup = setup_py(
            name, description=args.description, maintainer=self.maintainer, licence=args.license, node=args.node_name
        )
        self._file(setup, "setup.py")
        self._file(setup_cfg(name), "setup.cfg")
        self._folder("resource")
        self._file("", "resource", name)
        self._file("", name, "__init__.py")
        self._folder("test")
        for tool in ("copyright", "flake8", "pep257"):
            self._file(style_test(tool), "test", f"test_{tool}.py")
        if args.node_name:
            self._file(python_node(name, args.node_name), name, f"{args.node_name}.py")

    def _cmake_files(self) -> None:
        args, name = self.args, self.name
        self._say("creating source and include folder")
        self._folder("src")
        self._folder("include", name)
        cmake = cmake_lists(
            name,
            build_type=args.build_type,
            dependencies=self.dependencies,
            node=args.node_name,
            library=args.library_name,
        )
        self._file(cmake, "CMakeLists.txt")
        if args.node_name:
            self._file(cpp_node(name), "src", f"{args.node_name}.cpp")
        if args.library_name:
            header, source = cpp_library(name, args.library_name)
            self._file(header, "include", name, f"{args.library_name}.hpp")
            self._file(source, "src", f"{args.library_name}.cpp")

    def _licence(self) -> None:
        licence = self.args.license
        if licence in LICENCES:
            text = licence_text(licence, self.maintainer[0])
            (self.folder / "LICENSE").write_text(text, encoding="utf-8")
            return
        self._say(
            f"\n[WARNING]: Unknown license '{licence}'.  This has been set in the package.xml, but no LICENSE file has "
            "been created.\nIt is recommended to use one of the ament license identitifers:\n" + "\n".join(LICENCES)
        )


def package_xml(
    name: str,
    *,
    build_type: str,
    description: str,
    maintainer: tuple[str, str],
    licence: str,
    dependencies: Sequence[str] = (),
    package_format: str = "3",
) -> str:
    """A `package.xml`; the maintainer is a name and an e-mail address."""
    who, email = maintainer
    tool = {"ament_cmake": "ament_cmake", "cmake": "cmake"}.get(build_type)
    tests = {"ament_cmake": LINTERS, "ament_python": PYTHON_LINTERS}.get(build_type, ())
    blocks = [
        [f"<name>{escape(name)}</name>", "<version>0.0.0</version>", f"<description>{escape(description)}</description>",
         f"<maintainer email={quoteattr(email)}>{escape(who)}</maintainer>", f"<license>{escape(licence)}</license>"],
        [f"<buildtool_depend>{tool}</buildtool_depend>"] if tool else [],
        [f"<depend>{escape(each)}</depend>" for each in dependencies],
        [f"<test_depend>{each}</test_depend>" for each in tests],
        ["<export>", f"  <build_type>{build_type}</build_type>", "</export>"],
    ]  # fmt: skip
    body = "\n\n".join("\n".join(f"  {line}" for line in block) for block in blocks if block)
    schema = f'href="{MODEL.format(format=package_format)}" schematypens="http://www.w3.org/2001/XMLSchema"'
    head = f'<?xml version="1.0"?>\n<?xml-model {schema}?>\n<package format="{package_format}">\n'
    return f"{head}{body}\n</package>\n"


def cmake_lists(
    name: str, *, build_type: str, dependencies: Sequence[str], node: str | None = None, library: str | None = None
) -> str:
    """A `CMakeLists.txt`, for a C++ program `node` and a library where they are asked for."""
    ament = build_type == "ament_cmake"
    parts = [_CMAKE_HEAD.format(name=name, warnings=_WARNINGS), "# what this package needs\n"]
    if ament:
        parts.append("find_package(ament_cmake REQUIRED)\n")
    parts += [f"find_package({each} REQUIRED)\n" for each in dependencies]
    if not dependencies:
        parts.append("# write one line for each further package: find_package(<dependency> REQUIRED)\n")
    if library:
        parts.append(_LIBRARY.format(library=library) + _linked(library, dependencies, ament))
    if node:
        parts.append(_NODE.format(node=node) + _linked(node, dependencies, ament))
        parts.append(_INSTALL_NODE.format(node=node))
    if ament:
        parts.append(_LINT + "\nament_package()\n")
    return "".join(parts)


def _linked(target: str, dependencies: Sequence[str], ament: bool) -> str:
    if not dependencies or not ament:
        return ""
    names = "".join(f"\n  {each}" for each in dependencies)
    return f"ament_target_dependencies(\n  {target}{names}\n)\n"


_WARNINGS = """\
if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()
"""
_CMAKE_HEAD = """\
cmake_minimum_required(VERSION 3.8)
project({name})

{warnings}
"""
_LIBRARY = """
add_library({library} src/{library}.cpp)
target_include_directories({library} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include>)
"""
_NODE = """
add_executable({node} src/{node}.cpp)
target_include_directories({node} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include>)
target_compile_features({node} PUBLIC c_std_99 cxx_std_17)
"""
_INSTALL_NODE = """
install(TARGETS {node}
  DESTINATION lib/${{PROJECT_NAME}})
"""
_LINT = """
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # These two checks are left out until the files have copyright lines and lie in a git repository.
  set(ament_cmake_copyright_FOUND TRUE)
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()
"""


def setup_py(name: str, *, description: str, maintainer: tuple[str, str], licence: str, node: str | None) -> str:
    """The `setup.py` of an `ament_python` package."""
    scripts = f"            '{node} = {name}.{node}:main'\n" if node else ""
    return _SETUP_PY.format(
        name=name, who=maintainer[0], email=maintainer[1], description=description, licence=licence, scripts=scripts
    )


_SETUP_PY = """\
from setuptools import find_packages, setup

package_name = '{name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={who!r},
    maintainer_email={email!r},
    description={description!r},
    license={licence!r},
    tests_require=['pytest'],
    entry_points={{
        'console_scripts': [
{scripts}        ],
    }},
)
"""


def setup_cfg(name: str) -> str:
    """The `setup.cfg` that has programs installed where ROS 2 looks for them."""
    place = f"$base/lib/{name}"
    return f"[develop]\nscript_dir={place}\n[install]\ninstall_scripts={place}\n"


def python_node(name: str, node: str) -> str:
    """The first program of an `ament_python` package."""
    return f"def main():\n    print('Hi from {name}.')\n\n\nif __name__ == '__main__':\n    main()\n"


def cpp_node(name: str) -> str:
    """The first program of an `ament_cmake` package."""
    return f"""\
#include <cstdio>

int main(int argc, char ** argv)
{{
  (void) argc;
  (void) argv;

  printf("hello world {name} package\\n");
  return 0;
}}
"""


def cpp_library(name: str, library: str) -> tuple[str, str]:
    """Header and source of a C++ library with one empty class."""
    class_name = "".join(part.capitalize() for part in library.split("_"))
    guard = f"{name}__{library}_HPP_".upper()
    header = (
        f"#ifndef {guard}\n#define {guard}\n\nnamespace {name}\n{{\n\nclass {class_name}\n{{\npublic:\n"
        f"  {class_name}();\n  virtual ~{class_name}();\n}};\n\n}}  // namespace {name}\n\n#endif  // {guard}\n"
    )
    source = (
        f'#include "{name}/{library}.hpp"\n\nnamespace {name}\n{{\n\n{class_name}::{class_name}()\n{{\n}}\n\n'
        f"{class_name}::~{class_name}()\n{{\n}}\n\n}}  // namespace {name}\n"
    )
    return header, source


def style_test(tool: str) -> str:
    """`test/test_flake8.py` and its kin: one check of the code's style."""
    call = {"flake8": "main_with_errors(argv=[])[0]", "pep257": "main(argv=['.', 'test'])"}.get(
        tool, "main(argv=['.', 'test'])"
    )
    function = call.partition("(")[0]
    skip = "@pytest.mark.skip(reason='The files have no copyright lines yet')\n" if tool == "copyright" else ""
    mark = f"{skip}@pytest.mark.linter\n@pytest.mark.{tool}\n"
    return (
        f"from ament_{tool}.main import {function}\nimport pytest\n\n\n{mark}def test_{tool}():\n"
        f"    assert {call} == 0, 'ament_{tool} found fault with the code'\n"
    )


def licence_text(identifier: str, holder: str) -> str:
    """What goes into LICENSE: which licence it is, and where its words are."""
    return (
        f"{identifier}\n\nCopyright {holder}\n\nThis package is licensed under {identifier}. Its full text is at\n"
        f"https://spdx.org/licenses/{identifier}.html; put it here in place of these lines before you publish.\n"
    )
