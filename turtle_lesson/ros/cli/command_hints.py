"""Words that belong to other terminals, of a robot or of ROS 1, and what to do here instead."""

from __future__ import annotations

from collections.abc import Sequence

_ROS_1 = {
    "catkin_create_pkg": "ros2 pkg create",
    "catkin_make": "colcon build",
    "catkin": "colcon build",
    "rosbag": "ros2 bag",
    "roslaunch": "ros2 launch",
    "rosmsg": "ros2 interface",
    "rosnode": "ros2 node",
    "rospack": "ros2 pkg",
    "rosparam": "ros2 param",
    "rosrun": "ros2 run",
    "rosservice": "ros2 service",
    "rossrv": "ros2 interface",
    "rostopic": "ros2 topic",
}

_PICTURES = (
    "there are no windows here; lesson.plot_graph(), plot_path(), plot_status() and plot_scan() draw into the page"
)
_NO_INSTALLING = "nothing needs to be installed here: ROS 2 is simulated, and everything that the lesson needs is there"
_EDITOR = "no editor here: open the file in JupyterLab's list at the left, or begin a cell with %%writefile FILE"
_SCRIPT = "python3 FILE runs a file, and ros2 run the program of a package; !python3 is the Python of your computer"
_SHELL = "type commands into the cell, as in a terminal; bash FILE runs the commands in a file that is here"

_HERE = {
    "apt": _NO_INSTALLING,
    "apt-get": _NO_INSTALLING,
    "bash": _SHELL,
    "clear": "JupyterLab's menu Edit clears the outputs of cells",
    "cmake": "colcon build does that, from a package's CMakeLists.txt",
    "code": _EDITOR,
    "emacs": _EDITOR,
    "gazebo": "the simulated world is there already: turtlesim, which start() starts",
    "gedit": _EDITOR,
    "launch_test": "launch_testing is not available here; write tests with pytest instead",
    "make": "colcon build does that, from a package's CMakeLists.txt",
    "nano": _EDITOR,
    "pip3": "%pip install NAME installs into this notebook's Python",
    "python": _SCRIPT,
    "python3": _SCRIPT,
    "roscore": "ROS 2 needs none: its nodes find one another",
    "rosdep": _NO_INSTALLING,
    "rqt": _PICTURES,
    "rqt_console": _PICTURES,
    "rqt_graph": _PICTURES,
    "rqt_plot": _PICTURES,
    "rviz": _PICTURES,
    "rviz2": _PICTURES,
    "sh": _SHELL,
    "sudo": _NO_INSTALLING,
    "vi": _EDITOR,
    "vim": _EDITOR,
}

_ON_THE_COMPUTER = frozenset((
    "awk", "curl", "date", "df", "diff", "docker", "du", "find", "git", "htop", "less", "man", "more", "ping", "ps", "sed",
    "ssh", "tar", "tee", "top", "tree", "unzip", "wget", "which", "whoami",
))  # fmt: skip

ELSEWHERE = frozenset({*_ROS_1, *_HERE, *_ON_THE_COMPUTER})
"""All these words."""

NEVER_PYTHON = frozenset({*_ROS_1, *_HERE} - {"bash", "catkin", "code", "make", "python", "sudo", "vi"})
"""Those that no program would use as a variable, so that one alone on a line is meant for a terminal."""


def advice(words: Sequence[str]) -> str:
    """A sentence on what to do instead of a command; nothing for a word that is none of these."""
    name = words[0]
    if name.startswith("!"):
        return f"the ! runs the command on your computer, which has no {name[1:]}; without the ! it runs here"
    if name == "sudo" and words[1:2] in (["ros2"], ["colcon"]):
        return f"{words[1]} needs no sudo, neither here nor on a robot"
    if name in _ROS_1:
        return f"that is ROS 1; in ROS 2 it is {' '.join([_ROS_1[name], *words[1:]])}"
    if name in _ON_THE_COMPUTER:
        return f"not available in this simulated terminal; !{' '.join(words)} runs it on your computer"
    return _HERE.get(name, "").replace("FILE", words[-1] if len(words) == 2 else "FILE")
