"""Tables of numbers, a row a message: nothing lost up to the limit, and the oldest lost beyond it."""

from types import SimpleNamespace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson.lab.recording import Table


def test_a_listener_takes_the_numbers_out_of_a_message_and_the_time_out_of_its_information():
    table = Table("forward", "turn")
    hear = table.listener("linear.x", "angular.z")
    twist = SimpleNamespace(linear=SimpleNamespace(x=0.2), angular=SimpleNamespace(z=-1.0))
    hear(twist, {"source_timestamp": 1_800_000_000_100_000_000, "received_timestamp": 5})
    assert len(table) == 1
    assert table.array().tolist() == [(1_800_000_000_100_000_000, 0.2, -1.0)]


def test_a_number_that_a_message_does_not_have_is_nothing():
    table = Table("x", "battery")
    table.listener("x", "")(SimpleNamespace(x=2.0), {"source_timestamp": 0})
    assert table.array()["x"] == [2.0] and np.isnan(table.array()["battery"][0])


def test_a_table_of_times_alone():
    table = Table()
    table.append(7)
    assert len(table) == 1 and table.array()["stamp"].tolist() == [7]


@given(st.integers(1, 40), st.integers(0, 200))
def test_the_newest_rows_are_kept(limit, amount):
    appended, heard = Table("x", "y", limit=limit), Table("x", "y", limit=limit)
    hear = heard.listener()
    for number in range(amount):
        appended.append(number, number, -number)
        hear(SimpleNamespace(x=number, y=-number), {"source_timestamp": number})
    expected = list(range(amount))[-limit:]
    for table in (appended, heard):
        assert table.array()["stamp"].tolist() == expected == table.array()["x"].tolist()
        assert len(table) == len(expected)
        assert len(table._rows) <= (limit * 9 // 8 + 2) * 24


def test_an_array_is_a_copy_that_later_rows_leave_alone():
    table = Table("x")
    table.append(1, 1.0)
    before = table.array()
    table.append(2, 2.0)
    assert before["x"].tolist() == [1.0]
