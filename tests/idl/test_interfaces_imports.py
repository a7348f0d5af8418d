"""Interface packages are imported like any other, and come and go with the workspace."""

import importlib
import importlib.util
import subprocess
import sys

import pytest
from interface_cases import faults_of, write_package

from turtle_lesson.ros.idl.model import InvalidDefinition
from turtle_lesson.ros.idl.registry import Registry, install_finder, uninstall_finder

DEMO = {
    "msg/Status.msg": "float32 battery\n",
    "msg/StatusList.msg": "Status[] list\nstd_msgs/Header header\n",
    "srv/Charge.srv": "float32 to\n---\nbool done\n",
    "action/Drive.action": "float32 far\n---\nfloat32 near\n---\nfloat32 left\n",
}


@pytest.fixture
def registry():
    """A registry of its own, found by import statements during one test."""
    before = set(sys.modules)
    registry = Registry()
    install_finder(registry)
    yield registry
    uninstall_finder(registry)
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in (*registry.packages(), "demo_msgs", "user_msgs"):
            del sys.modules[name]


@pytest.fixture
def demo(registry, tmp_path):
    """The folder of a package demo_msgs that the registry knows."""
    registry.add("demo_msgs", write_package(tmp_path / "demo_msgs", DEMO))
    return tmp_path / "demo_msgs"


def run(code, *path):
    """Standard output of a program in a fresh interpreter."""
    root = str(importlib.import_module("turtle_lesson").__path__[0]).rpartition("turtle_lesson")[0]
    start = f"import sys; sys.path[:0] = {[root, *map(str, path)]!r}\n"
    done = subprocess.run([sys.executable, "-c", start + code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


# Importing


def test_messages_services_and_actions_are_imported(demo):
    from demo_msgs.action import Drive
    from demo_msgs.msg import Status, StatusList
    from demo_msgs.srv import Charge

    assert StatusList(list=[Status(battery=1.0)]).list[0].battery == 1.0
    assert Charge.Request(to=2.0).to == 2.0
    assert Drive.Goal(far=3.0).far == 3.0


def test_a_module_lists_what_it_has(demo):
    import demo_msgs.msg

    assert repr(demo_msgs.msg) == "<module 'demo_msgs.msg' (made from demo_msgs/msg)>"
    assert demo_msgs.msg.__all__ == ["Status", "StatusList"]
    assert {"Status", "StatusList"} <= set(dir(demo_msgs.msg))
    assert demo_msgs.msg.Status is demo_msgs.msg.Status
    assert sys.modules["demo_msgs.msg._status"].Status is demo_msgs.msg.Status
    scope = {}
    exec("from demo_msgs.msg import *", scope)
    assert scope["StatusList"] is demo_msgs.msg.StatusList


def test_classes_are_made_when_they_are_first_asked_for(demo):
    import demo_msgs.msg

    assert not [name for name in sys.modules if name.startswith("demo_msgs.msg._")]
    assert "Status" not in vars(demo_msgs.msg)


def test_import_and_registry_give_the_same_class(demo, registry):
    from demo_msgs.msg import Status

    assert registry.get("demo_msgs/msg/Status") is registry.get("demo_msgs/Status") is Status
    assert registry.get("demo_msgs/srv/Charge_Request") is registry.get("demo_msgs/srv/Charge").Request
    drive = registry.get("demo_msgs/action/Drive")
    assert registry.get("demo_msgs/Drive_SendGoal_Request") is drive.Impl.SendGoalService.Request


def test_a_missing_name_is_an_import_error_with_a_suggestion(demo):
    with pytest.raises(ImportError) as caught:
        from demo_msgs.msg import Statsu  # noqa: F401
    assert str(caught.value) == "cannot import name 'Statsu' from 'demo_msgs.msg'. Did you mean 'Status'?"
    assert type(caught.value) is ImportError

    import demo_msgs.msg

    assert not hasattr(demo_msgs.msg, "Statsu")
    with pytest.raises(AttributeError, match=r"no attribute 'Statsu'\. Did you mean 'Status'\?"):
        _ = demo_msgs.msg.Statsu


def test_no_suggestion_is_looked_for_where_all_modules_are_asked(demo, monkeypatch):
    import demo_msgs.msg

    monkeypatch.setattr("turtle_lesson.ros.idl.registry.Package.advice", None)
    assert getattr(demo_msgs.msg, "__file__", None) is None


def test_parts_of_a_service_are_not_imported_as_in_humble(demo):
    with pytest.raises(ImportError, match=r"Did you mean 'Charge'\?"):
        from demo_msgs.srv import Charge_Request  # noqa: F401


def test_packages_and_folders_that_are_not_there(registry, tmp_path):
    registry.add("demo_msgs", write_package(tmp_path, {"msg/Status.msg": ""}))
    for name in ("nope_msgs", "nope_msgs.msg", "demo_msgs.srv", "demo_msgs.msg._nope", "demo_msgs.msg.lower"):
        with pytest.raises(ModuleNotFoundError, match=r"No module named '(nope_msgs|demo_msgs)"):
            importlib.import_module(name)


def test_a_faulty_definition_is_told_with_file_and_line(registry, tmp_path):
    write_package(tmp_path, {"msg/Bad.msg": "float32 x\nfloat y\n", "msg/User.msg": "Bad bad\n", "msg/Good.msg": ""})
    registry.add("demo_msgs", tmp_path)
    with pytest.raises(InvalidDefinition) as caught:
        from demo_msgs.msg import User  # noqa: F401
    assert str(caught.value).startswith("demo_msgs/msg/Bad.msg, line 2, 'float y': 'float' is an invalid")
    assert caught.value.file == str(tmp_path / "msg" / "Bad.msg")
    from demo_msgs.msg import Good  # noqa: F401

    assert {error.file for error in faults_of(registry, "demo_msgs")} == {str(tmp_path / "msg" / "Bad.msg")}


def test_a_message_cannot_contain_itself(registry, tmp_path):
    registry.add("demo_msgs", write_package(tmp_path, {"msg/A.msg": "B b", "msg/B.msg": "int8 x\nA[] a"}))
    with pytest.raises(InvalidDefinition, match=r"itself: demo_msgs/msg/A -> demo_msgs/msg/B -> demo_msgs/msg/A"):
        registry.get("demo_msgs/msg/A")


def test_installing_twice_changes_nothing(registry):
    before = list(sys.meta_path)
    install_finder(registry)
    assert sys.meta_path == before


# Real Python packages


def test_a_real_package_comes_first_and_gets_its_messages_beside(demo, registry, tmp_path, monkeypatch):
    (tmp_path / "code" / "demo_msgs").mkdir(parents=True)
    (tmp_path / "code" / "demo_msgs" / "__init__.py").write_text("HERE = True\n")
    monkeypatch.syspath_prepend(tmp_path / "code")

    import demo_msgs
    from demo_msgs.msg import Status

    assert demo_msgs.HERE
    assert Status().battery == 0.0
    registry.remove("demo_msgs")
    assert sys.modules["demo_msgs"] is demo_msgs
    assert not hasattr(demo_msgs, "msg")
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("demo_msgs.msg")


def test_a_sourced_ros_is_never_hidden(registry, tmp_path, monkeypatch):
    write_package(tmp_path, {"std_msgs/__init__.py": "", "std_msgs/msg/__init__.py": "String = 'the real one'\n"})
    for name in [each for each in sys.modules if each.partition(".")[0] == "std_msgs"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.syspath_prepend(tmp_path)
    from std_msgs.msg import String

    assert String == "the real one"


def test_a_mere_folder_does_not_hide_the_messages(demo, monkeypatch):
    monkeypatch.syspath_prepend(demo.parent)  # where demo_msgs/msg/ lies, as in a workspace's src
    from demo_msgs.msg import Status

    assert Status().battery == 0.0


def test_importing_does_not_load_what_is_slow_to_load():
    code = """
import turtle_lesson
before = set(sys.modules)
from turtle_lesson.ros.idl.registry import install_finder, uninstall_finder
install_finder()
from geometry_msgs.msg import Twist
Twist()
print(sorted({"numpy", "rosbags"} & (set(sys.modules) - before)))
"""
    assert run(code) == "[]\n"


# Coming and going


def test_a_changed_definition_gives_new_classes_after_remove_and_add(demo, registry):
    from demo_msgs.msg import Status as Old

    registry.remove("demo_msgs")
    assert not [name for name in sys.modules if name.startswith("demo_msgs")]
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("demo_msgs.msg")
    write_package(demo, {"msg/Status.msg": "float32 charge\n"})
    registry.add("demo_msgs", demo)
    from demo_msgs.msg import Status

    assert Status is not Old
    assert repr(Status(charge=1.0)) == "demo_msgs.msg.Status(charge=1.0)"
    assert repr(Old(battery=1.0)) == "demo_msgs.msg.Status(battery=1.0)"


def test_adding_again_replaces(demo, registry):
    assert registry.get("demo_msgs/Status")().battery == 0.0
    write_package(demo, {"msg/Status.msg": "string state\n"})
    registry.add("demo_msgs", demo)
    assert registry.get("demo_msgs/Status")().state == ""


def test_users_of_a_changed_message_change_with_it(demo, registry, tmp_path):
    registry.add("user_msgs", write_package(tmp_path / "user", {"msg/Fleet.msg": "demo_msgs/Status[] robots\n"}))
    import user_msgs.msg

    old = user_msgs.msg.Fleet
    write_package(demo, {"msg/Status.msg": "string state\n"})
    registry.add("demo_msgs", demo)
    from user_msgs.msg import Fleet

    assert Fleet is not old
    Fleet(robots=[registry.get("demo_msgs/Status")(state="ok")])


def test_only_files_that_are_named_count(demo, registry):
    registry.add("demo_msgs", demo, ["msg/Status.msg", "./srv/Charge.srv"])
    assert registry.package("demo_msgs").interface_names() == ["msg/Status", "srv/Charge"]
    with pytest.raises(ImportError, match=r"msg/StatusList\.msg is there, but CMakeLists\.txt does not name it"):
        from demo_msgs.msg import StatusList  # noqa: F401
    registry.add("demo_msgs", demo, ["msg/Nope.msg"])
    with pytest.raises(InvalidDefinition, match=r"demo_msgs/msg/Nope\.msg: the file cannot be read"):
        registry.get("demo_msgs/msg/Nope")


def test_a_built_in_package_can_be_replaced_for_a_while(registry, tmp_path):
    registry.add("std_msgs", write_package(tmp_path, {"msg/String.msg": "string text\n"}))
    assert registry.get("std_msgs/String")(text="x").text == "x"
    registry.remove("std_msgs")
    assert registry.get("std_msgs/String")(data="x").data == "x"


# Asking the registry


def test_the_registry_knows_names_and_texts(demo, registry):
    assert {"demo_msgs", "geometry_msgs", "turtlesim", "std_srvs"} <= set(registry.packages())
    names = ["msg/Status", "msg/StatusList", "srv/Charge", "action/Drive"]
    assert registry.package("demo_msgs").interface_names() == names
    assert registry.text("demo_msgs", "srv/Charge") == DEMO["srv/Charge.srv"]
    assert registry.definition("demo_msgs/msg/Status").fields[0].name == "battery"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "geometry_msgs/msg/Twst",
            "the package 'geometry_msgs' has no interface 'msg/Twst'. Did you mean 'Twist'?",
        ),
        (
            "geometry_mgs/msg/Twist",
            "there is no interface package 'geometry_mgs'. Did you mean 'geometry_msgs'?",
        ),
        (
            "Twist",
            "'Twist' is not a name such as 'geometry_msgs/msg/Twist'. Did you mean 'geometry_msgs/msg/Twist'?",
        ),
        ("geometry_msgs/msgs/Twist", "'geometry_msgs/msgs/Twist' is not a name such as"),
        ("std_srvs/srv/Empty_Nope", "'std_srvs/srv/Empty_Nope' is not a part of a service or action"),
        ("zzz/msg/X", "there is no interface package 'zzz'."),
    ],
)
def test_what_the_registry_does_not_know(name, text):
    with pytest.raises(LookupError) as caught:
        Registry().get(name)
    assert str(caught.value).startswith(text)


def test_a_package_needs_a_proper_name(registry, tmp_path):
    with pytest.raises(InvalidDefinition, match="'Demo' is an invalid package name"):
        registry.add("Demo", tmp_path)
