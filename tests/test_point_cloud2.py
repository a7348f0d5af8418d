"""sensor_msgs_py.point_cloud2: points in, points out, as programs with a lidar or a depth camera use it."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs_py import point_cloud2
from sensor_msgs_py.numpy_compat import structured_to_unstructured
from std_msgs.msg import Header

POINTS = [(0.0, 0.5, 1.0), (1.0, np.nan, 1.5), (2.0, 2.5, 3.0)]


def field(name: str, offset: int, datatype: int = PointField.FLOAT32, count: int = 1) -> PointField:
    return PointField(name=name, offset=offset, datatype=datatype, count=count)


XYZ = [field("x", 0), field("y", 4), field("z", 8)]
MIXED = [field("x", 0), field("far", 4, PointField.FLOAT64), field("ring", 12, PointField.UINT8)]


@pytest.fixture
def cloud() -> Any:
    return point_cloud2.create_cloud_xyz32(Header(frame_id="lidar"), POINTS)


def test_a_cloud_of_three_points(cloud: Any) -> None:
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step) == (3, 1, 12, 36)
    assert (cloud.is_dense, cloud.is_bigendian, cloud.header.frame_id) == (False, sys.byteorder == "big", "lidar")
    assert [(each.name, each.offset, each.datatype, each.count) for each in cloud.fields] == [
        ("x", 0, 7, 1),
        ("y", 4, 7, 1),
        ("z", 8, 7, 1),
    ]
    assert cloud.data.tobytes() == np.array(POINTS, np.float32).tobytes()
    assert cloud == point_cloud2.create_cloud(Header(frame_id="lidar"), XYZ, np.array(POINTS, np.float32))
    assert deserialize_message(serialize_message(cloud), PointCloud2) == cloud


def test_points_are_read_in_three_forms(cloud: Any) -> None:
    points = point_cloud2.read_points(cloud)
    assert points.dtype.names == ("x", "y", "z")
    assert points["x"].tolist() == [0.0, 1.0, 2.0]
    assert np.array_equal(point_cloud2.read_points_numpy(cloud), np.array(POINTS, np.float32), equal_nan=True)
    listed = point_cloud2.read_points_list(cloud)
    assert (listed[2].x, listed[2].y, listed[2].z) == (2.0, 2.5, 3.0)
    x, _, z = listed[1]
    assert (x, z) == (1.0, 1.5)


def test_some_fields_some_points_no_nans(cloud: Any) -> None:
    assert point_cloud2.read_points(cloud, field_names=("x", "z")).dtype.names == ("x", "z")
    assert point_cloud2.read_points_numpy(cloud, ["z", "x"]).tolist() == [[1.0, 0.0], [1.5, 1.0], [3.0, 2.0]]
    assert [p.x for p in point_cloud2.read_points_list(cloud, skip_nans=True)] == [0.0, 2.0]
    assert point_cloud2.read_points(cloud, uvs=[2, 0])["x"].tolist() == [2.0, 0.0]
    assert point_cloud2.read_points(cloud, uvs=np.array([1]))["x"].tolist() == [1.0]
    cloud.is_dense = True
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 3


def test_fields_of_several_types() -> None:
    points = [(1.0, 2.0, 3), (4.0, 5.0, 6)]
    cloud = point_cloud2.create_cloud(Header(), MIXED, points)
    read = point_cloud2.read_points(cloud)
    assert (cloud.point_step, read.dtype) == (13, np.dtype([("x", "<f4"), ("far", "<f8"), ("ring", "u1")]))
    assert read.tolist() == points
    assert point_cloud2.create_cloud(Header(), MIXED, read) == cloud
    with pytest.raises(AssertionError, match="All fields need to have the same datatype"):
        point_cloud2.read_points_numpy(cloud)
    with pytest.raises(AssertionError, match="Pass a structured NumPy array with multiple dtypes otherwise"):
        point_cloud2.create_cloud(Header(), MIXED, np.zeros((2, 3)))
    with pytest.raises(AssertionError, match="structured NumPy array dtype do not match for all fields"):
        point_cloud2.create_cloud(Header(), XYZ, read)


def test_an_organised_cloud_keeps_its_two_dimensions() -> None:
    image = np.arange(18, dtype=np.float32).reshape(2, 3, 3)
    cloud = point_cloud2.create_cloud_xyz32(Header(), image)
    assert (cloud.width, cloud.height, cloud.row_step) == (2, 3, 24)
    read = point_cloud2.read_points(cloud, reshape_organized_cloud=True)
    assert read.shape == (2, 3)
    assert np.array_equal(structured_to_unstructured(read), image)
    assert len(point_cloud2.read_points(cloud)) == 6
    with pytest.raises(AssertionError, match="Points can only be organized in max"):
        point_cloud2.create_cloud_xyz32(Header(), np.zeros((2, 2, 2, 3), np.float32))


def test_a_field_of_several_values_and_one_without_a_name() -> None:
    dtype = point_cloud2.dtype_from_fields([field("", 0), field("normal", 4, count=3)], point_step=32)
    assert dtype.names == ("unnamed_field_0", "normal_0", "normal_1", "normal_2")
    assert dtype.itemsize == 32
    cloud = point_cloud2.create_cloud(Header(), [field("p", 0, count=3)], np.array(POINTS, np.float32))
    assert point_cloud2.read_points(cloud)["p_2"].tolist() == [1.0, 1.5, 3.0]
    with pytest.raises(AssertionError, match="Duplicate field names"):
        point_cloud2.dtype_from_fields([field("x", 0), field("x", 4)])
    with pytest.raises(AssertionError, match="count = 0"):
        point_cloud2.dtype_from_fields([field("x", 0, count=0)])


def test_bytes_between_points_are_stepped_over() -> None:
    padded = np.dtype({"names": ["x", "y", "z"], "formats": ["<f4"] * 3, "offsets": [0, 4, 8], "itemsize": 20})
    points = np.array(POINTS, dtype=padded)
    for step in ({}, {"point_step": 20}):
        cloud = point_cloud2.create_cloud(Header(), XYZ, points, **step)
        assert (cloud.point_step, len(cloud.data)) == (20, 60)
        assert point_cloud2.read_points(cloud)["z"].tolist() == [1.0, 1.5, 3.0]
    with pytest.raises(AssertionError, match="do not match"):
        point_cloud2.create_cloud(Header(), XYZ, points, point_step=12)


def test_a_cloud_of_the_other_byte_order_is_turned_around_and_stays_as_it_was(cloud: Any) -> None:
    turned = np.array(POINTS, np.float32).byteswap().tobytes()
    cloud.data = list(turned)
    cloud.is_bigendian = sys.byteorder == "little"
    for _ in range(2):
        assert point_cloud2.read_points(cloud)["x"].tolist() == [0.0, 1.0, 2.0]
    assert cloud.data.tobytes() == turned


def test_what_is_read_is_the_message_itself(cloud: Any) -> None:
    point_cloud2.read_points(cloud)["z"] = 9.0
    assert [p.z for p in point_cloud2.read_points_list(cloud)] == [9.0, 9.0, 9.0]


def test_mistakes_are_told(cloud: Any) -> None:
    with pytest.raises(AssertionError, match=r"Cloud is not a sensor_msgs\.msg\.PointCloud2"):
        point_cloud2.read_points(POINTS)
    with pytest.raises(AssertionError, match="cloud is not a"):
        point_cloud2.read_points_list(None)
    with pytest.raises(AssertionError, match="Requests field is not in the fields of the PointCloud!"):
        point_cloud2.read_points(cloud, field_names=["intensity"])
    cloud.width = 4
    with pytest.raises(TypeError, match="buffer is too small"):
        point_cloud2.read_points(cloud)


def test_an_empty_cloud() -> None:
    cloud = point_cloud2.create_cloud_xyz32(Header(), [])
    assert (cloud.width, len(cloud.data), len(point_cloud2.read_points(cloud))) == (0, 0, 0)


@settings(deadline=None)
@given(st.lists(st.tuples(*[st.floats(width=32)] * 3), max_size=20), st.booleans())
def test_any_points_come_back(points: list[tuple[float, float, float]], as_array: bool) -> None:
    given_points = np.array(points, np.float32).reshape(-1, 3) if as_array else points
    cloud = point_cloud2.create_cloud_xyz32(Header(), given_points)
    expected = np.array(points, np.float32).reshape(-1, 3)
    assert np.array_equal(point_cloud2.read_points_numpy(cloud), expected, equal_nan=True)
    kept = [tuple(row) for row in expected.tolist() if not np.isnan(row).any()]
    assert [tuple(map(float, p)) for p in point_cloud2.read_points_list(cloud, skip_nans=True)] == kept
