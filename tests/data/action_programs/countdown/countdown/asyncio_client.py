"""A client that awaits in asyncio's loop, where another task spins the node."""

import asyncio

import rclpy
from rclpy.action import ActionClient
from workshop_interfaces.action import Countdown


async def spinning(node):
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.01)
        await asyncio.sleep(0.001)


async def count_down(client, start):
    goal = await client.send_goal_async(Countdown.Goal(start=start))
    answer = await goal.get_result_async()
    return list(answer.result.counted)


async def run(args):
    rclpy.init(args=args)
    node = rclpy.create_node("asyncio_client")
    client = ActionClient(node, Countdown, "countdown")
    client.wait_for_server()
    spin_task = asyncio.get_event_loop().create_task(spinning(node))
    print("together", await asyncio.gather(count_down(client, 2), count_down(client, 3)))
    print("alone", await count_down(client, 1))
    spin_task.cancel()
    rclpy.shutdown()


def main(args=None):
    asyncio.run(run(args))


if __name__ == "__main__":
    main()
