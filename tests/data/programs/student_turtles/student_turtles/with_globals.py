import rclpy
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

x = 0.0
pub = None
node = None
count = 0


def pose_cb(data):
    global x, count
    x = data.x
    count += 1


def timer_cb():
    t = Twist()
    if x < 7.0:
        t.linear.x = 1.0
    else:
        node.get_logger().info('reached %.1f after %d poses' % (x, count))
        timer.cancel()
    pub.publish(t)


def main():
    global pub, node, timer
    rclpy.init()
    node = rclpy.create_node('with_globals')
    pub = node.create_publisher(Twist, 'turtle1/cmd_vel', 1)
    node.create_subscription(Pose, 'turtle1/pose', pose_cb, 1)
    timer = node.create_timer(0.1, timer_cb)
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()
