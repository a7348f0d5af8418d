"""What a robot's ROS 2 has: the packages that builds find, and those that are not here (windows, Gazebo, drivers), and why.

The names are those of packages in the ROS index (https://index.ros.org), and of programs that launch files start.
"""

from __future__ import annotations

from pathlib import Path

from .package import NotHereError

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


def _set_of(text: str) -> frozenset[str]:
    return frozenset(text.split())


CMAKE_PACKAGES = _set_of(
    """
    ament_cmake ament_cmake_auto ament_cmake_core ament_cmake_gtest ament_cmake_gmock ament_cmake_python
    ament_cmake_pytest ament_cmake_ros ament_cmake_test ament_index_cpp ament_lint_auto ament_lint_common
    ament_cmake_copyright ament_cmake_flake8 ament_cmake_pep257 ament_cmake_cpplint ament_cmake_cppcheck
    ament_cmake_lint_cmake ament_cmake_uncrustify ament_cmake_xmllint
    rosidl_cmake rosidl_default_generators rosidl_default_runtime rosidl_generator_py rosidl_typesupport_c
    rosidl_typesupport_cpp rosidl_runtime_c rosidl_runtime_cpp
    rclpy rclcpp rclcpp_action rclcpp_components rclcpp_lifecycle rcl rcutils rmw class_loader pluginlib
    tf2 tf2_py tf2_ros tf2_geometry_msgs tf2_sensor_msgs tf2_tools message_filters rosbag2_cpp launch_testing_ament_cmake
    cv_bridge xacro Python3 PythonInterp Threads Eigen3
    """
)
"""What `find_package` finds, besides packages of interfaces."""

PYTHON_PACKAGES = _set_of(
    """
    launch launch_ros launch_xml launch_yaml launch_testing launch_testing_ros ament_index_python ament_copyright
    ament_flake8 ament_pep257 ros2launch ros2run ros2cli ros2pkg ros2topic rosidl_adapter rosidl_cli tf2_ros_py
    rosidl_parser rosidl_runtime_py rosbag2_py sensor_msgs_py tf_transformations
    """
)
"""Packages that package.xml may name, but that `find_package` cannot find: they are Python alone."""

CMAKE_COMMANDS = _set_of(
    """
    add_compile_definitions add_compile_options add_custom_command add_custom_target add_definitions add_dependencies
    add_executable add_library add_link_options add_subdirectory add_test block break build_command cmake_language
    cmake_minimum_required cmake_parse_arguments cmake_path cmake_policy configure_file continue
    create_test_sourcelist define_property else elseif enable_language enable_testing endblock endforeach
    endfunction endif endmacro endwhile execute_process export file find_file find_library find_package find_path
    find_program foreach function get_cmake_property get_directory_property get_filename_component get_property
    get_source_file_property get_target_property get_test_property if include include_directories
    include_external_msproject include_guard install link_directories link_libraries list load_cache macro
    mark_as_advanced math message option project return separate_arguments set set_directory_properties set_property
    set_source_files_properties set_target_properties set_tests_properties site_name source_group string
    target_compile_definitions target_compile_features target_compile_options target_include_directories
    target_link_directories target_link_libraries target_link_options target_precompile_headers target_sources
    try_compile try_run unset variable_watch while
    """
)
"""The commands that CMake itself has."""

AMENT_COMMANDS = _set_of(
    """
    ament_package ament_export_dependencies ament_export_include_directories ament_export_interfaces
    ament_export_libraries ament_export_link_flags ament_export_targets ament_export_definitions
    ament_environment_hooks ament_index_register_resource ament_index_register_package ament_index_has_resource
    ament_index_get_resource ament_index_get_resources ament_index_get_prefix_path ament_register_extension
    ament_execute_extensions ament_target_dependencies ament_include_directories_order ament_libraries_deduplicate
    ament_python_install_package ament_python_install_module ament_get_python_install_dir ament_package_xml
    ament_add_test ament_add_test_label ament_add_default_options ament_generate_version_header ament_uninstall_add_rule
    """
)
"""What `find_package(ament_cmake)` brings."""

COMMANDS_OF = {
    "ament_cmake": AMENT_COMMANDS,
    "ament_cmake_auto": AMENT_COMMANDS
    | {
        "ament_auto_package",
        "ament_auto_find_build_dependencies",
        "ament_auto_add_executable",
        "ament_auto_add_library",
        "ament_auto_find_test_dependencies",
        "ament_auto_generate_code",
    },
    "ament_cmake_core": AMENT_COMMANDS - {"ament_python_install_package", "ament_target_dependencies"},
    "ament_cmake_python": frozenset(
        {"ament_python_install_package", "ament_python_install_module", "ament_get_python_install_dir"}
    ),
    "ament_cmake_ros": AMENT_COMMANDS,
    "ament_cmake_pytest": frozenset({"ament_add_pytest_test", "ament_find_pytest", "ament_has_pytest_version"}),
    "ament_cmake_gtest": frozenset({"ament_add_gtest", "ament_find_gtest", "ament_add_gtest_executable"}),
    "ament_cmake_gmock": frozenset({"ament_add_gmock", "ament_find_gmock"}),
    "ament_lint_auto": frozenset({"ament_lint_auto_find_test_dependencies"}),
    "rosidl_default_generators": AMENT_COMMANDS
    | {"rosidl_generate_interfaces", "rosidl_get_typesupport_target", "rosidl_target_interfaces"},
    "rosidl_cmake": AMENT_COMMANDS
    | {"rosidl_generate_interfaces", "rosidl_get_typesupport_target", "rosidl_target_interfaces"},
    "rclcpp_components": frozenset({"rclcpp_components_register_node", "rclcpp_components_register_nodes"}),
    "launch_testing_ament_cmake": frozenset({"add_launch_test"}),
    "rclcpp": AMENT_COMMANDS,
    "Python3": frozenset({"python3_add_library"}),
}
"""The commands that each package brings to those who find it."""


def brought_by(command: str) -> list[str]:
    """The packages that bring a command, the most usual first."""
    return [package for package, commands in COMMANDS_OF.items() if command in commands]
