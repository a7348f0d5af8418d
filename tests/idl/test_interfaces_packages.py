"""Every interface package that comes with ROS 2: its definitions are the real ones, and its messages travel."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from interface_cases import built_in, messages, words
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from turtle_lesson.ros.idl.cdr import deserialize, serialize
from turtle_lesson.ros.idl.definition import parse
from turtle_lesson.ros.idl.registry import SHARE, registry

HUMBLE, KILTED = get_typestore(Stores.ROS2_HUMBLE), get_typestore(Stores.ROS2_KILTED)
OF_THE_RECORDER = "rosbag2_interfaces/"  # what `ros2 bag` tells of its own files

PACKAGES = words(
    """
ackermann_msgs action_msgs action_tutorials_interfaces actionlib_msgs builtin_interfaces composition_interfaces
control_msgs diagnostic_msgs example_interfaces gazebo_msgs geometry_msgs lifecycle_msgs moveit_msgs nav2_msgs
nav_msgs object_recognition_msgs octomap_msgs px4_msgs rcl_interfaces rmw_dds_common rosgraph_msgs sensor_msgs
service_msgs shape_msgs statistics_msgs std_msgs std_srvs stereo_msgs tf2_msgs trajectory_msgs turtlebot3_msgs
turtlesim type_description_interfaces unique_identifier_msgs visualization_msgs
"""
)

MESSAGES = [
    f"{package}/{name}"
    for package in PACKAGES
    for name in built_in.package(package).interface_names()
    if name.startswith("msg/")
]
KNOWN_ELSEWHERE = [name for name in MESSAGES if name in HUMBLE.fielddefs or name in KILTED.fielddefs]


def definition_elsewhere(name: str) -> Any:
    """rosbags' own definition of a message: constants and fields, as Humble has them, or else Kilted."""
    return HUMBLE.fielddefs.get(name) or KILTED.fielddefs[name]


def as_text(described: Any) -> str:
    """rosbags' description of a type, as a definition file would say it."""
    kind, value = described
    if kind == Nodetype.BASE:
        return {"octet": "byte"}.get(value[0], value[0]) + (f"<={value[1]}" if value[1] else "")
    if kind == Nodetype.NAME:
        return value.replace("/msg/", "/")
    element, size = value
    bound = "<=" if kind == Nodetype.SEQUENCE and size else ""
    return f"{as_text(element)}[{bound}{size or ''}]"


def test_the_packages_are_all_there() -> None:
    assert built_in.packages() == PACKAGES


@pytest.mark.parametrize("name", KNOWN_ELSEWHERE)
def test_a_message_has_the_fields_and_constants_of_the_real_one(name: str) -> None:
    constants, fields = definition_elsewhere(name)
    definition: Any = built_in.definition(name)
    expected = [
        (member, as_text(described)) for member, described in fields if member != "structure_needs_at_least_one_member"
    ]
    assert [(field.name, str(field.type)) for field in definition.fields] == expected
    assert [(each.name, each.type, each.value) for each in definition.constants] == [tuple(each) for each in constants]


def test_no_message_that_humble_and_kilted_have_is_missing() -> None:
    theirs = {*HUMBLE.fielddefs, *KILTED.fielddefs}
    assert sorted(name for name in theirs if name not in MESSAGES and not name.startswith(OF_THE_RECORDER)) == []


@given(st.data())
def test_any_message_is_read_and_written_alike_by_another_library(data: st.DataObject) -> None:
    """rosbags reads our bytes with its own definition of the type, and writes the same bytes again."""
    name = data.draw(st.sampled_from(KNOWN_ELSEWHERE))
    kind = built_in.get(name)
    message = data.draw(messages(kind))
    written = serialize(message)
    store = HUMBLE if name in HUMBLE.fielddefs else KILTED
    theirs = store.deserialize_cdr(written, name)
    assert bytes(store.serialize_cdr(theirs, name)) == written
    assert repr(deserialize(written, kind)) == repr(message._wire_copy())


def test_every_built_in_definition_is_sound_and_its_default_message_travels() -> None:
    for package in PACKAGES:
        for interface in built_in.package(package).interface_names():
            kind = built_in.get(f"{package}/{interface}")
            assert f"{package}/{interface}" == kind._TYPE_NAME
            for part in kind._DEFINITION.parts or (kind._DEFINITION,):
                made = built_in.get(part.full_name)
                message = made()
                assert message._wire_copy() == message
                assert deserialize(serialize(message), made) == message, part.full_name


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("action_msgs/srv/CancelGoal", ["goal_info", "return_code goals_canceling"]),
        ("composition_interfaces/srv/ListNodes", ["", "full_node_names unique_ids"]),
        (
            "composition_interfaces/srv/LoadNode",
            [
                "package_name plugin_name node_name node_namespace log_level remap_rules parameters extra_arguments",
                "success error_message full_node_name unique_id",
            ],
        ),
        ("composition_interfaces/srv/UnloadNode", ["unique_id", "success error_message"]),
        ("diagnostic_msgs/srv/AddDiagnostics", ["load_namespace", "success message"]),
        ("diagnostic_msgs/srv/SelfTest", ["", "id passed status"]),
        ("example_interfaces/srv/AddTwoInts", ["a b", "sum"]),
        ("example_interfaces/action/Fibonacci", ["order", "sequence", "sequence"]),
        ("action_tutorials_interfaces/action/Fibonacci", ["order", "sequence", "partial_sequence"]),
        ("lifecycle_msgs/srv/ChangeState", ["transition", "success"]),
        ("lifecycle_msgs/srv/GetAvailableStates", ["", "available_states"]),
        ("lifecycle_msgs/srv/GetAvailableTransitions", ["", "available_transitions"]),
        ("lifecycle_msgs/srv/GetState", ["", "current_state"]),
        (
            "control_msgs/action/FollowJointTrajectory",
            [
                "trajectory multi_dof_trajectory path_tolerance component_path_tolerance goal_tolerance"
                " component_goal_tolerance goal_time_tolerance",
                "error_code error_string",
                "header joint_names desired actual error multi_dof_joint_names multi_dof_desired multi_dof_actual"
                " multi_dof_error",
            ],
        ),
        (
            "gazebo_msgs/srv/SpawnEntity",
            ["name xml robot_namespace initial_pose reference_frame", "success status_message"],
        ),
        (
            "gazebo_msgs/srv/SpawnModel",
            ["model_name model_xml robot_namespace initial_pose reference_frame", "success status_message"],
        ),
        ("moveit_msgs/action/ExecuteTrajectory", ["trajectory", "error_code", "state"]),
        (
            "moveit_msgs/action/MoveGroup",
            [
                "request planning_options",
                "error_code trajectory_start planned_trajectory executed_trajectory planning_time",
                "state",
            ],
        ),
        (
            "moveit_msgs/srv/GetCartesianPath",
            [
                "header start_state group_name link_name waypoints max_step jump_threshold prismatic_jump_threshold"
                " revolute_jump_threshold avoid_collisions path_constraints",
                "start_state solution fraction error_code",
            ],
        ),
        ("moveit_msgs/srv/GetPositionIK", ["ik_request", "solution error_code"]),
        (
            "nav2_msgs/action/NavigateToPose",
            [
                "pose behavior_tree",
                "result",
                "current_pose navigation_time estimated_time_remaining number_of_recoveries distance_remaining",
            ],
        ),
        ("nav2_msgs/action/ComputePathToPose", ["goal start planner_id use_start", "path planning_time", ""]),
        ("nav2_msgs/srv/IsPathValid", ["path", "is_valid invalid_pose_indices"]),
        ("nav2_msgs/srv/ManageLifecycleNodes", ["command", "success"]),
        ("nav_msgs/srv/GetMap", ["", "map"]),
        ("nav_msgs/srv/GetPlan", ["start goal tolerance", "plan"]),
        ("nav_msgs/srv/LoadMap", ["map_url", "map result"]),
        ("nav_msgs/srv/SetMap", ["map initial_pose", "success"]),
        ("rcl_interfaces/srv/GetLoggerLevels", ["names", "levels"]),
        ("rcl_interfaces/srv/SetLoggerLevels", ["levels", "results"]),
        ("sensor_msgs/srv/SetCameraInfo", ["camera_info", "success status_message"]),
        ("octomap_msgs/srv/GetOctomap", ["", "map"]),
        ("tf2_msgs/srv/FrameGraph", ["", "frame_yaml"]),
        (
            "tf2_msgs/action/LookupTransform",
            [
                "target_frame source_frame source_time timeout target_time fixed_frame advanced",
                "transform error",
                "",
            ],
        ),
        ("turtlebot3_msgs/action/Patrol", ["goal", "result", "state"]),
        ("turtlesim/action/RotateAbsolute", ["theta", "delta", "remaining"]),
        (
            "type_description_interfaces/srv/GetTypeDescription",
            [
                "type_name type_hash include_type_sources",
                "successful failure_reason type_description type_sources extra_information",
            ],
        ),
    ],
)
def test_services_and_actions_have_their_fields(name: str, parts: list[str]) -> None:
    found = [" ".join(field.name for field in part.fields) for part in built_in.definition(name).parts]
    assert found == parts


def test_defaults_that_the_packages_give() -> None:
    from geometry_msgs.msg import Pose, Quaternion, TransformStamped
    from rcl_interfaces.msg import ParameterDescriptor
    from type_description_interfaces.srv import GetTypeDescription

    assert Pose().orientation == TransformStamped().transform.rotation == Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
    assert ParameterDescriptor.READ_ONLY__DEFAULT is False
    assert GetTypeDescription.Request().include_type_sources is True


def test_constants_are_on_the_class_and_its_messages() -> None:
    from diagnostic_msgs.msg import DiagnosticStatus
    from lifecycle_msgs.msg import State, Transition
    from nav_msgs.srv import LoadMap
    from sensor_msgs.msg import BatteryState, JoyFeedback, NavSatFix, NavSatStatus, PointField, Range
    from shape_msgs.msg import SolidPrimitive
    from tf2_msgs.msg import TF2Error
    from visualization_msgs.msg import InteractiveMarkerControl, Marker

    assert (Marker.ARROW, Marker.SPHERE, Marker.TEXT_VIEW_FACING, Marker.MESH_RESOURCE) == (0, 2, 9, 10)
    assert (Marker.ADD, Marker.MODIFY, Marker.DELETE, Marker().DELETEALL) == (0, 0, 2, 3)
    assert InteractiveMarkerControl.MOVE_ROTATE == 6
    assert (PointField.FLOAT32, PointField().FLOAT64) == (7, 8)
    assert (NavSatFix.COVARIANCE_TYPE_KNOWN, NavSatStatus.STATUS_NO_FIX, Range.INFRARED) == (3, -1, 1)
    assert (BatteryState.POWER_SUPPLY_TECHNOLOGY_LIPO, JoyFeedback.TYPE_BUZZER) == (3, 2)
    assert (DiagnosticStatus.WARN, DiagnosticStatus().STALE) == (b"\x01", b"\x03")
    assert (State.PRIMARY_STATE_ACTIVE, Transition.TRANSITION_CALLBACK_ERROR) == (3, 99)
    assert (SolidPrimitive.CONE, TF2Error.EXTRAPOLATION_ERROR) == (4, 3)
    assert LoadMap.Response.RESULT_UNDEFINED_FAILURE == LoadMap.Response().RESULT_UNDEFINED_FAILURE == 255


def test_a_request_to_move_an_arm_is_filled_in_as_in_moveit_s_examples() -> None:
    """The fields of Humble (moveit_msgs 2.2.1): the limited link was renamed, and more fields came, in 2.3.0."""
    from moveit_msgs.action import MoveGroup
    from moveit_msgs.msg import (
        CollisionObject,
        Constraints,
        JointConstraint,
        MotionPlanRequest,
        MoveItErrorCodes,
        OrientationConstraint,
        PlanningSceneComponents,
    )
    from shape_msgs.msg import SolidPrimitive

    elbow = JointConstraint(joint_name="elbow", position=1.5, tolerance_above=0.01, tolerance_below=0.01, weight=1.0)
    goal = MoveGroup.Goal(request=MotionPlanRequest(group_name="arm", allowed_planning_time=5.0))
    goal.request.goal_constraints = [Constraints(joint_constraints=[elbow])]
    goal.planning_options.planning_scene_diff.is_diff = True
    assert deserialize(serialize(goal), MoveGroup.Goal) == goal
    assert goal.request.cartesian_speed_end_effector_link == ""
    assert not hasattr(goal.request, "cartesian_speed_limited_link")

    box = CollisionObject(id="box", primitives=[SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[1.0, 2.0, 3.0])])
    assert box.operation == CollisionObject.ADD == b"\x00"
    assert (CollisionObject.REMOVE, CollisionObject.MOVE) == (b"\x01", b"\x03")
    assert MoveGroup.Result().error_code == MoveItErrorCodes(val=0)
    assert (MoveItErrorCodes.SUCCESS, MoveItErrorCodes.FAILURE, MoveItErrorCodes.NO_IK_SOLUTION) == (1, 99999, -31)
    assert (MoveItErrorCodes.TIMED_OUT, MoveItErrorCodes.START_STATE_INVALID) == (-6, -26)
    assert (OrientationConstraint.ROTATION_VECTOR, PlanningSceneComponents.OBJECT_COLORS) == (1, 512)


def test_an_offboard_node_s_messages_are_those_of_px4_1_14() -> None:
    from px4_msgs.msg import ActuatorMotors, OffboardControlMode, TrajectorySetpoint, VehicleCommand, VehicleStatus

    assert list(OffboardControlMode.get_fields_and_field_types()) == words(
        "timestamp position velocity acceleration attitude body_rate actuator"
    )
    above = TrajectorySetpoint(position=[0.0, 0.0, -5.0], velocity=[float("nan")] * 3, yaw=-3.14)
    assert above.position.tolist() == [0.0, 0.0, -5.0]
    arm = VehicleCommand(command=VehicleCommand.VEHICLE_CMD_COMPONENT_ARM_DISARM, param1=1.0, from_external=True)
    assert (arm.command, VehicleCommand.VEHICLE_CMD_DO_SET_MODE, VehicleCommand.VEHICLE_CMD_NAV_LAND) == (400, 176, 21)
    assert VehicleCommand.VEHICLE_CMD_SET_GPS_GLOBAL_ORIGIN == 100000
    assert (VehicleStatus.ARMING_STATE_STANDBY, VehicleStatus.ARMING_STATE_ARMED) == (1, 2)
    assert (VehicleStatus.NAVIGATION_STATE_OFFBOARD, VehicleStatus.NAVIGATION_STATE_MAX) == (14, 23)
    assert len(ActuatorMotors().control) == ActuatorMotors.NUM_CONTROLS == 12


# How programs in the wild get at them


def test_messages_are_imported_in_every_way() -> None:
    import nav_msgs.msg as nav
    import tf2_msgs.msg
    from nav_msgs.msg import OccupancyGrid
    from nav_msgs.msg._occupancy_grid import OccupancyGrid as Same

    assert nav.OccupancyGrid is OccupancyGrid is Same
    assert importlib.import_module("nav_msgs.msg").OccupancyGrid is OccupancyGrid
    assert getattr(importlib.import_module("nav_msgs.srv"), "GetMap").Response().map == OccupancyGrid()  # noqa: B009
    assert tf2_msgs.msg.TFMessage().transforms == []
    scope: dict[str, Any] = {}
    exec("from trajectory_msgs.msg import *", scope)
    assert {"JointTrajectory", "JointTrajectoryPoint", "MultiDOFJointTrajectory"} <= set(scope)


def test_turtlesim_has_the_name_of_newer_releases_too() -> None:
    """Since Kilted its interfaces are in turtlesim_msgs: here these are the same classes under another name."""
    import turtlesim.msg
    import turtlesim_msgs.action
    import turtlesim_msgs.msg
    from turtlesim_msgs.msg import Pose
    from turtlesim_msgs.srv._spawn import Spawn

    assert Pose is turtlesim.msg.Pose
    assert built_in.get("turtlesim_msgs/msg/Pose")._TYPE_NAME == "turtlesim/msg/Pose"
    assert Spawn.Request(name="t").name == "t"
    assert turtlesim_msgs.action.RotateAbsolute.Goal().theta == 0.0
    with pytest.raises(ImportError, match="Did you mean 'Pose'"):
        from turtlesim_msgs.msg import Poze  # noqa: F401


def test_grids_and_paths_hold_what_programs_put_in() -> None:
    from nav_msgs.msg import OccupancyGrid, Odometry, Path

    grid = OccupancyGrid()
    grid.data = [-1, 0, 100]
    assert (grid.data.typecode, grid.data.tolist()) == ("b", [-1, 0, 100])
    grid.data = np.full(4, 100, np.int8).tolist()
    assert Odometry().pose.covariance.shape == (36,)
    with pytest.raises(AssertionError, match="'poses' field must be a set or sequence and each value of type 'Pose"):
        Path().poses = [Odometry()]


COMMENTS = sorted(SHARE.glob("*/comments.txt"))


@pytest.mark.parametrize("file", COMMENTS, ids=lambda file: file.parent.name)
def test_comments_are_about_what_is_there_and_change_no_definition(file: Path) -> None:
    package = file.parent.name
    sections = [line[1:-1] for line in file.read_text().splitlines() if line.startswith("[")]
    assert len(set(sections)) == len(sections)
    for interface in sections:
        folder, name = interface.split("/")
        text, commented = registry.text(package, interface), registry.text(package, interface, comments=True)
        bare = "\n".join(line.partition("#")[0].rstrip() for line in commented.splitlines())
        assert [line for line in bare.splitlines() if line] == [
            bare for line in text.splitlines() if (bare := line.partition("#")[0].rstrip())
        ]
        _, _, rest = file.read_text().partition(f"[{interface}]\n")
        said = [line for line in rest.partition("\n[")[0].splitlines() if line and line != "---"]
        assert all(line.partition(": ")[2] in commented for line in said if not line.startswith("#")), interface
        assert commented.count("#") == text.count("#") + len(said), interface
        assert max(map(len, commented.splitlines())) <= 120, interface
        assert parse(folder, package, name, commented) is not None
