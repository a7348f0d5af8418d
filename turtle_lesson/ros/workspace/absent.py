"""What a robot's ROS 2 has and this simulation has not: windows, Gazebo, drivers and other C++ packages, and why.

The names are those of packages in the ROS index (https://index.ros.org), and of programs that launch files start.
"""

from __future__ import annotations

from pathlib import Path

from .errors import NotHereError

_WINDOWS = "there are no windows here; lesson.dashboard(), lesson.scene() and the lesson's plots draw into the page"
_GAZEBO = "there is no Gazebo here; the simulated world is turtlesim"
_XACRO = "the Python package xacro is not installed: pip install xacro (in a notebook: %pip install xacro)"
_OTHER = "it is not part of this simulation"


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


_WITH_MODULES = _words(
    """
    image_geometry image_tools image_transport joint_state_publisher joy_teleop laser_geometry pcl_ros
    robot_localization robot_state_publisher slam_toolbox teleop_twist_keyboard
    """
)
"""Packages that have programs for launch files, and modules for programs."""

_ONLY_IMPORTED = _words(
    """
    angles bond can_msgs controller_manager_msgs diagnostic_updater geographic_msgs grid_map_msgs
    interactive_markers irobot_create_msgs launch_pytest launch_testing launch_testing_ros map_msgs mavros_msgs
    moveit moveit_py nav2_common nav2_simple_commander pcl_msgs pendulum_msgs pointcloud2_msgs py_trees_ros
    python_qt_binding qt_gui rclpy_message_converter ros2_numpy ros2bag ros2cli ros2node ros2param ros2pkg ros2run
    ros2topic ros_gz_interfaces rosbag2_py rqt_gui rqt_gui_py sensor_msgs_py smach smach_ros test_msgs tf2_kdl
    tf2_sensor_msgs ur_msgs vision_msgs webots_ros2_driver
    """
)
"""Packages that programs import, and launch files and builds hardly ever name."""

_NAMES = {
    _WINDOWS: _words("rviz rviz2 rqt plotjuggler image_view joint_state_publisher_gui gzclient"),
    _GAZEBO: _words("gazebo gzserver gz ign ignition turtlebot3_gazebo turtlebot4_ignition_bringup"),
    _XACRO: ("xacro",),
    _OTHER: _WITH_MODULES
    + _words(
        """
        action_tutorials_cpp ament_index_cpp apriltag_ros async_web_server_cpp camera_ros class_loader composition
        controller_manager depth_image_proc diagnostic_aggregator diff_drive_controller dynamixel_workbench filters
        foxglove_bridge generate_parameter_library gripper_controllers hardware_interface hls_lfcd_lds_driver
        image_pipeline image_proc image_publisher intra_process_demo joint_state_broadcaster
        joint_trajectory_controller joy joy_linux kdl_parser laser_filters ld08_driver lifecycle logging_demo
        micro_ros_agent nav2_bringup octomap_server orocos_kdl pcl_conversions pluginlib pointcloud_to_laserscan
        rmf_demos ros2_control ros2_controllers rosbridge_server rosapi rplidar_ros rtabmap_ros rtabmap_slam
        slam_gmapping spatio_temporal_voxel_layer stereo_image_proc teleop_twist_joy tf2_bullet tf2_eigen
        topic_tools tracetools_launch turtle_tf2_cpp twist_mux urdf urdf_tutorial urdfdom usb_cam v4l2_camera
        velodyne velodyne_driver velodyne_pointcloud vision_opencv web_video_server zed_wrapper Boost CURL Eigen
        OpenCV PCL OpenMP PkgConfig Qt5 Qt5Widgets SDL2 SDL Protobuf yaml-cpp yaml_cpp_vendor eigen3_cmake_module
        backward_ros behaviortree_cpp behaviortree_cpp_v3
        """
    ),
}
_BEGINNINGS = {
    _WINDOWS: _words("rqt_ rviz_"),
    _GAZEBO: _words("gazebo_ ros_gz ros_ign gz_ gz- ign_ ignition- webots_ros2"),
    _OTHER: _words(
        """
        ackermann_steering_ cartographer costmap_ depthai_ dwb_ examples_rclcpp_ librealsense moveit nav2_
        realsense2_ sick_scan turtlebot3_ turtlebot4_ urg_node ur_robot_driver
        """
    ),
}
_INTERFACES = ("_msgs", "_interfaces", "_srvs", "_actions")
_PLACE = Path("/opt/ros/not_here/share")


def why_not_here(name: str) -> str:
    """Why a package or program that robots have is not available; nothing for a name that is none of theirs."""
    for why, names in _NAMES.items():
        if name in names:
            return why
    for why, beginnings in _BEGINNINGS.items():
        if name.startswith(beginnings) and not name.endswith(_INTERFACES):
            return why
    return ""


_INSTEAD = {
    "rosbag2_py": " Bags are recorded, played and described by `ros2 bag` and by lesson.record().",
    "sensor_msgs_py": " The messages themselves, such as PointCloud2, are in sensor_msgs.msg.",
    "tf2_sensor_msgs": " The types of geometry_msgs can be transformed: import tf2_geometry_msgs.",
}


def missing_module(name: str) -> str:
    """A sentence about a package that robots have and that cannot be imported here; nothing for every other name."""
    if name not in _WITH_MODULES and name not in _ONLY_IMPORTED:
        return ""
    return (
        f"{name} is a package of ROS 2 that is not available here: a program that needs it runs on a robot "
        f"where it is installed (sudo apt install ros-$ROS_DISTRO-{name.replace('_', '-')}).{_INSTEAD.get(name, '')}"
    )


def place_of(name: str) -> Path:
    """A folder that does not exist, and stands for an absent package's share folder in a launch file."""
    return _PLACE / name


def package_of(path: str | Path) -> str:
    """The absent package whose folder a path leads into; nothing for every other path."""
    path = Path(path)
    return path.relative_to(_PLACE).parts[0] if path.is_relative_to(_PLACE) and path != _PLACE else ""


def left_out(what: str, name: str) -> NotHereError:
    """The error for something of an absent package, such as its program or launch file."""
    return NotHereError(what, why_not_here(name))
