"""A server for one goal at a time: a new one puts an end to the one before."""

import threading

from countdown.parallel_server import CountdownServer, run


class SingleGoalServer(CountdownServer):
    def __init__(self):
        self._goal = None
        self._lock = threading.Lock()
        super().__init__("single_goal_server", handle_accepted_callback=self.handle_accepted_callback)

    def handle_accepted_callback(self, goal_handle):
        with self._lock:
            if self._goal is not None and self._goal.is_active:
                self.get_logger().info(f"Give up goal {self._goal.request.start}")
                self._goal.abort()
            self._goal = goal_handle
        goal_handle.execute()


def main(args=None):
    run(SingleGoalServer, args)


if __name__ == "__main__":
    main()
