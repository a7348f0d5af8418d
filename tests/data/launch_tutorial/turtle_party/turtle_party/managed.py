import rclpy
from rclpy.lifecycle import Node, TransitionCallbackReturn


class Managed(Node):
    def on_configure(self, state):
        self.get_logger().info("configured")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.get_logger().info("activated")
        return super().on_activate(state)


def main():
    rclpy.init()
    rclpy.spin(Managed("managed"))
