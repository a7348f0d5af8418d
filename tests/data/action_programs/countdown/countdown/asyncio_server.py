"""A server whose execute callback is a coroutine of asyncio's, with a loop of its own for each goal."""

import asyncio

from workshop_interfaces.action import Countdown

from countdown.parallel_server import CountdownServer, run


class AsyncioServer(CountdownServer):
    def __init__(self):
        super().__init__("asyncio_server")

    def execute_callback(self, goal_handle):
        return asyncio.run(self.count_down(goal_handle))

    async def count_down(self, goal_handle):
        result = Countdown.Result()
        for left in range(goal_handle.request.start, 0, -1):
            result.counted.append(left)
            goal_handle.publish_feedback(Countdown.Feedback(left=left))
            await asyncio.sleep(1)
        goal_handle.succeed()
        return result


def main(args=None):
    run(AsyncioServer, args)


if __name__ == "__main__":
    main()
