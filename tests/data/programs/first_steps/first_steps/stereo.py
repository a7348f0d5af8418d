"""Pictures of two cameras that belong together, by message_filters."""
import rclpy
from message_filters import ApproximateTimeSynchronizer, Cache, Subscriber, TimeSynchronizer
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image, Imu


class Cameras(Node):

    def __init__(self):
        super().__init__('cameras')
        self.left = self.create_publisher(Image, 'left', 10)
        self.right = self.create_publisher(Image, 'right', 10)
        self.imu = self.create_publisher(Imu, 'imu', 10)
        self.n = 0
        self.create_timer(0.5, self.shoot)

    def shoot(self):
        now = self.get_clock().now()
        late = Duration(nanoseconds=30_000_000 if self.n % 2 else 0)
        for publisher, msg, stamp in ((self.left, Image(), now), (self.right, Image(), now + late), (self.imu, Imu(), now)):
            msg.header.stamp = stamp.to_msg()
            msg.header.frame_id = str(self.n)
            publisher.publish(msg)
        self.n += 1


class Stereo(Node):

    def __init__(self):
        super().__init__('stereo')
        left = Subscriber(self, Image, 'left')
        right = Subscriber(self, Image, 'right', qos_profile=qos_profile_sensor_data)
        imu = Subscriber(self, Imu, 'imu')
        self.exact = TimeSynchronizer([left, right], 10)
        self.exact.registerCallback(self.both, 'exactly')
        self.near = ApproximateTimeSynchronizer([left, right, imu], queue_size=5, slop=0.1)
        self.near.registerCallback(self.three)
        self.cache = Cache(imu, 3)

    def both(self, left, right, how):
        self.get_logger().info(f'{how} {left.header.frame_id} {right.header.frame_id}')

    def three(self, left, right, imu):
        kept = [each.header.frame_id for each in self.cache.cache_msgs]
        self.get_logger().info(f'about {left.header.frame_id} {right.header.frame_id} {imu.header.frame_id} of {kept}')


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    nodes = [Cameras(), Stereo()]
    for node in nodes:
        executor.add_node(node)
    executor.spin()
