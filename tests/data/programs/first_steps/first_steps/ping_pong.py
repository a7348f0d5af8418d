"""Two nodes that hit a ball back and forth, each spun by an executor in a thread of its own."""
import threading

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32


class Player(Node):

    def __init__(self, name, hears, says):
        super().__init__(name)
        self.publisher = self.create_publisher(Int32, says, 1)
        self.create_subscription(Int32, hears, self.hit, 1)
        self.hits = 0

    def hit(self, ball):
        self.hits += 1
        self.publisher.publish(Int32(data=ball.data + 1))


def main():
    rclpy.init()
    ping, pong = Player('ping', 'left', 'right'), Player('pong', 'right', 'left')
    executors = [SingleThreadedExecutor(), SingleThreadedExecutor()]
    threads = []
    for player, executor in zip((ping, pong), executors):
        executor.add_node(player)
        threads.append(threading.Thread(target=executor.spin, daemon=True))
        threads[-1].start()
    ping.publisher.publish(Int32(data=0))
    rate = pong.create_rate(100)
    while pong.hits < 50:
        rate.sleep()
    print('at least 50:', pong.hits >= 50, 'fair:', abs(ping.hits - pong.hits) <= 1)
    rclpy.shutdown()
    for thread in threads:
        thread.join()
    print('over')
