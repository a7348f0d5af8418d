"""Publishers, under the name that rclpy has for them."""

from rclpy.subscription import Publisher as Publisher
