"""ROS 2 in one process: `README.md` beside this file lists its rooms, and says how a message travels."""
