"""Prints the figures of the pages beside those that good pages of the field have: `python tests/pages_report.py`.

Words are those that are read in the flow: what is folded in `<details>` is counted on its own.
"""

from __future__ import annotations

import re
import statistics
from itertools import groupby
from pathlib import Path
from typing import Any

import nbformat

PAGES = sorted((Path(__file__).resolve().parents[1] / "notebooks").glob("[0-9]*.ipynb"))
WANTED = ("40–70", "≤ 3", "≤ 15", "25–35", "any", "≤ 3", "≤ 7", "2", "3", "all")
TITLES = ("page", "cells", "code median", "longest", "words mean", "words folded", "code in a row", "first picture",
          "predictions", "exercises", "pictures with text")  # fmt: skip


FOLDED = re.compile(r"<details>.*?</details>", re.DOTALL)


def words(text: str) -> int:
    """How many words a Markdown text has, without its marks."""
    return len(re.sub(r"<[^>]+>|[|#*`-]+", " ", text).split())


def pictures(cells: list[Any]) -> list[Any]:
    """The outputs that are pictures."""
    kinds = ("image/png", "text/vnd.mermaid")
    return [
        output
        for cell in cells
        for output in cell.get("outputs", [])
        if any(kind in output.get("data", {}) for kind in kinds)
    ]


def row(page: Path) -> tuple[str, ...]:
    """The figures of one page, in the order of TITLES."""
    cells = nbformat.read(page, as_version=4).cells
    code = [len(cell.source.splitlines()) for cell in cells if cell.cell_type == "code"]
    prose = [cell.source for cell in cells if cell.cell_type == "markdown"]
    read = [words(FOLDED.sub("", text)) for text in prose]
    folded = sum(map(words, prose)) - sum(read)
    rows = [len(list(group)) for kind, group in groupby(cells, key=lambda cell: cell.cell_type) if kind == "code"]
    first = next((number for number, cell in enumerate(cells, start=1) if pictures([cell])), 0)
    shown = pictures(cells)
    spoken = [output for output in shown if len(output.data.get("text/plain", "")) > 20]
    source = "\n".join(cell.source for cell in cells)
    tags = [tag for cell in cells for tag in cell.metadata.get("tags", [])]
    return (
        page.stem,
        str(len(cells)),
        f"{statistics.median(code):g}",
        str(max(code)),
        f"{statistics.mean(read):.0f}",
        str(folded),
        str(max(rows)),
        str(first),
        str(source.count("lesson.predict(")),
        str(tags.count("exercise")),
        f"{len(spoken)} of {len(shown)}",
    )


def main() -> None:
    """Print the table."""
    table = [TITLES, ("wanted", *WANTED), *map(row, PAGES)]
    widths = [max(len(line[column]) for line in table) for column in range(len(TITLES))]
    for line in table:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip())


if __name__ == "__main__":
    main()
