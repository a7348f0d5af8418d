"""Which gain is best on a slow network? Run it with: turtle-lesson run experiments/turning.py --csv turning.csv"""

import random
from pathlib import Path

from turtle_lesson.experiments import experiment

PACKAGE = Path(__file__).parents[1] / "src" / "patrol"


def drive(lesson, gain, latency=0.0):
    """How long the first four corners take, in seconds."""
    import rclpy
    from std_msgs.msg import Int32
    from turtlesim.srv import TeleportAbsolute

    rclpy.init()
    node = rclpy.create_node("observer")
    heard = [0]
    node.create_subscription(Int32, "/patrol/reached", lambda message: heard.append(message.data), 10)
    somewhere = TeleportAbsolute.Request(x=random.uniform(1, 10), y=random.uniform(1, 10), theta=random.uniform(-3, 3))
    node.create_client(TeleportAbsolute, "/turtle1/teleport_absolute").call(somewhere)
    lesson.network("/turtle1/*", latency=latency)
    lesson.launch("patrol", "patrol.launch.py", gain=gain)
    began = lesson.now
    while heard[-1] < 4:
        assert lesson.now < began + 90, f"only {heard[-1]} corners in 90 s"
        lesson.spin(0.1, node)
    return {"seconds": round(lesson.now - began, 1)}


results = experiment(drive, seeds=range(10), gain=[1.0, 2.0, 4.0], latency=0.1, package=PACKAGE)
print(results.quantiles("seconds", by="gain"))
