"""Sets, lists, reads, loads and deletes the parameters of another node."""
import os

from ament_index_python import get_package_share_directory
import rclpy
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient


def main(args=None):
    with rclpy.init(args=args):
        node = rclpy.create_node('parameter_client')
        client = AsyncParameterClient(node, 'blackboard')
        if not client.wait_for_services(3.0):
            raise RuntimeError('start the blackboard first')

        def wait(future):
            rclpy.spin_until_future_complete(node, future)
            return future.result()

        names = ['an_int', 'a_bool', 'a_text']
        results = wait(client.set_parameters([
            Parameter('an_int', Parameter.Type.INTEGER, 10),
            Parameter('a_bool', Parameter.Type.BOOL, False),
            Parameter('a_text', Parameter.Type.STRING, 'Fee Fi Fo Fum')])).results
        print('set', [each.successful for each in results])
        print('listed', list(wait(client.list_parameters(names, 10)).result.names))
        print('got', [parameter_value_to_python(each) for each in wait(client.get_parameters(names)).values])
        print('types', list(wait(client.get_parameter_types(names)).types))
        path = os.path.join(get_package_share_directory('first_steps'), 'config', 'blackboard.yaml')
        results = wait(client.load_parameter_file(path)).results
        loaded = parameter_dict_from_yaml_file(path, False, target_nodes=['blackboard'])
        for result, (name, parameter) in zip(results, loaded.items()):
            print('loaded', name, result.successful, parameter_value_to_python(parameter.value))
        for result in wait(client.delete_parameters(['an_int', 'nowhere'])).results:
            print('deleted', result.successful, result.reason)
