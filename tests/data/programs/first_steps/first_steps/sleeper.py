"""Times, durations, and sleeping on a clock, which with use_sim_time is that of /clock."""
import threading

import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time


class Sleeper(Node):

    def __init__(self):
        super().__init__('sleeper')
        self.timer = self.create_timer(0.25, self.tick)

    def tick(self):
        now = self.get_clock().now()
        print('tick %.2f %s' % (now.nanoseconds / 1e9 % 1000, now.to_msg().nanosec // 10**6))


def main():
    rclpy.init()
    node = Sleeper()
    thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    thread.start()
    clock = node.get_clock()
    print('sim time:', node.get_parameter('use_sim_time').value, clock.ros_time_is_active)
    begun = clock.now()
    clock.sleep_for(Duration(seconds=0.6))
    print('slept %.1f' % ((clock.now() - begun).nanoseconds / 1e9))
    print(Time(seconds=1, nanoseconds=500).to_msg(), Duration(seconds=1.5).to_msg(), Time(seconds=2) - Time(seconds=1))
    rclpy.shutdown()
    thread.join()
