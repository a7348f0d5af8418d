"""The simulated turtle: its world in plain Python, and the node `/turtlesim` that connects it to ROS.

`turtle.py`, `world.py` and `canvas.py` know no ROS, and `obstacles.py` only its markers.
`tutorials.py` and `teleop_turtle_key.py` are the other programs of ROS's package turtlesim.
"""
