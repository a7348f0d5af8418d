"""How messages of geometry_msgs are transformed. Facts: geometry2, tf2_geometry_msgs/src (names and signatures).

The transform says where the frame of the data is, seen from the frame that the data shall be in.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)
from tf2_py import _rotation as turns
from tf2_ros import TransformRegistration


def _vector(message: Any) -> turns.Vector:
    return (message.x, message.y, message.z)


def _turn(message: Quaternion) -> turns.Quaternion:
    return turns.canonical((message.x, message.y, message.z, message.w))


def _turned(vector: Any, transform: TransformStamped) -> turns.Vector:
    return turns.rotate(_turn(transform.transform.rotation), _vector(vector))


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """A point as seen from the other frame."""
    x, y, z = turns.add(_turned(point.point, transform), _vector(transform.transform.translation))
    return PointStamped(header=transform.header, point=Point(x=x, y=y, z=z))


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """A direction or velocity as seen from the other frame: turned, not shifted."""
    x, y, z = _turned(vector3.vector, transform)
    return Vector3Stamped(header=transform.header, vector=Vector3(x=x, y=y, z=z))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """A pose as seen from the other frame."""
    if not isinstance(pose, Pose):
        kind = type(pose).__name__
        raise TypeError(f"a Pose is expected, got {kind}: a PoseStamped is transformed by do_transform_pose_stamped()")
    place = turns.add(_turned(pose.position, transform), _vector(transform.transform.translation))
    x, y, z, w = turns.canonical(turns.multiply(_turn(transform.transform.rotation), _turn(pose.orientation)))
    position = Point(x=place[0], y=place[1], z=place[2])
    return Pose(position=position, orientation=Quaternion(x=x, y=y, z=z, w=w))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """A stamped pose as seen from the other frame."""
    return PoseStamped(header=transform.header, pose=do_transform_pose(pose.pose, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """A pose with its uncertainty as seen from the other frame."""
    result = PoseWithCovarianceStamped(header=transform.header)
    result.pose.pose = do_transform_pose(pose.pose.pose, transform)
    result.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return result


def transform_covariance(cov_in: Any, transform: TransformStamped) -> npt.NDArray[np.float64]:
    """A covariance of x, y, z and the angles about them (36 numbers), turned into the other frame."""
    block = np.array(turns.matrix_of(_turn(transform.transform.rotation)))
    both = np.kron(np.eye(2), block)
    covariance = np.asarray(cov_in, dtype=np.float64).reshape(6, 6)
    return (both @ covariance @ both.T).reshape(36)


def do_transform_wrench(wrench: WrenchStamped, transform: TransformStamped) -> WrenchStamped:
    """A force and torque as seen from the other frame: the shift gives the force a lever."""
    force, (x, y, z) = _turned(wrench.wrench.force, transform), _turned(wrench.wrench.torque, transform)
    lever = np.cross(_vector(transform.transform.translation), force)
    torque = Vector3(x=x + float(lever[0]), y=y + float(lever[1]), z=z + float(lever[2]))
    return WrenchStamped(
        header=transform.header, wrench=Wrench(force=Vector3(x=force[0], y=force[1], z=force[2]), torque=torque)
    )


for _kind, _function in (
    (PointStamped, do_transform_point),
    (Vector3Stamped, do_transform_vector3),
    (PoseStamped, do_transform_pose_stamped),
    (PoseWithCovarianceStamped, do_transform_pose_with_covariance_stamped),
    (WrenchStamped, do_transform_wrench),
):
    TransformRegistration().add(_kind, _function)
