"""Definitions of a learner's own, of every shape: the ones that ROS's own test_msgs have, and those that ROS refuses."""

from __future__ import annotations

import time
from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from interface_cases import PRIMITIVES, faults_of, message_class, values_of, words, write_package

from turtle_lesson.ros.idl.cdr import deserialize, serialize
from turtle_lesson.ros.idl.model import InvalidDefinition
from turtle_lesson.ros.idl.registry import Registry, registry

BASICS = [base for base in PRIMITIVES if "string" not in base]

FILES = {
    "msg/Empty.msg": "",
    "msg/BasicTypes.msg": "".join(f"{base} {base}_value\n" for base in BASICS),
    "msg/Constants.msg": """\
bool BOOL_CONST=true
byte BYTE_CONST=50
char CHAR_CONST=100
float32 FLOAT32_CONST=1.125
float64 FLOAT64_CONST=-1.125e-3
int8 INT8_CONST=-50
uint16 UINT16_CONST=0x10
int64 INT64_CONST=-9223372036854775808
uint64 UINT64_CONST=18446744073709551615
string STRING_CONST="Hello world!"
wstring WSTRING_CONST="Hellö wörld!"
""",
    "msg/Defaults.msg": """\
bool bool_value true
byte byte_value 50
char char_value 100
float32 float32_value 1.125
float64 float64_value 1e-05
int8 int8_value -50
uint8 uint8_value 200
int64 int64_value -40000000
uint64 uint64_value 50000000
""",
    "msg/Strings.msg": r"""string plain
string double_quotes "Hello world!"
string single_inside "Hello'world!"
string double_inside 'Hello"world!'
string escaped_single 'Hello\'world!'
string escaped_double "Hello\"world!"
string unquoted Hello world!
string numbers 42
string umlaut "ä"
string<=22 bounded
string<=22 bounded_default "Hello world!"
""",
    "msg/WStrings.msg": """\
wstring plain
wstring ascii_default "Hello world!"
wstring umlaut_default "Hellö wörld!"
wstring kana_default "ハローワールド"
wstring<=3 bounded
wstring[3] three
wstring[<=3] at_most_three
wstring[] many
""",
    "msg/Arrays.msg": "".join(
        f"{base}[3] {name}\n"
        for base, name in [(base, base + "s") for base in [*BASICS, "string"]]
        + [("BasicTypes", "basics"), ("Empty", "empties"), ("geometry_msgs/Point", "points")]
    )
    + "bool[3] bool_defaults [false, true, false]\nbyte[2] byte_defaults [0, 255]\n"
    + "float64[3] float64_defaults [3.1415, 0.0, -3.1415]\nint32[2] int32_defaults [-1, 0x10]\n"
    + "string[3] string_defaults ['', \"max, value\", min]\nint32 alignment_check\n",
    "msg/Sequences.msg": "".join(
        f"{base}[{bound}] {base}s{suffix}\n"
        for base in [*BASICS, "string"]
        for bound, suffix in (("", ""), ("<=3", "_3"))
    )
    + "BasicTypes[] basics\nBasicTypes[<=2] basics_2\nEmpty[] empties\n"
    + "uint8[] uint8_defaults [0, 1, 255]\nstring[<=3] string_defaults ['a', 'b']\nfloat32[] float32_defaults []\n",
    "msg/Nested.msg": "BasicTypes basic\nDefaults defaults\n",
    "msg/MultiNested.msg": "Arrays[2] arrays\nSequences[<=2] bounded\nNested[] nested\nStrings strings\n",
    "msg/Builtins.msg": "builtin_interfaces/Duration duration\nbuiltin_interfaces/Time stamp\n",
    "srv/Everything.srv": "BasicTypes basic\nstring<=3 name abc\nint32 LIMIT=7\n---\nArrays arrays\nEmpty nothing\n",
    "srv/Nothing.srv": "---\n",
    "action/Everything.action": "Nested nested\nint8 FAST=1\n---\nwstring text\n---\nSequences so_far\n",
}


@pytest.fixture(scope="module")
def shapes(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Registry]:
    """The registry that imports look into, with the package `shapes`."""
    registry.add("shapes", write_package(tmp_path_factory.mktemp("shapes"), FILES))
    assert faults_of(registry, "shapes") == []
    yield registry
    registry.remove("shapes")


def parts(registry: Registry) -> list[Any]:
    """The classes of all messages of the package, requests and goals included."""
    names = registry.package("shapes").interface_names()
    definitions = [registry.definition(f"shapes/{name}") for name in names]
    return [registry.get(part.full_name) for each in definitions for part in each.parts or (each,)]


def test_defaults_of_every_kind(shapes: Registry) -> None:
    expected = (
        "shapes.msg.Defaults(bool_value=True, byte_value=b'2', char_value=100, float32_value=1.125, float64_value=1e-05,"
        " int8_value=-50, uint8_value=200, int64_value=-40000000, uint64_value=50000000)"
    )
    defaults = shapes.get("shapes/msg/Defaults")
    assert repr(defaults()) == repr(shapes.get("shapes/Nested")().defaults) == expected
    assert (defaults.BYTE_VALUE__DEFAULT, defaults.FLOAT64_VALUE__DEFAULT) == (b"2", 1e-05)
    assert repr(defaults(int8_value=0, bool_value=False)).count("=0") == 1


def test_constants_of_every_kind(shapes: Registry) -> None:
    kind = shapes.get("shapes/Constants")
    assert (kind.BOOL_CONST, kind.BYTE_CONST, kind.CHAR_CONST) == (True, b"2", 100)
    assert (kind.FLOAT32_CONST, kind.FLOAT64_CONST, kind.INT8_CONST, kind.UINT16_CONST) == (1.125, -0.001125, -50, 16)
    assert (kind.INT64_CONST, kind.UINT64_CONST) == (-(2**63), 2**64 - 1)
    assert (kind.STRING_CONST, kind().WSTRING_CONST) == ("Hello world!", "Hellö wörld!")
    assert shapes.get("shapes/srv/Everything").Request.LIMIT == 7
    assert shapes.get("shapes/action/Everything").Goal().FAST == 1


def test_texts_lose_their_quotes(shapes: Registry) -> None:
    strings = shapes.get("shapes/Strings")()
    assert strings.plain == strings.bounded == ""
    assert strings.double_quotes == strings.unquoted == strings.bounded_default == "Hello world!"
    assert strings.single_inside == strings.escaped_single == "Hello'world!"
    assert strings.double_inside == strings.escaped_double == 'Hello"world!'
    assert (strings.numbers, strings.umlaut) == ("42", "ä")
    wide = shapes.get("shapes/WStrings")()
    assert (wide.ascii_default, wide.umlaut_default, wide.kana_default) == (
        "Hello world!",
        "Hellö wörld!",
        "ハローワールド",
    )
    assert (wide.plain, wide.three, wide.many) == ("", ["", "", ""], [])


def test_arrays_are_of_the_types_that_the_real_classes_use(shapes: Registry) -> None:
    arrays, sequences = shapes.get("shapes/Arrays")(), shapes.get("shapes/Sequences")()
    for base in BASICS:
        fixed, free, bounded = (getattr(m, n) for m, n in zip(
            (arrays, sequences, sequences), (f"{base}s", f"{base}s", f"{base}s_3"), strict=True))  # fmt: skip
        if base in ("bool", "byte"):
            assert (fixed, free, bounded) == ([b"\0" if base == "byte" else False] * 3, [], [])
        else:
            assert isinstance(fixed, np.ndarray) and fixed.dtype.name == ("uint8" if base == "char" else base)
            assert type(free) is type(bounded) is array and len(free) == 0
            assert free.itemsize == fixed.itemsize
    assert (arrays.bool_defaults, arrays.byte_defaults) == ([False, True, False], [b"\0", b"\xff"])
    assert (arrays.float64_defaults.tolist(), arrays.int32_defaults.tolist()) == ([3.1415, 0.0, -3.1415], [-1, 16])
    assert (arrays.string_defaults, sequences.string_defaults) == (["", "max, value", "min"], ["a", "b"])
    assert (sequences.uint8_defaults.tolist(), sequences.float32_defaults.tolist()) == ([0, 1, 255], [])
    assert [type(each).__name__ for each in arrays.basics] == ["BasicTypes"] * 3
    assert arrays.basics[0] is not arrays.basics[1]


@given(st.data())
def test_every_shape_travels(shapes: Registry, data: st.DataObject) -> None:
    kind = data.draw(st.sampled_from(parts(shapes)))
    message = data.draw(messages_of(shapes, kind))
    received = deserialize(serialize(message), kind)
    assert repr(received) == repr(message._wire_copy())


def messages_of(registry: Registry, kind: Any) -> st.SearchStrategy[Any]:
    """Messages of a class whose own fields are drawn; those that are messages of the package keep their defaults."""
    fields = {
        field.name: values_of(field.type, registry.get)
        for field in kind._DEFINITION.fields
        if field.type.is_primitive or field.type.package != "shapes"
    }
    return st.builds(lambda values: kind(**values), st.fixed_dictionaries(fields))


def test_services_and_actions_of_ones_own_are_whole(shapes: Registry) -> None:
    action = shapes.get("shapes/action/Everything")
    assert repr(shapes.get("shapes/srv/Nothing").Request()) == "shapes.srv.Nothing_Request()"
    feedback = action.Impl.FeedbackMessage(feedback=action.Feedback())
    assert deserialize(serialize(feedback), action.Impl.FeedbackMessage) == feedback
    sent = action.Impl.SendGoalService.Request()
    assert deserialize(serialize(sent), type(sent)) == sent


def test_bounds_are_checked(shapes: Registry) -> None:
    sequences, strings = shapes.get("shapes/Sequences")(), shapes.get("shapes/Strings")()
    text = "The 'uint8s_3' field must be a set or sequence with length <= 3 and each value of type 'int' and each "
    with pytest.raises(AssertionError) as caught:
        sequences.uint8s_3 = [1, 2, 3, 4]
    assert str(caught.value) == text + "unsigned integer in [0, 255]"
    with pytest.raises(AssertionError, match="field must be string value not longer than 22"):
        strings.bounded = "x" * 23
    with pytest.raises(AssertionError, match="field must be string value not longer than 3"):
        shapes.get("shapes/WStrings")(bounded="abcd")


# What cannot be built is refused, with the line and the reason


def refusal(text: str) -> InvalidDefinition:
    with pytest.raises(InvalidDefinition) as caught:
        message_class("int8 fine\n" + text)
    return caught.value


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "float32 default",
            "Member name 'default' is a keyword of C++, in which ROS 2 also generates code. Please use a diff",
        ),
        ("bool delete false", "such as 'delete_value'"),
        ("float32 lambda", "is a reserved keyword in Python"),
        ("float32 x nan", "value 'nan' cannot be written in a form that a build accepts. Set it in the program"),
        ("float64 X=-inf", "value '-inf' cannot be written in a form"),
        ("float64[] x [1.0, inf]", "value 'inf' cannot be written in a form"),
        ("float32 x 1e39", "value '1e+39' cannot be written in a form"),
        ("float64 x 1e999", "value 'inf' cannot be written in a form"),
        (r'string s "two\nlines"', "cannot be written in a form that a build accepts"),
        (r"string S='\x4'", "Set it in the program"),
        (r"string<=2 s '\nab'", "value '\\nab' can not be converted to type 'string<=2'"),
        ("string<=3 s 'ab\\", "must not exceed|cannot be written"),
        (
            "float64[1000000000000] x",
            "would consist of 1,000,000,000,002 values, which is more than fits into memory",
        ),
        ("string[20000000] x", "A sequence such as float64[] is as long as what is in it"),
        ("geometry_msgs/Pose[2000000] x", "would consist of"),
    ],
)
def test_what_no_build_gets_through_is_refused_with_its_line(line: str, said: str) -> None:
    import re

    error = refusal(line)
    assert any(re.search(re.escape(each), str(error)) for each in said.split("|")), str(error)
    assert (error.line, error.interface) == (2, "demo_msgs/msg/Demo")
    assert str(error).startswith("demo_msgs/msg/Demo, line 2, '")


def test_what_python_has_no_class_for_is_refused(tmp_path: Path) -> None:
    registry = Registry()
    files = {"msg/None.msg": "int8 x\n", "srv/None.srv": "---\n", "msg/Odd.msg": "float32 wire_copy\n"}
    registry.add("odd_msgs", write_package(tmp_path, files))
    assert [str(fault).partition(" (")[0].partition(": ") for fault in faults_of(registry, "odd_msgs")] == [
        (f"odd_msgs/{file}", ": ", "Python cannot have a class of this name, or with these fields")
        for file in ("msg/None.msg", "msg/Odd.msg", "srv/None.srv")
    ]


def test_large_messages_are_made_and_travel_in_reasonable_time() -> None:
    began = time.process_time()
    large = message_class(
        "uint8[1000000] image\nfloat64[100000] numbers\nstring[10007] names\ngeometry_msgs/Point[99] p"
    )
    message = large()
    message.names[10006], message.p[98].z = "last", 3.0
    received = deserialize(serialize(message), large)
    assert received == message and received.names[10006] == "last"
    assert time.process_time() - began < 2


def test_messages_within_messages_do_not_grow_beyond_measure(tmp_path: Path) -> None:
    """Ten fields of a message of ten fields, and so on six deep, would be a million lines were all written out."""
    files = {"msg/M0.msg": "float32 x 0.1\nint32 n 7\n"}
    for level in range(1, 6):
        files[f"msg/M{level}.msg"] = "".join(f"M{level - 1} m{index}\n" for index in range(10))
    registry = Registry()
    registry.add("deep_msgs", write_package(tmp_path, files))
    began = time.process_time()
    kind = registry.get("deep_msgs/M5")
    assert time.process_time() - began < 1
    message = kind()
    message.m3.m1.m4.m1.m5.n = 9
    received = message._wire_copy()
    assert (received.m3.m1.m4.m1.m5.n, received.m3.m1.m4.m1.m5.x) == (9, 0.10000000149011612)
    assert received.m3.m1 is not message.m3.m1
    assert received == message._wire_copy()


def test_messages_lie_within_each_other_only_so_deep(tmp_path: Path) -> None:
    files = {"msg/M0.msg": "int8 x\n"} | {f"msg/M{level}.msg": f"M{level - 1} m\n" for level in range(1, 200)}
    registry = Registry()
    registry.add("deep_msgs", write_package(tmp_path, files))
    with pytest.raises(InvalidDefinition, match="messages are nested more than 50 deep"):
        registry.get("deep_msgs/M199")
    assert registry.get("deep_msgs/M30")() == registry.get("deep_msgs/M30")()


def test_arrays_of_arrays_are_counted_before_one_is_made(tmp_path: Path) -> None:
    files = {"msg/M0.msg": "uint8[1000] x\n"} | {
        f"msg/M{level}.msg": f"M{level - 1}[1000] m\n" for level in range(1, 5)
    }
    registry = Registry()
    registry.add("wide_msgs", write_package(tmp_path, files))
    registry.get("wide_msgs/M1")
    with pytest.raises(InvalidDefinition, match=r"each message M2 would consist of 1,00\d,00\d,001 values"):
        registry.get("wide_msgs/M4")


def test_a_definition_without_end_is_not_read(tmp_path: Path) -> None:
    files = {"msg/Long.msg": "".join(f"int8 x{number}\n" for number in range(10_000))}
    registry = Registry()
    registry.add("long_msgs", write_package(tmp_path, files))
    with pytest.raises(InvalidDefinition, match=r"Long\.msg: the definition has more than 100,000 char.*\. Move some"):
        registry.get("long_msgs/Long")


# Any definition is either built or refused


TYPES = words(
    """
bool byte char float32 float64 int8 uint8 int64 uint64 string wstring string<=3 wstring<=2 geometry_msgs/Point
std_msgs/Empty Nope float time int32[] int32[3] int32[<=2] string[2] string<=4[<=2] bool[4] byte[] geometry_msgs/Pose[2]
sensor_msgs/Imu[] float64[1000000000000] geometry_msgs/Point[99999999] wstring[2]
"""
)
NAMES = words("x y data class default A FOO_BAR x_ __x x__y wire_copy self type True")
VALUES = words(
    r"""
1 -1 1.5 nan inf 1e400 1e39 true "a" 'b' "a [1,2] [1,2,3] [] [true] ['a','b'] ["a\"b"] "\x41" "\u00e9" "é" "\\" "\n" "\\\\"
0x10 1_0 99999999999999999999999 [nan] "\N{BULLET}" '\777'
"""
)


def lines() -> st.SearchStrategy[str]:
    """Lines of definitions: most are nearly right."""
    values = st.sampled_from(VALUES) | st.text(max_size=8) | st.text("\\\"'xun41é[],", max_size=9)
    field = st.tuples(st.sampled_from(TYPES), st.sampled_from(NAMES), st.sampled_from([" ", "=", ""]), values)
    return field.map("{0[0]} {0[1]}{0[2]}{0[3]}".format) | st.text(max_size=20)


@given(st.lists(lines(), max_size=4).map("\n".join))
def test_any_definition_becomes_a_working_class_or_is_refused(text: str) -> None:
    try:
        kind = message_class(text)
    except InvalidDefinition as error:
        assert error.reason
        return
    message = kind()
    assert message == message._wire_copy()
    assert deserialize(serialize(message), kind) == message._wire_copy()
    assert len(kind.get_fields_and_field_types()) == len(kind.SLOT_TYPES) == len(kind.__slots__)


@given(st.data())
def test_any_value_is_taken_or_refused_in_words(shapes: Registry, data: st.DataObject) -> None:
    """Whatever is assigned to a field, or given to a constructor: nothing but the documented errors."""
    kind = data.draw(st.sampled_from(parts(shapes)))
    odd = st.sampled_from(
        [None, True, -1, 2**70, 1.5, 1e300, "", "é\0", b"", b"ab", [], [None], (1,), {1}, {}, object(), kind]
    )
    value = data.draw(odd | odd.map(lambda each: [each, each, each]) | st.just(np.arange(3)) | st.just(array("d", [1])))
    message = kind()
    for name in kind.get_fields_and_field_types():
        try:
            setattr(message, name, value)
        except AssertionError as error:
            assert f"'{name}'" in str(error)
        except ValueError:  # array.array takes bytes for numbers as they lie in memory, in the real classes as well
            assert type(value) is bytes
        try:
            kind(**{name: value})
        except (AssertionError, TypeError, ValueError, OverflowError, RuntimeWarning) as error:
            assert str(error) or isinstance(error, AssertionError)
    repr(message)
    assert type(message._wire_copy()) is kind
