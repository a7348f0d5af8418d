"""A session with a system: `start()` and `Lesson` for the simulation, `connect()` and `Robot` for a real ROS 2."""
