"""Has buffers know how to transform points, vectors, poses and wrenches; importing it is enough."""

# ruff: noqa: F401

from .tf2_geometry_msgs import (
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
    do_transform_point,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_vector3,
    do_transform_wrench,
    transform_covariance,
)
