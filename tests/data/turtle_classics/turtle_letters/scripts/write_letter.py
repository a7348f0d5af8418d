#!/usr/bin/env python3
"""Writes a letter: the pen is lifted between its strokes, and put down for them."""

import sys
import time

import rclpy
from rclpy.node import Node
from turtle_letters.strokes import STROKES
from turtlesim.srv import SetPen, TeleportAbsolute


class Writer(Node):
    def __init__(self):
        super().__init__("writer")
        self.colour = self.declare_parameter("colour", [255, 0, 0]).value
        self.pen = self.create_client(SetPen, "/turtle1/set_pen")
        self.teleport = self.create_client(TeleportAbsolute, "/turtle1/teleport_absolute")
        for client in (self.pen, self.teleport):
            if not client.wait_for_service(timeout_sec=5.0):
                raise SystemExit(f"{client.srv_name} is not there")

    def call(self, client, request):
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def set_pen(self, down):
        red, green, blue = self.colour
        self.call(self.pen, SetPen.Request(r=red, g=green, b=blue, width=4, off=0 if down else 1))

    def move(self, x, y):
        self.call(self.teleport, TeleportAbsolute.Request(x=4.0 + x, y=4.0 + y, theta=0.0))
        time.sleep(0.05)  # it goes there with its next tick, drawing or not as its pen is then

    def write(self, letter):
        for start, *others in STROKES[letter]:
            self.set_pen(down=False)
            self.move(*start)
            self.set_pen(down=True)
            for point in others:
                self.move(*point)
        self.get_logger().info(f"wrote {letter}")


def main():
    rclpy.init()
    letters = rclpy.utilities.remove_ros_args(sys.argv)[1:]
    node = Writer()
    for letter in letters:
        node.write(letter.upper())
    rclpy.shutdown()


if __name__ == "__main__":
    main()
