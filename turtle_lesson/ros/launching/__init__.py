"""Carrying out a launch: from files to descriptions, from descriptions to running nodes, and what `ros2 launch` prints.

    handle = service.launch_file(world, path, {"rate": "5.0"})      # starts the nodes and returns at once
    handle.stop()                                                   # as Ctrl-C in a terminal

A description is evaluated in the cell that asks for it; its processes start at the current instant and run when the
world runs. Python programs come up one after the other, each 0.3 s of robot time after the one before, and all others
(turtlesim, echo) at once. `handle.wait_until_up()` lets that time pass.
"""
