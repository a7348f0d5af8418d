"""The simulated turtle: its world in plain Python, and the node `/turtlesim` that connects it to ROS.

`turtle.py` knows no ROS, and `obstacles.py` only its markers. `tutorials.py` has the other programs of ROS's package turtlesim.
"""
