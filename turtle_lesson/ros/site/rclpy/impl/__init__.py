"""Where rclpy keeps its loggers."""
