"""`ros2 pkg create`: a new package's folder, with the files and the console output of ROS 2 Humble's.

The files' texts are in `templates.txt`: Humble's where they are code, and in our own words else.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from ..runtime import files
from ..sim.errors import shown_path
from .package import filled

LICENCES = (
    "Apache-2.0", "BSL-1.0", "BSD-2.0", "BSD-2-Clause", "BSD-3-Clause", "GPL-3.0-only", "LGPL-3.0-only", "MIT", "MIT-0",
)  # fmt: skip
TO_DO_LICENCE = "TODO: License declaration"
TO_DO_DESCRIPTION = "TODO: Package description"
USER = "user"
"""The maintainer unless told otherwise: the real tool asks the computer, ours must say the same on each."""
_UNWRITABLE = re.compile(r"[/\\\0\n\r]|^\.{0,2}$")
_TEST_DEPENDS = {
    "ament_cmake": ("ament_lint_auto", "ament_lint_common"),
    "ament_python": ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest"),
    "cmake": (),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of `ros2 pkg create`, which `create_package` takes."""
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
    parser.add_argument("--library-name", help="not available here: C++ is not compiled")


def create_package(args: argparse.Namespace) -> int:
    """Make the package that `args` (see `add_arguments`) asks for, and say so; return the exit code."""
    if args.license == "?":
        print("Supported licenses:", *LICENCES, sep="\n")
        return 0
    root = os.path.join(args.destination_directory, args.package_name)
    if problem := _refusal(args, root):
        print(f"\nAborted!\n{problem}", file=sys.stderr)
        return 1
    try:
        _create(args, root)
    except OSError as error:
        print(f"\nAborted!\n{args.package_name} cannot be written: {error.strerror or error}", file=sys.stderr)
        return 1
    if not re.fullmatch(r"[a-z][a-z0-9_]*", args.package_name):
        rule = "ROS 2 wants small letters, digits and '_', beginning with a letter"
        said = f"[WARNING]: the package name '{args.package_name}' will be refused by colcon build: {rule}."
        print(said, file=sys.stderr)
    return 0


def _refusal(args: argparse.Namespace, root: str) -> str:
    if _UNWRITABLE.search(args.package_name):
        return f"'{args.package_name}' cannot be the name of a folder; a name looks like robot_controller"
    if os.path.exists(root):
        advice = "Either remove the directory or choose a different destination directory or package name"
        return f"The directory already exists: {root}\n{advice}"
    if args.node_name and not re.fullmatch(r"[A-Za-z_]\w*", args.node_name):
        return f"--node-name '{args.node_name}' cannot be the name of a program: use letters, digits and '_'"
    if args.library_name:
        return "--library-name makes a C++ library, and C++ is not compiled here"
    return ""


def _create(args: argparse.Namespace, root: str) -> None:
    """Write the package's files, with the real tool's words about each."""
    args.maintainer_email = args.maintainer_email or f"{args.maintainer_name}@todo.todo"
    args.dependencies = list(dict.fromkeys(args.dependencies))
    lines = {
        "package name": args.package_name,
        "destination directory": shown_path(os.path.abspath(args.destination_directory)),
        "package format": args.package_format,
        "version": "0.0.0",
        "description": args.description,
        "maintainer": [f"{args.maintainer_name} <{args.maintainer_email}>"],
        "licenses": [args.license],
        "build type": args.build_type,
        "dependencies": args.dependencies,
        "node_name": args.node_name,
    }
    print("going to create a new package")
    for what, value in lines.items():
        if value is not None:
            print(f"{what}: {value}")
    folder = files.check(Path(root))
    print(f"creating folder {root}")
    folder.mkdir(parents=True)
    for name, text in _python_files(args) if args.build_type == "ament_python" else _cmake_files(args):
        print(f"creating {'folder ' if text is None else ''}{os.path.join(root, name)}")
        if text is None:
            (folder / name).mkdir(parents=True)
        else:
            (folder / name).write_text(text, encoding="utf-8")
    if args.license in LICENCES:
        text = filled("LICENSE", identifier=args.license, holder=args.maintainer_name)
        (folder / "LICENSE").write_text(text, encoding="utf-8")
        return
    print(
        f"\n[WARNING]: Unknown license '{args.license}'.  This has been set in the package.xml, but no LICENSE file has "
        "been created.\nIt is recommended to use one of the ament license identitifers:\n" + "\n".join(LICENCES)
    )


def _package_xml(args: argparse.Namespace) -> str:
    from xml.sax.saxutils import escape, quoteattr  # imports urllib.request: 5 ms and 0.6 MB

    blocks = [
        [
            f"<name>{escape(args.package_name)}</name>",
            "<version>0.0.0</version>",
            f"<description>{escape(args.description)}</description>",
            f"<maintainer email={quoteattr(args.maintainer_email)}>{escape(args.maintainer_name)}</maintainer>",
            f"<license>{escape(args.license)}</license>",
        ],
        [] if args.build_type == "ament_python" else [f"<buildtool_depend>{args.build_type}</buildtool_depend>"],
        [f"<depend>{escape(each)}</depend>" for each in args.dependencies],
        [f"<test_depend>{each}</test_depend>" for each in _TEST_DEPENDS[args.build_type]],
        ["<export>", f"  <build_type>{args.build_type}</build_type>", "</export>"],
    ]
    body = "\n\n".join("\n".join(f"  {line}" for line in block) for block in blocks if block)
    return filled("package.xml", format=args.package_format, body=body)


def _python_files(args: argparse.Namespace) -> Iterator[tuple[str, str | None]]:
    """The files of an ament_python package with their texts, and its folders, which have none."""
    name, node = args.package_name, args.node_name
    yield "package.xml", _package_xml(args)
    print("creating source folder")
    yield name, None
    texts = {
        word: repr(getattr(args, word)) for word in ("maintainer_name", "maintainer_email", "description", "license")
    }
    scripts = f"            '{node} = {name}.{node}:main'\n" if node else ""
    yield "setup.py", filled("setup.py", name=name, scripts=scripts, **texts)
    yield "setup.cfg", filled("setup.cfg", name=name)
    yield "resource", None
    yield f"resource/{name}", ""
    yield f"{name}/__init__.py", ""
    yield "test", None
    for tool, call in _STYLE_CALLS.items():
        skip = "@pytest.mark.skip(reason='The files have no copyright lines yet')\n" if tool == "copyright" else ""
        text = filled("style test", tool=tool, call=call, function=call.partition("(")[0], skip=skip)
        yield f"test/test_{tool}.py", text
    if node:
        yield f"{name}/{node}.py", filled("program.py", name=name)


def _cmake_files(args: argparse.Namespace) -> Iterator[tuple[str, str | None]]:
    """The files of a package that CMake builds with their texts, and its folders, which have none."""
    name, node = args.package_name, args.node_name
    yield "package.xml", _package_xml(args)
    print("creating source and include folder")
    yield "src", None
    yield f"include/{name}", None
    yield "CMakeLists.txt", cmake_lists(name, args.dependencies, ament=args.build_type == "ament_cmake", node=node)
    if node:
        yield f"src/{node}.cpp", filled("program.cpp", name=name)


def cmake_lists(name: str, dependencies: Sequence[str] = (), *, ament: bool = True, node: str | None = None) -> str:
    """A `CMakeLists.txt`, for a C++ program `node` where it is asked for."""
    names = "".join(f"\n  {each}" for each in dependencies)
    linked = f"ament_target_dependencies(\n  {{}}{names}\n)\n" if names and ament else ""
    parts = [filled("CMakeLists.txt", name=name)]
    if ament:
        parts.append("find_package(ament_cmake REQUIRED)\n")
    parts += [f"find_package({each} REQUIRED)\n" for each in dependencies]
    if not dependencies:
        parts.append("# write one line for each further package: find_package(<dependency> REQUIRED)\n")
    if node:
        parts.append(filled("CMakeLists.txt: program", node=node) + linked.format(node))
        parts.append(filled("CMakeLists.txt: installed program", node=node))
    if ament:
        parts.append(filled("CMakeLists.txt: tests") + "\nament_package()\n")
    return "".join(parts)


_STYLE_CALLS = {
    "copyright": "main(argv=['.', 'test'])",
    "flake8": "main_with_errors(argv=[])[0]",
    "pep257": "main(argv=['.', 'test'])",
}
