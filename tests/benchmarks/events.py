"""Events of three kinds, each made by a simulated rclpy program, by SimPy and by asyncio.

A work is made with the number of its events; called, it makes them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import simpy

from turtle_lesson.ros.runtime.world import World, open_world

Work = Callable[[], object]


# -- a timer that ticks ------------------------------------------------------------------------------------------


def rclpy_timer(count: int) -> Work:
    import rclpy

    world = open_world()

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("ticker")
        node.create_timer(0.001, lambda: None)
        rclpy.spin(node)

    world.spawn(main, name="ticker")
    return advance(world, count)


def advance(world: World, milliseconds: int) -> Work:
    return lambda: world.sim.run_until(world.now + milliseconds * 1_000_000)


def simpy_timer(count: int) -> Work:
    def work() -> None:
        environment = simpy.Environment()

        def tick() -> Any:
            while True:
                yield environment.timeout(1)

        environment.process(tick())
        environment.run(until=count)

    return work


def asyncio_timer(count: int) -> Work:
    async def tick() -> None:
        for _ in range(count):
            await asyncio.sleep(0)

    return lambda: asyncio.run(tick())


# -- a message from one program to another --------------------------------------------------------------------------


def rclpy_message(count: int) -> Work:
    import rclpy
    from geometry_msgs.msg import Twist

    world = open_world()

    def talker() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher, message = node.create_publisher(Twist, "chatter", 10), Twist()
        node.create_timer(0.001, lambda: publisher.publish(message))
        rclpy.spin(node)

    def listener() -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        node.create_subscription(Twist, "chatter", lambda message: None, 10)
        rclpy.spin(node)

    world.spawn(talker, name="talker")
    world.spawn(listener, name="listener")
    return advance(world, count)


def simpy_message(count: int) -> Work:
    def work() -> None:
        environment = simpy.Environment()
        store = simpy.Store(environment)

        def talker() -> Any:
            while True:
                yield environment.timeout(1)
                yield store.put({"linear": (0.0, 0.0, 0.0), "angular": (0.0, 0.0, 0.0)})

        def listener() -> Any:
            while True:
                yield store.get()

        environment.process(talker())
        environment.process(listener())
        environment.run(until=count)

    return work


def asyncio_message(count: int) -> Work:
    async def run() -> None:
        queue: asyncio.Queue[Any] = asyncio.Queue(1)

        async def listener() -> None:
            for _ in range(count):
                await queue.get()

        task = asyncio.create_task(listener())
        for _ in range(count):
            await asyncio.sleep(0)
            await queue.put({"linear": (0.0, 0.0, 0.0), "angular": (0.0, 0.0, 0.0)})
        await task

    return lambda: asyncio.run(run())


# -- a question and its answer ------------------------------------------------------------------------------------


def rclpy_service(count: int) -> Work:
    import rclpy
    from example_interfaces.srv import AddTwoInts

    def work() -> None:
        world = open_world()

        def server() -> None:
            rclpy.init()
            node = rclpy.create_node("server")
            node.create_service(AddTwoInts, "add", lambda request, response: response)
            rclpy.spin(node)

        def asker() -> None:
            rclpy.init()
            node = rclpy.create_node("asker")
            client, request = node.create_client(AddTwoInts, "add"), AddTwoInts.Request()
            for _ in range(count):
                rclpy.spin_until_future_complete(node, client.call_async(request))

        world.spawn(server, name="server")
        world.spawn(asker, name="asker")
        world.sim.run_until(count * 1_000_000)

    return work


def simpy_service(count: int) -> Work:
    def work() -> None:
        environment = simpy.Environment()
        requests, answers = simpy.Store(environment), simpy.Store(environment)

        def server() -> Any:
            while True:
                yield answers.put((yield requests.get()))

        def asker() -> Any:
            for number in range(count):
                yield requests.put(number)
                yield answers.get()

        environment.process(server())
        environment.run(until=environment.process(asker()))

    return work


def asyncio_service(count: int) -> Work:
    async def run() -> None:
        requests: asyncio.Queue[asyncio.Future[int]] = asyncio.Queue()

        async def server() -> None:
            while True:
                (await requests.get()).set_result(0)

        task = asyncio.create_task(server())
        for _ in range(count):
            future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
            await requests.put(future)
            await future
        task.cancel()

    return lambda: asyncio.run(run())


EVENTS = {
    "timer callback": (rclpy_timer, simpy_timer, asyncio_timer),
    "timer, publish and callback": (rclpy_message, simpy_message, asyncio_message),
    "service there and back": (rclpy_service, simpy_service, asyncio_service),
}
"""By the name of a row, what makes the events here, in SimPy and in asyncio."""
