"""Spawns turtles now and then, tells which are free, and takes those away that are caught."""

import random
from functools import partial

import rclpy
from hunt_interfaces.msg import Prey, PreyArray
from hunt_interfaces.srv import Catch
from rclpy.node import Node
from turtlesim.srv import Kill, Spawn


class Spawner(Node):
    def __init__(self):
        super().__init__("spawner")
        self.declare_parameter("period", 2.0)
        self.declare_parameter("prefix", "turtle")
        self.declare_parameter("most", 0)
        self.count = 0
        self.free = {}
        self.publisher = self.create_publisher(PreyArray, "free_turtles", 10)
        self.spawn_client = self.create_client(Spawn, "spawn")
        self.kill_client = self.create_client(Kill, "kill")
        self.create_service(Catch, "catch_turtle", self.on_catch)
        self.timer = self.create_timer(self.get_parameter("period").value, self.spawn)

    def spawn(self):
        most = self.get_parameter("most").value
        if most and self.count >= most:
            self.timer.cancel()
            return
        if not self.spawn_client.service_is_ready():
            self.get_logger().warning("waiting for turtlesim")
            return
        self.count += 1
        request = Spawn.Request()
        request.name = f"{self.get_parameter('prefix').value}_{self.count}"
        request.x, request.y = random.uniform(1.0, 10.0), random.uniform(1.0, 10.0)
        future = self.spawn_client.call_async(request)
        future.add_done_callback(partial(self.on_spawned, request))

    def on_spawned(self, request, future):
        name = future.result().name
        if name:
            self.free[name] = Prey(name=name, x=request.x, y=request.y)
            self.tell()

    def on_catch(self, request, response):
        response.success = self.free.pop(request.name, None) is not None
        response.left = len(self.free)
        if response.success:
            self.kill_client.call_async(Kill.Request(name=request.name))
            self.tell()
        return response

    def tell(self):
        self.publisher.publish(PreyArray(free=list(self.free.values())))


def main(args=None):
    rclpy.init(args=args)
    node = Spawner()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
