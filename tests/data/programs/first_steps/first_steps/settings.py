"""A node with parameters that looks at them again and again, as in the beginner's tutorial."""
import rclpy
import rclpy.node
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult


class Settings(rclpy.node.Node):

    def __init__(self):
        super().__init__('settings')
        my_parameter_descriptor = ParameterDescriptor(description='This parameter is mine!')
        self.declare_parameter('my_parameter', 'world', my_parameter_descriptor)
        self.declare_parameter('speed', 1.0, ParameterDescriptor(
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=5.0, step=0.5)]))
        self.declare_parameters(namespace='pid', parameters=[('kp', 2.0), ('ki', 0.0), ('kd', 0.5)])
        self.declare_parameter('start', rclpy.Parameter.Type.STRING)
        self.add_on_set_parameters_callback(self.check)
        self.timer = self.create_timer(1, self.timer_callback)

    def check(self, params):
        for param in params:
            if param.name == 'my_parameter' and param.type_ != rclpy.Parameter.Type.STRING:
                return SetParametersResult(successful=False, reason='a word, please')
            if param.name == 'pid.kp' and param.value < 0:
                return SetParametersResult(successful=False, reason='kp must not be negative')
        return SetParametersResult(successful=True)

    def timer_callback(self):
        my_param = self.get_parameter('my_parameter').get_parameter_value().string_value
        self.get_logger().info('Hello %s! %s %s' % (
            my_param, self.get_parameter('speed').value, self.get_parameter_or('pid.kp').value))
        my_new_param = rclpy.parameter.Parameter(
            'my_parameter', rclpy.Parameter.Type.STRING, 'world')
        self.set_parameters([my_new_param])


def main():
    rclpy.init()
    node = Settings()
    print(sorted(node.get_parameters_by_prefix('pid')))
    try:
        node.get_parameter('start')
    except rclpy.exceptions.ParameterUninitializedException as error:
        print(type(error).__name__)
    rclpy.spin(node)


if __name__ == '__main__':
    main()
