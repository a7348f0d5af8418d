"""A server for one goal at a time: the others wait in a queue."""

import collections
import threading

from countdown.parallel_server import CountdownServer, run


class QueueServer(CountdownServer):
    def __init__(self):
        self._waiting = collections.deque()
        self._current = None
        self._lock = threading.Lock()
        super().__init__("queue_server", handle_accepted_callback=self.handle_accepted_callback)

    def handle_accepted_callback(self, goal_handle):
        with self._lock:
            if self._current is not None:
                self._waiting.append(goal_handle)
                self.get_logger().info(f"Goal {goal_handle.request.start} has to wait")
            else:
                self._current = goal_handle
                self._current.execute()

    def execute_callback(self, goal_handle):
        try:
            return super().execute_callback(goal_handle)
        finally:
            with self._lock:
                try:
                    self._current = self._waiting.popleft()
                    self._current.execute()
                except IndexError:
                    self._current = None


def main(args=None):
    run(QueueServer, args)


if __name__ == "__main__":
    main()
