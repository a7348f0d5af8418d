"""The programs that everybody starts first: `ros2 run demo_nodes_py talker` and its kin, and those of demo_nodes_cpp.

What is C++ on a robot is Python here; topics, words and pauses are the same (demos, demo_nodes_py and demo_nodes_cpp of
Humble). Each is plain rclpy.
"""
