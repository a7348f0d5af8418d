"""How point clouds are transformed. Facts: geometry2, tf2_sensor_msgs (names and signatures).

The transform says where the frame of the cloud is, seen from the frame that the cloud shall be in.
"""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import Transform, TransformStamped
from sensor_msgs.msg import PointCloud2
from sensor_msgs_py.point_cloud2 import create_cloud, read_points
from tf2_py import _rotation as turns
from tf2_ros import ConvertRegistration, TransformRegistration


def to_msg_msg(msg: Any) -> Any:
    """A message as a message: the same."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """A message as data: the same."""
    return msg


def transform_points(point_cloud: npt.ArrayLike, transform: Transform | TransformStamped) -> np.ndarray:
    """Points, a row of x, y and z for each, as seen from the other frame."""
    parts = transform.transform if isinstance(transform, TransformStamped) else transform
    turn, shift = parts.rotation, parts.translation
    quaternion = turns.canonical((turn.x, turn.y, turn.z, turn.w))
    axes = [turns.rotate(quaternion, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    return np.asarray(point_cloud) @ np.array(axes) + np.array((shift.x, shift.y, shift.z))


def do_transform_cloud(cloud: PointCloud2, transform: Transform | TransformStamped) -> PointCloud2:
    """A cloud as seen from the other frame: its x, y and z are others, all other fields are kept.

    Its header is that of the transform; a Transform has none, and leaves the cloud's.
    """
    if not isinstance(cloud, PointCloud2):
        raise TypeError(f"do_transform_cloud() transforms a PointCloud2, got a {type(cloud).__name__}")
    points = np.array(read_points(cloud, reshape_organized_cloud=True), copy=True)
    axes = ("x", "y", "z")
    moved = transform_points(np.stack([points[axis] for axis in axes], axis=-1), transform)
    for place, axis in enumerate(axes):
        points[axis] = moved[..., place]
    header = transform.header if isinstance(transform, TransformStamped) else cloud.header
    return create_cloud(deepcopy(header), cloud.fields, points, cloud.point_step)


ConvertRegistration().add_to_msg(PointCloud2, to_msg_msg)
ConvertRegistration().add_from_msg(PointCloud2, from_msg_msg)
TransformRegistration().add(PointCloud2, do_transform_cloud)
