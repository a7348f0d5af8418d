from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution, TextSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    colours = {"red": "200"}
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    [PathJoinSubstitution([FindPackageShare("turtle_party"), "launch", "party_launch.py"])]
                ),
                launch_arguments={
                    "turtlesim_ns": "given",
                    "use_given_red": "True",
                    "red": TextSubstitution(text=str(colours["red"])),
                }.items(),
            )
        ]
    )
