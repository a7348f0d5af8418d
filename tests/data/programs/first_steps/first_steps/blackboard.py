"""Takes any parameter."""
import rclpy
from rclpy.executors import ExternalShutdownException


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = rclpy.create_node(
                'blackboard', allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True)
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
