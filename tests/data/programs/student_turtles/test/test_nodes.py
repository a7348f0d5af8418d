"""A unit test as students write them: the node under test and a probe in one process."""
import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from turtlesim.msg import Pose

from student_turtles.behaviour_tree import TreeNode


@pytest.fixture
def ros():
    rclpy.init()
    yield
    rclpy.shutdown()


def test_it_drives_until_the_right_edge(ros):
    tree, probe = TreeNode(), rclpy.create_node('probe')
    heard = []
    probe.create_subscription(Twist, 'turtle1/cmd_vel', heard.append, 10)
    poses = probe.create_publisher(Pose, 'turtle1/pose', 10)
    executor = SingleThreadedExecutor()
    executor.add_node(tree)
    executor.add_node(probe)
    end = probe.get_clock().now().nanoseconds + 3 * 10**8
    while probe.get_clock().now().nanoseconds < end:
        if not tree.poses:
            poses.publish(Pose(x=5.0))
        executor.spin_once(timeout_sec=0.05)
    assert heard and all(each.linear.x == 2.0 for each in heard)
    tree.destroy_node()
    probe.destroy_node()
