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


_NAMES = {
    _WINDOWS: _words("rviz rviz2 rqt plotjuggler image_view joint_state_publisher_gui gzclient"),
    _GAZEBO: _words("gazebo gzserver gz ign ignition turtlebot3_gazebo turtlebot4_ignition_bringup"),
    _XACRO: ("xacro",),
    _OTHER: _words(
        """
        action_tutorials_cpp ament_index_cpp apriltag_ros async_web_server_cpp camera_ros class_loader composition
        controller_manager depth_image_proc diagnostic_aggregator diff_drive_controller
        dynamixel_workbench filters foxglove_bridge generate_parameter_library gripper_controllers
        hardware_interface hls_lfcd_lds_driver image_geometry image_pipeline image_proc image_publisher image_tools
        image_transport intra_process_demo joint_state_broadcaster joint_state_publisher
        joint_trajectory_controller joy joy_linux joy_teleop kdl_parser laser_filters laser_geometry ld08_driver lifecycle
        logging_demo micro_ros_agent nav2_bringup octomap_server orocos_kdl pcl_conversions pcl_ros pluginlib
        pointcloud_to_laserscan rmf_demos robot_localization robot_state_publisher ros2_control ros2_controllers
        rosbridge_server rosapi rplidar_ros rtabmap_ros rtabmap_slam slam_gmapping slam_toolbox
        spatio_temporal_voxel_layer stereo_image_proc teleop_twist_joy tf2_bullet tf2_eigen topic_tools tracetools_launch
        teleop_twist_keyboard turtle_tf2_cpp twist_mux urdf urdf_tutorial urdfdom usb_cam v4l2_camera velodyne
        velodyne_driver velodyne_pointcloud vision_opencv web_video_server zed_wrapper
        Boost CURL Eigen OpenCV PCL OpenMP PkgConfig Qt5 Qt5Widgets SDL2 SDL Protobuf yaml-cpp yaml_cpp_vendor
        eigen3_cmake_module backward_ros behaviortree_cpp behaviortree_cpp_v3
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
