"""Where packages are looked for."""

from __future__ import annotations

from turtle_lesson.ros.ament.index import current_packages


def get_search_paths() -> list[str]:
    """The folders that packages are installed in, the uppermost first; one that is used as it lies is a folder of its own."""
    places = [str(package.prefix or package.share) for package in current_packages()]
    return list(dict.fromkeys(reversed(places)))
