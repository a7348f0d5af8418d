"""Two handlers: for a parameter of its own and for one of another node, and one for all events."""
import rclpy
import rclpy.node
import rclpy.parameter
from rclpy.parameter_event_handler import ParameterEventHandler


class Watch(rclpy.node.Node):

    def __init__(self):
        super().__init__('parameter_watch')
        self.declare_parameter('an_int_param', 0)
        self.handler = ParameterEventHandler(self)
        self.callback_handle = self.handler.add_parameter_callback(
            parameter_name='an_int_param', node_name='parameter_watch', callback=self.callback)
        self.other_handle = self.handler.add_parameter_callback(
            parameter_name='my_parameter', node_name='settings', callback=self.callback)
        self.handler.add_parameter_event_callback(callback=self.event)

    def callback(self, p: rclpy.parameter.Parameter) -> None:
        self.get_logger().info(f'Received an update to parameter: {p.name}: {rclpy.parameter.parameter_value_to_python(p.value)}')

    def event(self, event) -> None:
        changed = [each.name for each in event.changed_parameters]
        if event.node == '/settings' and changed:
            self.get_logger().info(f'{event.node} changed {changed}')


def main():
    rclpy.init()
    node = Watch()
    rclpy.spin(node)
    rclpy.shutdown()
