"""Waits for a frame in three ways: a coroutine, a future, and a call that holds up a thread of its own."""

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformListener


class PatientListener(Node):
    def __init__(self):
        super().__init__("patient_listener")
        self.buffer = Buffer(cache_time=Duration(seconds=3.0), node=self)
        self.listener = TransformListener(self.buffer, self)
        groups = [MutuallyExclusiveCallbackGroup() for _ in range(3)]
        tasks = [self.in_coroutine, self.by_future, self.in_thread]
        self.starters = [
            self.create_timer(0.5, task, callback_group=group) for task, group in zip(tasks, groups, strict=True)
        ]

    def say(self, how, seen):
        self.get_logger().info(f"{how}: {seen.transform.translation.x:.1f}")

    async def in_coroutine(self):
        self.starters[0].cancel()
        self.say("coroutine", await self.buffer.lookup_transform_async("world", "gate", Time()))

    def by_future(self):
        self.starters[1].cancel()
        future = self.buffer.wait_for_transform_async("world", "gate", Time())
        future.add_done_callback(lambda done: self.say("future", done.result()))

    def in_thread(self):
        self.starters[2].cancel()
        there = self.buffer.can_transform("world", "gate", Time(), timeout=Duration(seconds=1.0))
        self.get_logger().info(f"thread, after one second: {there}")
        self.say("thread", self.buffer.lookup_transform("world", "gate", Time(), Duration(seconds=60.0)))


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(PatientListener())
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
