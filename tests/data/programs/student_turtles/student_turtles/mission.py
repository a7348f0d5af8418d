"""Services that are awaited one after the other, and the future's callbacks."""
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from std_srvs.srv import Empty
from turtlesim.srv import Kill, SetPen, Spawn


class Mission(Node):
    def __init__(self):
        super().__init__('mission')
        inner = MutuallyExclusiveCallbackGroup()
        self.kill_client = self.create_client(Kill, 'kill', callback_group=inner)
        self.spawn_client = self.create_client(Spawn, 'spawn', callback_group=inner)
        self.clear_client = self.create_client(Empty, 'clear', callback_group=inner)
        self.srv = self.create_service(Empty, 'go', self.go)

    async def go(self, request, response):
        killed = await self.kill_client.call_async(Kill.Request(name='turtle1'))
        self.get_logger().info(f'killed: {killed}')
        for i in range(2):
            made = await self.spawn_client.call_async(Spawn.Request(x=1.0 + i, y=5.0, name=f't{i}'))
            pen = self.create_client(SetPen, f'{made.name}/set_pen')
            pen.call_async(SetPen.Request(r=255, off=0)).add_done_callback(
                lambda future, name=made.name: self.get_logger().info(f'{name} has a pen: {future.result() is not None}'))
        return response


def main():
    rclpy.init()
    rclpy.spin(Mission())
