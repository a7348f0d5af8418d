"""Definition files are read, and refused, as ROS 2 does it."""

import pickle
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st
from interface_cases import definition_texts, message_class, recorded

from turtle_lesson.ros.idl.definition import parse
from turtle_lesson.ros.idl.model import InvalidDefinition
from turtle_lesson.ros.idl.names import check, module_name

CASES = recorded("interface_definitions.json")
parse_message, parse_service, parse_action = (partial(parse, folder) for folder in ("msg", "srv", "action"))


def by_text(case):
    return repr(case["text"])


def texts(members):
    return [str(member) for member in members]


def refusal(read):
    with pytest.raises(InvalidDefinition) as caught:
        read()
    return caught.value


@pytest.mark.parametrize("case", CASES["messages"], ids=by_text)
def test_a_message_is_read_as_ros_reads_it(case):
    if "error" not in case:
        definition = parse_message("pkg", "Name", case["text"])
        assert (texts(definition.fields), texts(definition.constants)) == (case["fields"], case["constants"])
        return
    error = refusal(lambda: parse_message("pkg", "Name", case["text"]))
    assert (error.ros_error, error.reason) == (case["error"], case["reason"])
    assert error.printed == case.get("printed")
    assert error.line == min(2, len(case["text"].splitlines()))  # where two or three lines, the second is to blame


@pytest.mark.parametrize("case", CASES["services"], ids=by_text)
def test_a_service_is_read_as_ros_reads_it(case):
    if "error" not in case:
        definition = parse_service("pkg", "Name", case["text"])
        request, response = definition.parts
        assert (texts(request.fields), texts(response.fields)) == (case["request"], case["response"])
        assert (request.name, response.name) == ("Name_Request", "Name_Response")
        return
    error = refusal(lambda: parse_service("pkg", "Name", case["text"]))
    assert (error.ros_error, error.reason) == (case["error"], case["reason"])


@pytest.mark.parametrize("case", CASES["names"], ids=lambda case: case["name"])
def test_names_follow_ros_rules(case):
    what = "package" if case["what"] == "package" else "message"
    if "error" not in case:
        check(what, case["name"])
    else:
        assert refusal(lambda: check(what, case["name"])).reason == case["reason"]


def test_an_action_has_three_parts():
    action = parse_action("pkg", "Turn", "float32 theta\n---\nfloat32 delta\n---\nfloat32 remaining\n")
    assert [part.full_name for part in action.parts] == [
        "pkg/action/Turn_Goal",
        "pkg/action/Turn_Result",
        "pkg/action/Turn_Feedback",
    ]
    error = refusal(lambda: parse_action("pkg", "Turn", "float32 theta\n---\nfloat32 delta\n"))
    assert error.ros_error == "InvalidActionSpecification"


def test_windows_line_ends_are_no_matter():
    unix = parse_message("pkg", "Name", "int32 A=1\nfloat32 x  # metres\n\nstring s\n")
    windows = parse_message("pkg", "Name", "int32 A=1\r\nfloat32 x  # metres\r\n\r\nstring s\r\n")
    assert (unix.fields, unix.constants) == (windows.fields, windows.constants)


def test_the_source_text_is_kept():
    text = "# all about x\nfloat32 x  # metres\n"
    assert parse_message("pkg", "Name", text).text == text
    assert parse_service("pkg", "Name", text + "---\n").parts[0].text == text.rstrip("\n")


def test_a_type_says_what_it_is_made_of():
    text = "string<=5[<=2] names\ngeometry_msgs/Point[3] corners\nfloat32[] ranges\nTwist t"
    names, corners, ranges, own = [field.type for field in parse_message("pkg", "Name", text).fields]
    assert (names.base, names.string_bound, names.lengths) == ("string", 5, range(3))
    assert (corners.package, corners.base, corners.lengths) == ("geometry_msgs", "Point", range(3, 4))
    assert (ranges.package, ranges.is_array, ranges.size) == (None, True, None)
    assert own.package == "pkg"


def test_an_error_names_file_line_and_remedy():
    error = refusal(lambda: parse_message("pkg", "Status", "float32 x\n\nflot32 y # oh\n", "/far/msg/Status.msg"))
    assert (error.file, error.line, error.line_text) == ("/far/msg/Status.msg", 3, "flot32 y")
    assert str(error) == (
        "pkg/msg/Status.msg, line 3, 'flot32 y': 'flot32' is an invalid message name."
        " It should have the pattern '^[A-Z][A-Za-z0-9]*$'. Did you mean 'float32'?"
    )
    assert error.qualified_ros_error == "rosidl_adapter.parser.InvalidResourceName"


def test_lines_of_a_response_are_counted_from_the_top_of_the_file():
    error = refusal(lambda: parse_service("pkg", "Go", "float32 x\n---\nbool ok\nfloat32 Time\n"))
    assert (error.line, error.interface, error.ros_error) == (4, "pkg/srv/Go_Response", "NameError")
    assert error.hint == "Try 'time'"


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("double x", "Did you mean 'float64'?"),
        ("int x", "Did you mean 'int32'?"),
        ("turtle_status s", "Try 'TurtleStatus'"),
        ("float32 maxSpeed", "Try 'max_speed'"),
        ("float32 x, y", "Write one field a line, with nothing after its name but a default value"),
        ("geometry_msgs/msg/Twist t", "Write 'geometry_msgs/Twist'"),
        ("float32 x=1.0", "Constants are in capitals; a default value is written without '='"),
        ("  float32 x", "Begin the line with the type, without spaces"),
        ("int32[0] a", "Write int32[3], int32[<=3] or int32[]"),
    ],
)
def test_a_hint_says_what_to_try(text, hint):
    assert refusal(lambda: parse_message("pkg", "Name", text)).hint == hint


def test_quoted_strings_in_a_default_list_may_hold_commas():
    (field,) = parse_message("pkg", "Name", """string[] s ["a, b", 'c', d, "say \\"e\\""]""").fields
    assert field.default == ("a, b", "c", "d", 'say "e"')
    assert refusal(lambda: parse_message("pkg", "Name", 'string[] s ["a]')).ros_error == "ValueError"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (
            "float32[] x 1.0",
            "value '1.0' can not be converted to type 'float32[]': array value must start with",
        ),
        (
            "int8[] x [1, 300]",
            "value '[1, 300]' can not be converted to type 'int8[]': element 1 with value '300'",
        ),
        ("float32] x", "the type float32] ends with ']' but does not contain a '['"),
        ("string<=0 s", "the upper bound of the string type 'string<=0' must be a valid integer value > 0"),
        ("byte b 300", "value '300' can not be converted to type 'byte': must be a valid integer value >= 0"),
    ],
)
def test_more_that_ros_refuses(text, reason):
    assert refusal(lambda: parse_message("pkg", "Name", text)).reason.startswith(reason)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("float32 class", "reserved keyword in Python"),
        ("time stamp", "Write 'builtin_interfaces/Time stamp'"),
        ("Header header", "Did you mean 'std_msgs/Header'?"),
        ("geometry_msgs/Twst t", "the type 'geometry_msgs/Twst' is unknown"),
        ("nope_msgs/Twist t", "Did you mean 'geometry_msgs/Twist'?"),
    ],
)
def test_what_only_the_later_steps_of_a_build_refuse(text, said):
    parse_message("pkg", "Name", text)
    error = refusal(lambda: message_class("float32 ok\n" + text))
    assert said in str(error)
    assert error.line == 2


def test_errors_can_be_pickled():
    error = refusal(lambda: parse_message("pkg", "Name", "float x"))
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


@pytest.mark.parametrize(
    ("name", "module"),
    [
        ("Twist", "_twist"),
        ("TurtleStatus", "_turtle_status"),
        ("UInt8MultiArray", "_u_int8_multi_array"),
        ("MultiDOFJointState", "_multi_dof_joint_state"),
        ("Pose2D", "_pose2_d"),
        ("ColorRGBA", "_color_rgba"),
        ("UUID", "_uuid"),
    ],
)
def test_module_names(name, module):
    assert module_name(name) == module


@given(definition_texts())
def test_what_is_written_back_reads_the_same(text):
    definition = parse_message("pkg", "Name", text)
    again = parse_message("pkg", "Name", "\n".join(texts(definition.fields)))
    assert again.fields == definition.fields


@given(st.text() | st.lists(st.sampled_from([*"[]<=/#'\"\\- \n,1aA_", "string", "int8 ", "---"])).map("".join))
def test_any_text_is_read_or_refused_with_a_reason(text):
    for folder in ("msg", "srv", "action"):
        try:
            parse(folder, "pkg", "Name", text)
        except InvalidDefinition as error:
            assert error.reason
