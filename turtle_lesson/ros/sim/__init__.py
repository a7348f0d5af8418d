"""The discrete-event simulation: a virtual clock, timed events and simulated processes. It knows nothing of ROS."""
