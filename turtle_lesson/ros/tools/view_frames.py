"""`ros2 run tf2_tools view_frames`: listens for five seconds and draws the tree of frames, here as text.

Facts: geometry2, tf2_tools/tf2_tools/view_frames.py, which writes a PDF.
"""

from __future__ import annotations

import argparse
import sys
import time
from typing import Any

import rclpy
import yaml
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from tf2_ros import Buffer, TransformListener


def tree_of(frames: dict[str, Any]) -> str:
    """The frames as a tree, each under its parent, with what is known of it. `frames`: as `all_frames_as_yaml`."""
    children: dict[str, list[str]] = {}
    for name, entry in frames.items():
        children.setdefault(entry["parent"], []).append(str(name))
    roots = [parent for parent in children if parent not in frames]
    return "\n".join(line for root in roots for line in [root, *_branches(root, children, frames, "")])


def _branches(parent: str, children: dict[str, list[str]], frames: dict[str, Any], indent: str) -> list[str]:
    lines = []
    names = children.get(parent, [])
    for name in names:
        sign, more = ("└── ", "    ") if name == names[-1] else ("├── ", "│   ")
        lines.append(f"{indent}{sign}{name}  ({_told(frames[name])})")
        lines += _branches(name, children, frames, indent + more)
    return lines


def _told(entry: dict[str, Any]) -> str:
    if not entry["most_recent_transform"]:
        return "static"
    return f"{entry['rate']:.1f} Hz, the latest at {entry['most_recent_transform']:.3f}"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="view_frames", description="Draw the tree of frames that are told on /tf")
    parser.add_argument("--wait-time", "-t", type=float, default=5.0, help="for how many seconds to listen first")
    parser.add_argument("-o", "--output", help="name of the file: accepted, and without effect here")
    return parser.parse_args(remove_ros_args(sys.argv)[1:])


def main() -> int:
    """Listen, draw and end."""
    wait = _arguments().wait_time
    rclpy.init()
    node = Node("view_frames")
    buffer = Buffer(node=node)
    TransformListener(buffer, node)
    node.get_logger().info(f"Listening to tf data for {wait} seconds...")
    end = time.time() + wait
    try:
        while time.time() < end:
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 1
    node.get_logger().info("Generating graph...")
    frames = yaml.safe_load(buffer.all_frames_as_yaml()) or {}
    print(tree_of(frames) if frames else "No tf data received: no node publishes on /tf or /tf_static.")
    rclpy.try_shutdown()
    return 0
