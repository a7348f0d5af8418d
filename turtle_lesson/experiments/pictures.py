"""What the runs of an experiment have in common: how often they end well, quantiles, and a dot for each run."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from statistics import NormalDist
from typing import TYPE_CHECKING, Any

from ..lab import style
from ..lab.picture import Picture
from ..lab.words import count
from .one_run import OK, ExperimentError
from .table import Table, text_of

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .results import Results

CONFIDENCE = 0.95
MOST_GROUPS = 24
"""A picture with more groups than that cannot be read."""

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 6.4, 3.4, 0.75, 0.25, 0.72, 0.55
"""The card, and what is around the axes, in inches."""


def groups(results: Results, by: str | None) -> list[tuple[Any, list[dict[str, Any]]]]:
    """The rows by the values of a column, in the order in which these first come; all of them where `by` is None."""
    if by is None:
        return [(None, results.rows)]
    results.check(by)
    found: dict[Any, list[dict[str, Any]]] = {}
    for row in results.rows:
        found.setdefault(row[by], []).append(row)
    return list(found.items())


def rate(results: Results, by: str | None) -> Table:
    """See `Results.rate`."""
    rows = []
    for value, some in groups(results, by):
        good = sum(row["outcome"] == OK for row in some)
        low, high = wilson(good, len(some))
        head = {} if by is None else {by: value}
        rows.append(
            head | {"runs": len(some), "ok": good, "rate": good / len(some) if some else None, "low": low, "high": high}
        )
    return Table(rows, [*([] if by is None else [by]), "runs", "ok", "rate", "low", "high"])


def wilson(good: int, amount: int) -> tuple[float, float]:
    """The interval of Wilson's score for so many successes: https://doi.org/10.1080/01621459.1927.10502953 (1927)."""
    if not amount:
        return 0.0, 1.0
    z = NormalDist().inv_cdf((1 + CONFIDENCE) / 2)
    share = good / amount
    middle = (share + z * z / (2 * amount)) / (1 + z * z / amount)
    half = z / (1 + z * z / amount) * sqrt(share * (1 - share) / amount + z * z / (4 * amount * amount))
    return (0.0 if good == 0 else middle - half), (1.0 if good == amount else middle + half)


def quantiles(results: Results, column: str, by: str | None, at: Sequence[float]) -> Table:
    """See `Results.quantiles`."""
    import numpy as np

    if not at or not all(isinstance(share, (int, float)) and 0 <= share <= 1 for share in at):
        raise ExperimentError(f"at must be shares from 0 to 1, such as [0.05, 0.5, 0.95], got {at!r}")
    names = [f"{100 * share:g} %" for share in at]
    rows = []
    for value, some in groups(results, by):
        numbers = numbers_of(results, some, column)
        found = np.quantile(numbers, at).tolist() if len(numbers) else [None] * len(names)
        head = {} if by is None else {by: value}
        rows.append(head | {"runs": len(numbers)} | dict(zip(names, found, strict=True)))
    return Table(rows, [*([] if by is None else [by]), "runs", *names])


def numbers_of(results: Results, rows: Sequence[dict[str, Any]], column: str) -> np.ndarray:
    """The numbers of a column, without those that are missing. Raises ExperimentError for a column of other things."""
    import numpy as np

    results.check(column)
    values = [row[column] for row in rows if row[column] is not None]
    if not all(isinstance(value, (int, float)) for value in values):
        raise ExperimentError(f"{column} does not hold numbers")
    numbers = np.array(values, float)
    return numbers[~np.isnan(numbers)]


# -- the picture ---------------------------------------------------------------------------------------------------------


def plot(results: Results, column: str, by: str | None) -> Picture:
    """See `Results.plot`."""
    import numpy as np

    parts = [(value, numbers_of(results, rows, column), len(rows)) for value, rows in groups(results, by)]
    if len(parts) > MOST_GROUPS:
        raise ExperimentError(f"{by} has {len(parts)} values, and a picture shows {MOST_GROUPS}: take some by where(…)")
    amount = sum(len(numbers) for _, numbers, _ in parts)
    if not amount:
        return Picture(f"There is no {column} to draw: {results.summary}.")
    names = [column if by is None else f"{by} {text_of(value) or 'None'}" for value, _, _ in parts]
    told = [_in_words(name, numbers, runs, np) for name, (_, numbers, runs) in zip(names, parts, strict=True)]
    text = f"{column} of {count(amount, 'run')}{'' if by is None else f' by {by}'}. {' '.join(told)}"
    labels = ["all runs" if by is None else text_of(value) or "None" for value, _, _ in parts]
    with style.applied():
        return Picture(text, _draw(column, by, labels, [numbers for _, numbers, _ in parts], amount, np))


def _in_words(name: str, numbers: np.ndarray, runs: int, np: Any) -> str:
    without = f", {runs - len(numbers)} without a value" if runs > len(numbers) else ""
    if not len(numbers):
        return f"{name}: {count(runs, 'run')}{without}."
    low, middle, high = (text_of(float(each)) for each in np.quantile(numbers, [0.25, 0.5, 0.75]))
    least, most = text_of(float(numbers.min())), text_of(float(numbers.max()))
    spread = f"median {middle}, half of them from {low} to {high}, all from {least} to {most}"
    return f"{name}: {count(runs, 'run')}{without}, {spread}."


def _draw(column: str, by: str | None, labels: list[str], parts: list[np.ndarray], amount: int, np: Any) -> Figure:
    figure = style.card(WIDTH, HEIGHT)
    beside = "" if by is None else f" by {by}"
    style.heading(figure, f"{column}{beside}", f"{count(amount, 'run')}  ·  median and quartiles")
    axes = style.axes_at(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM)
    axes.set_xlim(-0.5, len(parts) - 0.5)
    axes.set_xticks(range(len(parts)), labels)
    axes.grid(visible=False, axis="x")
    axes.set_ylabel(column)
    axes.set_xlabel(by or "")
    for place, numbers in enumerate(parts):
        if len(numbers):
            _draw_group(axes, place, numbers, np)
    return figure


def _draw_group(axes: Axes, place: int, numbers: np.ndarray, np: Any) -> None:
    """The dots of a group, spread evenly so that equal ones stay apart, on its quartiles and median."""
    low, middle, high = np.quantile(numbers, [0.25, 0.5, 0.75])
    aside = place + 0.5 * ((np.arange(len(numbers)) * 0.618034) % 1 - 0.5)  # the golden ratio: no two lie side by side
    axes.bar(place, high - low, 0.62, low, color=style.SKY + "40", edgecolor=style.SKY, linewidth=0.8, zorder=2)
    axes.plot(aside, numbers, linestyle="none", marker="o", markersize=3, color=style.BLUE, alpha=0.7, zorder=3)
    axes.plot([place - 0.31, place + 0.31], [middle] * 2, color=style.VERMILLION, linewidth=2, zorder=4)
