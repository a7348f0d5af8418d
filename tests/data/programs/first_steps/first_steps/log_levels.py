"""Every level, once, throttled, skipped, named, and a child; the level is set from outside through the logger service."""
import rclpy
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.logging import get_logger_effective_level, set_logger_level
from rclpy.node import Node


class Chatter(Node):

    def __init__(self):
        super().__init__('log_levels', enable_logger_service=True)
        self.count = 0
        self.child = self.get_logger().get_child('child')
        self.timer = self.create_timer(1.0, self.tick)

    def tick(self):
        self.count += 1
        logger = self.get_logger()
        logger.debug(f'debug {self.count}')
        logger.info(f'info {self.count}')
        logger.info('only once', once=True)
        logger.info(f'throttled {self.count}', throttle_duration_sec=2.5)
        logger.warning(f'not the first {self.count}', skip_first=True)
        self.child.error(f'child {self.count}')
        if self.count == 3:
            logger.fatal(f'level {get_logger_effective_level(logger.name)!s}')
            set_logger_level('log_levels', LoggingSeverity.WARN)
            raise rclpy.executors.ExternalShutdownException


def main():
    rclpy.init()
    node = Chatter()
    try:
        rclpy.spin(node)
    except rclpy.executors.ExternalShutdownException:
        pass
    node.get_logger().info('not seen')
    node.get_logger().warn('seen')
