"""Timers: one that is cancelled and set going again, one that changes its period, and a single shot."""
import rclpy
from rclpy.node import Node
from rclpy.clock import Clock, ClockType


class CountDown(Node):

    def __init__(self):
        super().__init__('count_down')
        self.left = 3
        self.begun = self.get_clock().now()
        self.counter = self.create_timer(1.0, self.count)
        self.shot = self.create_timer(0.25, self.once)
        self.steady = self.create_timer(0.5, self.tick, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.ticks = 0

    def say(self, text):
        passed = (self.get_clock().now() - self.begun).nanoseconds / 1e9
        print('%.1f %s' % (passed, text))

    def once(self):
        self.shot.cancel()
        self.say('once, canceled: %s' % self.shot.is_canceled())

    def tick(self):
        self.ticks += 1
        if self.ticks == 2:
            self.steady.timer_period_ns = 2 * 10**9
        self.say('tick %d' % self.ticks)

    def count(self):
        self.say(str(self.left))
        self.left -= 1
        if self.left == 0:
            self.say('restart')
            self.shot.reset()
        if self.left < 0:
            raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    node = CountDown()
    try:
        rclpy.spin(node)
    except SystemExit:
        rclpy.logging.get_logger('Quitting').info('Done')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
