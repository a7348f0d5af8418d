"""ROS 2 in one process, on simulated time. README.md names the rooms and follows a message through them."""
