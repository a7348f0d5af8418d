"""ROS 2 in one process: clock and processes (`core`), the graph, interfaces, packages, and what a learner imports (`site`)."""
