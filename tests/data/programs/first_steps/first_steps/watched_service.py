"""A service and its client whose talk is published; parameters say how much of it."""
import sys

from example_interfaces.srv import AddTwoInts

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState

STATES = {
    'disabled': ServiceIntrospectionState.OFF,
    'metadata': ServiceIntrospectionState.METADATA,
    'contents': ServiceIntrospectionState.CONTENTS,
}


class Watched(Node):

    def __init__(self, name, make):
        super().__init__(name)
        self.end = make(self)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.apply)
        self.declare_parameter('introspection', 'disabled')

    def check(self, parameters):
        for each in parameters:
            if each.name == 'introspection' and each.value not in STATES:
                return SetParametersResult(successful=False, reason='must be one of ' + ', '.join(STATES))
        return SetParametersResult(successful=True)

    def apply(self, parameters):
        for each in parameters:
            if each.name == 'introspection' and each.type_ == Parameter.Type.STRING:
                self.end.configure_introspection(self.get_clock(), qos_profile_system_default, STATES[each.value])


class Client(Watched):

    def __init__(self):
        super().__init__('watched_client', lambda node: node.create_client(AddTwoInts, 'add_two_ints'))
        self.future = None
        self.create_timer(0.5, self.ask)

    def ask(self):
        if self.end.service_is_ready() and (self.future is None or self.future.done()):
            self.future = self.end.call_async(AddTwoInts.Request(a=2, b=3))
            self.future.add_done_callback(
                lambda future: self.get_logger().info(f'The sum is {future.result().sum}'))


def add(request, response):
    response.sum = request.a + request.b
    return response


def main(args=None):
    rclpy.init(args=args)
    if sys.argv[1] == 'client':
        node = Client()
    else:
        node = Watched('watched_server', lambda node: node.create_service(AddTwoInts, 'add_two_ints', add))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_node()


if __name__ == '__main__':
    main()
