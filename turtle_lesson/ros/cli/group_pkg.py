"""`ros2 pkg`: find packages, and create new ones."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from ..ament.create import add_arguments as add_create_arguments
from ..ament.create import create_package
from ..ament.index import current_packages, package_hint
from ..ament.package import Package
from ..idl.names import did_you_mean
from ..idl.registry import registry
from ..sim.errors import shown_path
from .arguments import arg, cut, flag
from .verb import CommandError, verb

SITE = Path(__file__).resolve().parents[1] / "site"


def package_names() -> list[str]:
    """The names of all packages: those of the world, the interface packages, and what a learner imports."""
    libraries = [path.name for path in SITE.iterdir() if (path / "__init__.py").is_file()]
    return sorted({*current_packages().names(), *registry.packages(), *libraries})


def find_prefix(name: str) -> Path | None:
    """The folder that a package is installed in; None if there is no such package."""
    packages = current_packages()
    if name in packages:
        return packages.get(name).prefix or packages.get(name).share
    if name in registry.packages():
        return registry.package(name).directory
    return SITE / name if name in package_names() else None


def not_found(name: str) -> CommandError:
    """The error for a package that is not there, in the words of the real tool."""
    return CommandError(f"Package '{cut(name, 100)}' not found", hint_for_package(name))


def hint_for_package(name: str) -> str:
    """What to try if there is no package of a name."""
    return package_hint(name[:100], package_names()) or "Is it built (colcon build), and is its setup file sourced?"


PACKAGE = arg("package_name", "name of the package")


@verb("pkg list", in_cell=True)
def _list(args: Namespace) -> None:
    """List the packages that can be found."""
    for name in package_names():
        print(name)


@verb("pkg prefix", PACKAGE, flag("--share", "the folder of its shared files instead"), in_cell=True)
def _prefix(args: Namespace) -> None:
    """Print the folder in which a package is installed."""
    prefix = find_prefix(args.package_name)
    if prefix is None:
        raise CommandError("Package not found", hint_for_package(args.package_name))
    if args.share and args.package_name in current_packages():
        prefix = current_packages().get(args.package_name).share
    print(shown_path(str(prefix)))


@verb("pkg xml", PACKAGE, arg("-t --tag", "only this element, such as version"), in_cell=True)
def _xml(args: Namespace) -> None:
    """Print the package.xml of a package."""
    from xml.etree import ElementTree

    packages = current_packages()
    path = packages.get(args.package_name).share / "package.xml" if args.package_name in packages else None
    if path is None and find_prefix(args.package_name) is None:
        raise CommandError("Package not found", hint_for_package(args.package_name))
    if path is None or not path.is_file():
        raise CommandError(f"the package '{args.package_name}' has no package.xml here: it is a part of the simulation")
    text = path.read_text(encoding="utf-8")
    root = ElementTree.fromstring(text)
    if args.tag is None:
        print(text[text.index("<package") :].rstrip())
        return
    elements = [each for each in root.iter() if each.tag == args.tag]
    if not elements:
        raise CommandError("XML tag not found", did_you_mean(args.tag, {each.tag for each in root.iter()}))
    for element in elements:
        print((element.text or "").strip())


@verb(
    "pkg executables",
    arg("package_name", "name of the package; all packages if left out", nargs="?"),
    flag("--full-path", "print the paths of the programs"),
    in_cell=True,
)
def _executables(args: Namespace) -> None:
    """List the programs of a package."""
    packages = current_packages()
    names = packages.names() if args.package_name is None else [args.package_name]
    for name in names:
        if name not in packages:
            if find_prefix(name) is None:
                raise not_found(name)
            continue
        package = packages.get(name)
        for executable in sorted(package.executables):
            print(shown_path(str(path_of(package, executable))) if args.full_path else f"{name} {executable}")


def path_of(package: Package, executable: str) -> Path:
    """Where a real ROS 2 would find a program, or where it lies."""
    target = package.executables[executable]
    return target if package.prefix is None and isinstance(target, Path) else package.libexec / executable


@verb("pkg create", add_create_arguments, in_cell=True)
def _create(args: Namespace) -> int:
    """Create a new package."""
    return create_package(args, cwd=Path.cwd(), stdout=sys.stdout, stderr=sys.stderr)
