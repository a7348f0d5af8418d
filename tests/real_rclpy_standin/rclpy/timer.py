"""Timers, under the name that rclpy has for them."""

from rclpy.node import Timer as Timer
