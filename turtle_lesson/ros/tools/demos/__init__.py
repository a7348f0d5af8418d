"""The demo programs that everybody starts first: `ros2 run demo_nodes_py talker` and others, and those of demo_nodes_cpp.

What is C++ on a robot is Python here; topics, texts and pauses are those of Humble.
Each is a plain rclpy program.
"""
