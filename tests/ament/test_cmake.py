"""Reading CMakeLists.txt: what counts, what is stepped over, and what is refused with its line."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson.ros.ament.cmake import Command, compiled_programs, evaluate, read_calls
from turtle_lesson.ros.ament.package import BuildFailure


def lines(text: str) -> list[tuple[str, tuple[str, ...]]]:
    """The commands that take effect, as name and arguments."""
    return [(command.name, command.args) for command in evaluate(text)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("SET(a b)\nmessage(${a})", ("b",)),
        ("set(a b c)\nmessage(${a})", ("b", "c")),
        ('set(a b c)\nmessage("${a}")', ("b;c",)),
        ("set(a b)\nset(b_b c)\nmessage(${b_${a}})", ("c",)),
        ("set(a b)\nlist(APPEND a c)\nmessage(${a})", ("b", "c")),
        ("message(${unset} x)", ("x",)),
        ('message("a b" c)', ("a b", "c")),
        ('message("a\\"b")', ('a"b',)),
        ("message([[${raw}]] [=[a]]b]=])", ("${raw}", "a]]b")),
        ("message(a # comment ) here\n b)", ("a", "b")),
        ("#[[ a\nlong comment() ]]message(a)", ("a",)),
        ("message ( ( a ) )", ("(", "a", ")")),
        ("message(a\\;b)", ("a;b",)),
        ('message(-Dx="a b")', ('-Dx="a b"',)),
        ("message($<BUILD_INTERFACE:x>)", ("$<BUILD_INTERFACE:x>",)),
    ],
)
def test_arguments(text: str, expected: tuple[str, ...]) -> None:
    assert lines(text)[-1] == ("message", expected)


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("ON", True),
        ("0", False),
        ("yes", True),
        ("unset", False),
        ("BUILD_TESTING", True),
        ("NOT BUILD_TESTING", False),
        ("unset OR BUILD_TESTING", True),
        ("BUILD_TESTING AND NOT unset", True),
        ("NOT (ON AND OFF)", True),
        ("name STREQUAL turtle", True),
        ('"${name}" STREQUAL "fish"', False),
        ("DEFINED name", True),
        ("name MATCHES ^tur", False),
        ("EXISTS /somewhere", False),
        ("", False),
        ("CMAKE_VERSION VERSION_LESS 3.8", False),
    ],
)
def test_conditions(condition: str, holds: bool) -> None:
    text = f"set(name turtle)\nif({condition})\nyes()\nelse()\nno()\nendif()"
    assert lines(text)[-1][0] == ("yes" if holds else "no")


def test_one_branch_of_nested_conditions_counts() -> None:
    inner = "if(1)\nb()\nelse()\nc()\nendif()"
    text = f"if(0)\na()\n{inner}\nelseif(1)\nd()\nelseif(1)\ne()\nelse()\nf()\nendif()\ng()"
    assert [name for name, _ in lines(text)] == ["d", "g"]


@pytest.mark.parametrize(
    "words",
    [
        "RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS msg/*.msg",
        "RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/msg/*.msg",
        "msg/A.* msg/B.*",
    ],
)
def test_files_are_found_by_patterns(tmp_path: Path, words: str) -> None:
    for name in ("msg/B.msg", "msg/A.msg", "msg/deep/C.msg", "msg/notes.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    text = f"file(GLOB near {words})\nsee(${{near}})\nfile(GLOB none *.cpp)\nsee(${{none}})"
    seen = [command.args for command in evaluate(text, folder=tmp_path) if command.name == "see"]
    assert seen == [("msg/A.msg", "msg/B.msg"), ()]


@pytest.mark.parametrize("name", ["foreach", "while", "function", "macro", "ament_auto_package"])
def test_what_is_not_carried_out_is_refused_where_it_takes_effect(name: str) -> None:
    assert lines(f"if(0)\n{name}(a)\nendif()\nsee(last)") == [("see", ("last",))]
    with pytest.raises(BuildFailure, match=rf"CMakeLists.txt:2 \({name}\):\n  {name}\(\) is not carried out in this"):
        evaluate(f"project(p)\n{name}(a)")


def test_programs_in_cpp_are_listed(tmp_path: Path) -> None:
    text = "add_executable(fast fast.cpp)\nadd_library(arm SHARED a.cpp)\nadd_subdirectory(src)\n"
    (tmp_path / "CMakeLists.txt").write_text(
        f"{text}rclcpp_components_register_node(arm PLUGIN Arm EXECUTABLE arm_node)"
    )
    assert compiled_programs(tmp_path) == {"fast": 1, "arm": 2, "src": 3, "arm_node": 4}
    assert compiled_programs(tmp_path / "nowhere") == {}


def test_folders_of_an_installation_have_names() -> None:
    text = "include(GNUInstallDirs)\nsee(${CMAKE_INSTALL_BINDIR} ${CMAKE_INSTALL_LIBDIR} ${CMAKE_INSTALL_DATADIR})"
    assert lines(text)[-1] == ("see", ("bin", "lib", "share"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("project(p)\n\ninstall(PROGRAMS a.py", "line 3: the '(' of install is never closed"),
        ("project(p)\nfind_package", "line 2: expected '(' after 'find_package'"),
        ("project(p)\n)", "line 2: expected a command such as find_package(…), found ')'"),
        ('project(p)\nset(a "b)', "line 2: this quote is never closed"),
        ("#[[ never", "line 1: this #[[ comment never ends"),
        ("if(1)\nproject(p)", "line 1: this if() has no endif()"),
        ("endif()", "line 1: endif() without an if() before it"),
        ("if(a b)\nendif()", "line 1: if(a b) is not a condition that CMake knows"),
        ("set(a ${b)", "line 1: '${b': a ${ is not closed by }"),
    ],
)
def test_what_is_refused(text: str, said: str) -> None:
    with pytest.raises(BuildFailure) as caught:
        evaluate(text)
    assert caught.value.hint.startswith(f"CMakeLists.txt, {said}")


@given(st.text(alphabet='ab(){}$"#[]= \\\n;', max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        read = evaluate(text)
    except BuildFailure as error:
        assert error.text.startswith("CMake Error at CMakeLists.txt:")
    else:
        assert all(isinstance(command, Command) for command in read)


@given(st.lists(st.text(alphabet="abc/._-", min_size=1, max_size=8), max_size=5))
def test_plain_words_come_back_as_they_are(words: list[str]) -> None:
    (call,) = read_calls(f"name({' '.join(words)})")
    assert [argument.text for argument in call.tokens] == words
