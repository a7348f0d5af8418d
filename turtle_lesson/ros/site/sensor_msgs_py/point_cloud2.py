"""Points of a `sensor_msgs/PointCloud2` as numpy arrays, and clouds made of points.

Names, arguments and the words of assertions are those of sensor_msgs_py/point_cloud2.py.
"""

from __future__ import annotations

import array
import sys
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

DUMMY_FIELD_PREFIX = "unnamed_field"

_DATATYPES: dict[int, np.dtype[Any]] = {
    PointField.INT8: np.dtype(np.int8),
    PointField.UINT8: np.dtype(np.uint8),
    PointField.INT16: np.dtype(np.int16),
    PointField.UINT16: np.dtype(np.uint16),
    PointField.INT32: np.dtype(np.int32),
    PointField.UINT32: np.dtype(np.uint32),
    PointField.FLOAT32: np.dtype(np.float32),
    PointField.FLOAT64: np.dtype(np.float64),
}


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> np.ndarray:
    """The points of a cloud as a structured array, one element a point: `points["x"]`.

    The array looks at the message's own data: what is written into it is written into the message.

    Args:
        cloud: the message.
        field_names: the fields to read; None for all.
        skip_nans: leave out points of which a field is no number, unless the cloud says that it has none.
        uvs: the indices of the points to read; None for all.
        reshape_organized_cloud: give a cloud of several rows as an array of two dimensions.
    """
    assert isinstance(cloud, PointCloud2), "Cloud is not a sensor_msgs.msg.PointCloud2"
    dtype = dtype_from_fields(cloud.fields, point_step=cloud.point_step)
    points: np.ndarray = np.ndarray(shape=(cloud.width * cloud.height,), dtype=dtype, buffer=cloud.data)
    if field_names is not None:
        known = points.dtype.names or ()
        assert all(name in known for name in field_names), "Requests field is not in the fields of the PointCloud!"
        points = points[list(field_names)]
    if (sys.byteorder == "big") != bool(cloud.is_bigendian):
        points = points.byteswap()  # in a copy; the real one turns the bytes of the message itself around
    if skip_nans and not cloud.is_dense:
        points = points[_are_numbers(points)]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, int)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> np.ndarray:
    """The points of a cloud as a plain array, a row a point; all fields must be of one type.

    The arguments are those of `read_points`.
    """
    first, *others = cloud.fields
    assert all(each.datatype == first.datatype for each in others if field_names is None or each.name in field_names), (
        "All fields need to have the same datatype. Use `read_points()` otherwise."
    )
    return structured_to_unstructured(read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud))


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
) -> list[Any]:
    """The points of a cloud as named tuples: `point.x`; slow where there are many.

    The arguments are those of `read_points`.
    """
    assert isinstance(cloud, PointCloud2), "cloud is not a sensor_msgs.msg.PointCloud2"
    names = [field.name for field in cloud.fields] if field_names is None else list(field_names)
    point_class: Any = namedtuple("Point", names)  # type: ignore[misc]
    return [point_class._make(point) for point in read_points(cloud, names, skip_nans, uvs)]


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype:
    """numpy's type of a point with these fields; one of several values becomes `name_0`, `name_1` and so on.

    Args:
        fields: the fields of a cloud.
        point_step: bytes from one point to the next; None where nothing lies between them.
    """
    names: list[str] = []
    offsets: list[int] = []
    formats: list[str] = []
    for index, field in enumerate(fields):
        datatype = _DATATYPES[field.datatype]
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{index}"
        assert field.count > 0, "Can't process fields with count = 0."
        for place in range(field.count):
            part = f"{name}_{place}" if field.count > 1 else name
            assert part not in names, "Duplicate field names are not allowed!"
            names.append(part)
            offsets.append(field.offset + place * datatype.itemsize)
            formats.append(datatype.str)
    layout: Any = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        layout["itemsize"] = point_step
    return np.dtype(layout)


def create_cloud(
    header: Header, fields: Sequence[PointField], points: Iterable[Any], point_step: int | None = None
) -> PointCloud2:
    """A cloud of points.

    Args:
        header: the cloud's header.
        fields: the fields of each point.
        points: an array (structured, or of numbers with a row a point; with one dimension more for an organised cloud),
            or a tuple for each point, its values in the order of the fields.
        point_step: bytes from one point to the next; None for what the fields or a structured array need.
    """
    structured = _structured(fields, points, point_step)
    assert structured.ndim <= 2, (
        "Too many dimensions for organized cloud! Points can only be organized in max. two dimensional space"
    )
    width = structured.shape[0]
    step = structured.dtype.itemsize
    return PointCloud2(
        header=header,
        height=structured.shape[1] if structured.ndim == 2 else 1,
        width=width,
        is_dense=False,
        is_bigendian=sys.byteorder == "big",
        fields=fields,
        point_step=step,
        row_step=step * width,
        data=array.array("B", structured.tobytes()),
    )


def create_cloud_xyz32(header: Header, points: Iterable[Any]) -> PointCloud2:
    """A cloud of points with the fields x, y and z, each a float32; the points are as in `create_cloud`."""
    fields = [
        PointField(name=name, offset=offset, datatype=PointField.FLOAT32, count=1)
        for name, offset in (("x", 0), ("y", 4), ("z", 8))
    ]
    return create_cloud(header, fields, points)


def _structured(fields: Sequence[PointField], points: Any, point_step: int | None) -> np.ndarray:
    """The points as a structured array of the fields' type."""
    if not isinstance(points, np.ndarray):
        return np.array([tuple(point) for point in points], dtype=dtype_from_fields(fields, point_step))
    if points.dtype.names is None:
        assert all(fields[0].datatype == field.datatype for field in fields[1:]), (
            "All fields need to have the same datatype. Pass a structured NumPy array with multiple dtypes otherwise."
        )
        return unstructured_to_structured(points, dtype=dtype_from_fields(fields, point_step))
    step = points.dtype.itemsize if point_step is None else point_step
    assert points.dtype == dtype_from_fields(fields, step), (
        "PointFields and structured NumPy array dtype do not match for all fields! "
        "Check their field order, names and types."
    )
    return points


def _are_numbers(points: np.ndarray) -> np.ndarray:
    """Which points have a number in every field."""
    mask = np.ones(len(points), dtype=bool)
    for name in points.dtype.names or ():
        mask &= ~np.isnan(points[name])
    return mask
