"""Listens to /rosout."""
import rclpy
from rcl_interfaces.msg import Log
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

LEVELS = {Log.DEBUG: 'debug', Log.INFO: 'info', Log.WARN: 'warn', Log.ERROR: 'error', Log.FATAL: 'fatal'}
LEVELS = {int.from_bytes(each, 'little') if isinstance(each, bytes) else each: name for each, name in LEVELS.items()}


class LogReader(Node):

    def __init__(self):
        super().__init__('log_reader', enable_rosout=False)
        self.create_subscription(
            Log, '/rosout', self.heard, QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def heard(self, msg):
        print(f'{msg.name} {LEVELS[msg.level]} {msg.function} {msg.msg}')


def main():
    rclpy.init()
    rclpy.spin(LogReader())
