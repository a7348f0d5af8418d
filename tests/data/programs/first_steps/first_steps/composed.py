"""Two nodes of other modules in one executor."""
import sys

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

from first_steps.hear_member_function import Listener
from first_steps.talk_member_function import Talker


def main(args=None):
    rclpy.init(args=args)
    try:
        talker = Talker()
        listener = Listener()
        executor = SingleThreadedExecutor()
        executor.add_node(talker)
        executor.add_node(listener)
        try:
            executor.spin()
        finally:
            executor.shutdown()
            listener.destroy_node()
            talker.destroy_node()
    except KeyboardInterrupt:
        pass
    except ExternalShutdownException:
        sys.exit(1)
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
