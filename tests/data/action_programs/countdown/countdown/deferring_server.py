"""A server that accepts at once, and begins three seconds later."""

from countdown.parallel_server import CountdownServer, run


class DeferringServer(CountdownServer):
    def __init__(self):
        self._goal = None
        super().__init__("deferring_server", handle_accepted_callback=self.handle_accepted_callback)
        self._timer = self.create_timer(3.0, self.begin)
        self._timer.cancel()

    def handle_accepted_callback(self, goal_handle):
        self.get_logger().info("Later")
        self._goal = goal_handle
        self._timer.reset()

    def begin(self):
        self._timer.cancel()
        self._goal.execute()


def main(args=None):
    run(DeferringServer, args)


if __name__ == "__main__":
    main()
