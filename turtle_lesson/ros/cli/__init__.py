"""The terminal of a page: a small shell, and the `ros2` commands, each of which runs as a simulated process."""
