#!/usr/bin/env python3
"""A menu in the main thread, while the node spins in another."""
import math
import threading
import time

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose
from turtlesim.srv import SetPen, Spawn, TeleportAbsolute
from std_srvs.srv import Empty


class TurtleMenu(Node):
    def __init__(self):
        super().__init__('turtle_menu')
        self.cmd = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.create_subscription(Pose, '/turtle1/pose', self.pose_callback, 10)
        self.pen = self.create_client(SetPen, '/turtle1/set_pen')
        self.teleport = self.create_client(TeleportAbsolute, '/turtle1/teleport_absolute')
        self.reset = self.create_client(Empty, '/reset')
        self.spawn = self.create_client(Spawn, '/spawn')
        self.pose = None

    def pose_callback(self, msg):
        self.pose = msg

    def move(self, v, w, seconds):
        msg = Twist()
        msg.linear.x = v
        msg.angular.z = w
        end = time.time() + seconds
        while time.time() < end:
            self.cmd.publish(msg)
            time.sleep(0.1)
        self.cmd.publish(Twist())


CHOICES = ['1', '2', '3', 'x', 'q']


def main(args=None):
    rclpy.init(args=args)
    node = TurtleMenu()
    spinner = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinner.start()
    while node.pose is None:
        time.sleep(0.05)
    print('1: forward  2: turn  3: spawn  q: quit')
    for choice in CHOICES:  # stands for input()
        if choice == '1':
            node.move(1.0, 0.0, 2.0)
            print('x = %.2f' % node.pose.x)
        elif choice == '2':
            node.move(0.0, math.pi / 4, 2.0)
            print(f'theta = {math.degrees(node.pose.theta):.0f}')
        elif choice == '3':
            request = Spawn.Request(x=2.0, y=2.0, theta=0.0, name='friend')
            if not node.spawn.wait_for_service(timeout_sec=1.0):
                print('no simulator')
                continue
            print('spawned', node.spawn.call(request).name)
        elif choice == 'q':
            break
        else:
            print('unknown choice', choice)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
