import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    config = os.path.join(get_package_share_directory('student_turtles'), 'config', 'params.yaml')
    return LaunchDescription([
        DeclareLaunchArgument('patrol', default_value='true'),
        Node(package='turtlesim', executable='turtlesim_node', name='sim', output='screen'),
        Node(package='student_turtles', executable='patrol', name='patrol', parameters=[config], output='screen',
             condition=IfCondition(LaunchConfiguration('patrol'))),
    ])
