"""The specification of the lesson's controller, short enough to be pasted into a chat."""

SPECIFICATION = """\
A turtle in turtlesim (world 11.09 m x 11.09 m, 62.5 poses a second on /turtle1/pose) is driven by three ROS 2 nodes in
Python (rclpy), in the ament_cmake package robot_controller, all started by launch/start_system.launch.py.

- msg/TurtleStatus: float32 x, y, theta, vel_x, vel_y, battery
- srv/NavigateTo: float32 x, y, theta -> bool success, float32 time_taken
- navigator (navigator_node.py, class NavigatorNode): offers /navigate_to; publishes geometry_msgs/msg/Twist on
  /turtle1/cmd_vel, 10 Hz while moving, zero at the end; parameter goal_timeout (s, 5.0 in the launch file). A goal counts
  as reached within 0.2 m; success is judged at the end; time_taken is right within 0.1 s.
- status_monitor (status_monitor_node.py, class StatusMonitorNode): publishes TurtleStatus on /robot/status every
  100 ms +/- 10 ms (parameter publish_rate, 10); the battery starts at 100 %, falls 0.1 a message, never below 0.
- obstacle_detector (obstacle_detector_node.py, class ObstacleDetectorNode): publishes sensor_msgs/msg/LaserScan on
  /obstacles, 5 Hz (parameter scan_rate, 5), frame base_link, -90 to +90 degrees in steps of 1 degree, 0 to 10 m; mock
  readings are 0.5 m for 5 % of the beams and 10 m for the rest.

Not wanted: path planning, avoiding obstacles, several turtles, robot models, hardware.
"""
