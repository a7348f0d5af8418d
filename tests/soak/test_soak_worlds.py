"""The short form of `tests/soak/worlds.py`: what it counts; megabytes are for the long one to show."""

from __future__ import annotations

from soak import worlds


def test_worlds_leave_nothing_behind() -> None:
    with worlds.kernel() as kernel:
        found = dict(worlds.rounds(kernel, 3, 3, close=True))
        left = dict(worlds.rounds(kernel, 2, 2, close=False))
    counted = ("worlds", "greenlets", "tasks", "threads", "files", "comms", "widgets")
    assert {name: found[3][name] for name in counted} == {name: found[1][name] for name in counted}
    assert (found[3]["worlds"], found[3]["comms"], found[3]["widgets"]) == (1, 0, 0)
    assert (left[2]["worlds"], left[2]["greenlets"]) == (1, found[3]["greenlets"])
    assert left[2]["comms"] == 2 * 4, (
        "two widgets, each with its layout, of this world and of one that a page may still show"
    )


def test_a_world_that_goes_on_keeps_nothing_of_what_is_over() -> None:
    with worlds.kernel() as kernel:
        kernel.run(worlds.EVERYTHING)
        kernel.run(worlds.A_WHILE.format(until=20))
        before = kernel.figures()
        kernel.run(worlds.A_WHILE.format(until=50))
        after = kernel.figures()
    counted = ("worlds", "greenlets", "tasks", "threads", "files", "comms", "widgets")
    assert {name: after[name] for name in counted} == {name: before[name] for name in counted}
