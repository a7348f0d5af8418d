"""The list of what rclpy holds: true of our modules, and shown in DIFFERENCES.md as it is."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from api_table import DIFFERENCES, LIST, MARKERS, Entry, entries, fault_of, faults, signature_of, table, write


def test_everything_listed_is_as_listed() -> None:
    with warnings.catch_warnings(action="ignore"):  # of policies' old names
        assert faults(list(entries())) == []


def test_the_table_in_differences_is_that_of_the_list() -> None:
    page = DIFFERENCES.read_text(encoding="utf-8")
    before, after = MARKERS
    assert page.partition(before)[2].partition(after)[0] == table(list(entries())), "python tests/api_table.py --write"


def test_no_name_is_listed_twice() -> None:
    names = [(entry.module, entry.name) for entry in entries()]
    assert len(names) == len(set(names)) > 700


def test_what_is_wrong_is_said() -> None:
    assert fault_of(Entry("rclpy", "=", "spin", "(node, executor=None)", "")) == ""
    assert fault_of(Entry("rclpy", "=", "spin", "(node)", "")) == "rclpy.spin(node) is (node, executor=None) here"
    assert fault_of(Entry("rclpy", "=", "swim", "", "")) == "rclpy.swim is not here"
    assert fault_of(Entry("rclpy", "-", "spin", "", "why")) == "rclpy.spin is here, but listed as missing"
    assert fault_of(Entry("rclpy.swimming", "-", "swim", "", "why")) == ""


def test_signatures_are_written_as_one_reads_them() -> None:
    def function(self: object, a: int, *others: int, b: object = (), c: bool = True, **more: int) -> None: ...

    def keyword(a: int = 1, *, b: str = "x") -> None: ...

    assert signature_of(function) == "(a, *others, b=…, c=True, **more)"
    assert signature_of(keyword) == "(a=1, *, b='x')"
    assert signature_of(3) == "(not callable)"  # type: ignore[arg-type]


def test_a_line_without_a_reason_means_nothing(tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_text("[rclpy]\n- spin\n")
    with pytest.raises(ValueError, match="means nothing, or gives no reason: - spin"):
        list(entries(tmp_path / "list.txt"))


def test_members_may_share_a_line_and_a_reason(tmp_path: Path) -> None:
    lines = ["# words", "[a]", "= A.(b, c)  # since Kilted", "- D(x) : is in C (not Python)", "- D.(e, f) : too"]
    (tmp_path / "list.txt").write_text("\n".join(lines))
    found = list(entries(tmp_path / "list.txt"))
    assert [(entry.name, entry.signature, entry.why) for entry in found] == [
        ("A.b", "", ""),
        ("A.c", "", ""),
        ("D", "(x)", "is in C (not Python)"),
        ("D.e", "", "too"),
        ("D.f", "", "too"),
    ]
    assert table(found).splitlines()[2] == "| `a` | 2 of 5 | `D`: is in C (not Python); `D.e`, `D.f`: too |"


def test_the_table_is_put_between_the_markers(tmp_path: Path) -> None:
    page = tmp_path / "DIFFERENCES.md"
    page.write_text("before\n" + MARKERS[0] + "old\n" + MARKERS[1] + "after\n")
    write("new\n", page)
    assert page.read_text() == "before\n" + MARKERS[0] + "new\n" + MARKERS[1] + "after\n"
    assert LIST.exists()
