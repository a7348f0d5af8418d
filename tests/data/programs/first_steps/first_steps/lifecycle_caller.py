"""Leads lc_talker through its life by its services."""
import lifecycle_msgs.msg
import lifecycle_msgs.srv
import rclpy


def call(node, kind, name, request):
    cli = node.create_client(kind, f'lc_talker/{name}')
    while not cli.wait_for_service(timeout_sec=5.0):
        print(f'Unable to call service {cli.srv_name}')
    future = cli.call_async(request)
    rclpy.spin_until_future_complete(node, future)
    return future.result()


def main():
    rclpy.init()
    node = rclpy.create_node('lc_caller')
    GetState, ChangeState = lifecycle_msgs.srv.GetState, lifecycle_msgs.srv.ChangeState
    T = lifecycle_msgs.msg.Transition
    rate = node.create_rate(2)
    for transition in (T.TRANSITION_CONFIGURE, T.TRANSITION_ACTIVATE, T.TRANSITION_DEACTIVATE,
                       T.TRANSITION_CLEANUP, T.TRANSITION_UNCONFIGURED_SHUTDOWN):
        request = ChangeState.Request()
        request.transition.id = transition
        done = call(node, ChangeState, 'change_state', request).success
        state = call(node, GetState, 'get_state', GetState.Request()).current_state
        print(transition, done, state.id, state.label)
        begun = node.get_clock().now()
        while (node.get_clock().now() - begun).nanoseconds < 1.2e9:
            rclpy.spin_once(node, timeout_sec=0.1)
    del rate
