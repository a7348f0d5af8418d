"""Shared by the tests of interfaces: recorded cases, packages in temporary folders, and hypothesis strategies."""

import json
from pathlib import Path

from hypothesis import strategies as st

from turtle_lesson.ros.idl.definition import parse
from turtle_lesson.ros.idl.generator import make_module
from turtle_lesson.ros.idl.model import InvalidDefinition
from turtle_lesson.ros.idl.names import FLOATS, bounds
from turtle_lesson.ros.idl.registry import Registry

DATA = Path(__file__).with_name("data")
ROBOT_CONTROLLER = {
    "msg/TurtleStatus.msg": "float32 x\nfloat32 y\nfloat32 theta\nfloat32 vel_x\nfloat32 vel_y\nfloat32 battery\n",
    "srv/NavigateTo.srv": "float32 x\nfloat32 y\nfloat32 theta\n---\nbool success\nfloat32 time_taken\n",
}
PRIMITIVES = ["bool", "byte", "char", "float32", "float64", "string", "wstring"] + [
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
]
MESSAGES = ["geometry_msgs/Point", "std_msgs/Header", "std_msgs/Empty", "turtlesim/Pose", "sensor_msgs/Range"]

built_in = Registry()


def faults_of(registry: Registry, package: str) -> list[InvalidDefinition]:
    """All that a build would refuse: the first fault of each definition file, in order of the names."""
    faults = []
    for interface in registry.package(package).interface_names():
        try:
            registry.module(package, interface)
        except InvalidDefinition as error:
            faults.append(error)
    return faults


def words(text):
    """The words of a text."""
    return text.split()


def recorded(name):
    """Cases recorded on a real ROS 2 Humble."""
    return json.loads((DATA / name).read_text(encoding="utf-8"))


def write_package(folder, files):
    """Write definition files below a folder, and give the folder."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return folder


def message_class(text, package="demo_msgs", name="Demo"):
    """The class of a message definition that lies in no file."""
    definition = parse("msg", package, name, text)
    return getattr(make_module(definition, built_in.resolve), name)


def find_class(name):
    """A class of the usual packages by its bare name."""
    for package in ("std_msgs", "geometry_msgs", "sensor_msgs", "builtin_interfaces"):
        if f"msg/{name}" in built_in.package(package).interface_names():
            return built_in.get(f"{package}/{name}")
    raise LookupError(name)


@st.composite
def type_texts(draw):
    """Types of fields as written: `float32`, `string<=5[3]`, `wstring[]`, `geometry_msgs/Point[]`, ..."""
    base = draw(st.sampled_from(PRIMITIVES + MESSAGES))
    if base in ("string", "wstring") and draw(st.booleans()):
        base = f"{base}<={draw(st.integers(1, 9))}"
    return base + draw(st.sampled_from(["", "", "[]", "[3]", "[<=4]"]))


@st.composite
def definition_texts(draw):
    """Definitions of up to six fields."""
    types = draw(st.lists(type_texts(), max_size=6))
    return "".join(f"{type_} field{index}\n" for index, type_ in enumerate(types))


def values_of(type_, get=built_in.get):
    """Values that a field of a type accepts; `get` gives the class of a message."""
    element = _elements(type_, get)
    if not type_.is_array:
        return element
    low, high = (type_.size, type_.size) if type_.is_fixed else (0, type_.size or 5)
    return st.lists(element, min_size=low, max_size=high)


def _elements(type_, get):
    if not type_.is_primitive:
        return messages(get(f"{type_.package}/{type_.folder}/{type_.base}"), get)
    if type_.base in FLOATS:
        return st.floats(*bounds(type_.base)) | st.sampled_from([float("inf"), float("-inf")])
    if type_.base in ("string", "wstring"):
        letters = st.characters(exclude_categories=["Cs"], exclude_characters="\0")
        return st.text(letters, max_size=type_.string_bound or 12)
    if type_.base == "bool":
        return st.booleans()
    if type_.base == "byte":
        return st.binary(min_size=1, max_size=1)
    return st.integers(*bounds(type_.base))


def messages(kind, get=built_in.get):
    """Messages of a class, with values for all fields."""
    fields = {field.name: values_of(field.type, get) for field in kind._DEFINITION.fields}
    return st.builds(lambda values: kind(**values), st.fixed_dictionaries(fields))


def any_messages():
    """Messages of classes that are made on the way."""
    return definition_texts().map(message_class).flatmap(messages)
