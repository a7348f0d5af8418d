"""ROS 2 interfaces: from the text of `.msg`, `.srv` and `.action` files to Python classes, and from messages to CDR bytes."""
