"""The terminal of a page: a small shell, and the `ros2` command line, whose commands run as simulated processes."""
