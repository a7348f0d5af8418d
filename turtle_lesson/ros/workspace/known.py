"""The packages that a fresh ROS 2 Humble has, as far as builds in the simulation ask for them."""

from __future__ import annotations


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


CMAKE_PACKAGES = _words(
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

PYTHON_PACKAGES = _words(
    """
    launch launch_ros launch_xml launch_yaml launch_testing launch_testing_ros ament_index_python ament_copyright
    ament_flake8 ament_pep257 ros2launch ros2run ros2cli ros2pkg ros2topic rosidl_adapter rosidl_cli tf2_ros_py
    rosidl_parser rosidl_runtime_py rosbag2_py sensor_msgs_py tf_transformations
    """
)
"""Packages that package.xml may name, but that `find_package` cannot find: they are Python alone."""

CMAKE_COMMANDS = _words(
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

AMENT_COMMANDS = _words(
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
