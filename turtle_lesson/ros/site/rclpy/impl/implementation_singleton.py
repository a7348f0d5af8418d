"""Where the real rclpy's modules find its C++ half. A few programs import it from here, for its exceptions."""

from __future__ import annotations

from .. import _rclpy_pybind11

rclpy_implementation = _rclpy_pybind11
