from standin_messages import message

Vector3 = message("geometry_msgs/msg/Vector3", x="double", y="double", z="double")
Point = message("geometry_msgs/msg/Point", x="double", y="double", z="double")
Quaternion = message("geometry_msgs/msg/Quaternion", x="double", y="double", z="double", w="double")
Pose = message("geometry_msgs/msg/Pose", position="geometry_msgs/Point", orientation="geometry_msgs/Quaternion")
Twist = message("geometry_msgs/msg/Twist", linear="geometry_msgs/Vector3", angular="geometry_msgs/Vector3")
