"""Answers to the exercises of page 06."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "06_parameters_and_launch"

# -- parameters ----------------------------------------------------------------------------------------------------------

FOLLOWS = solution(PAGE, "parameters")
RATE = '        rate = self.get_parameter("publish_rate").value\n'
PERIOD = "        self.timer.timer_period_ns = round(1e9 / rate)"
MONITOR = FOLLOWS.partition("\n")[0]
CLASS = f"""{MONITOR}

class StatusMonitorNode(Node):
    def __init__(self):
        super().__init__("status_monitor")
        self.status = TurtleStatus(battery=100.0)
        self.publisher = self.create_publisher(TurtleStatus, "/robot/status", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 1)
        rate = self.declare_parameter("publish_rate", 10).value
        self.timer = self.create_timer(1 / rate, self.on_timer)
"""


def paced(*lines: str) -> str:
    """The solution with other lines at the end of on_timer."""
    return changed(FOLLOWS, (RATE + PERIOD, "\n".join(f"        {line}" for line in lines)))


PARAMETERS = Answers(
    wrong={
        "a period in seconds": (changed(FOLLOWS, ("round(1e9 / rate)", "1 / rate")), "nanoseconds"),
        "a period in milliseconds": (changed(FOLLOWS, ("1e9", "1e3")), "more than 1000 Hz"),
        "a period in microseconds": (changed(FOLLOWS, ("1e9", "1e6")), "more than 1000 Hz"),
        "the rate as a period": (changed(FOLLOWS, ("1e9 / rate", "1e7 * rate")), "then every 200.0 ms (5.0 Hz)"),
        "always 20 Hz": (changed(FOLLOWS, (RATE, "        rate = 20\n")), "every 50.0 ms (20.0 Hz)"),
        "a parameter of another name": (changed(FOLLOWS, ('"publish_rate"', '"rate"')), "ParameterNotDeclared"),
        "only ever faster": (
            paced(
                "period = round(1e9 / self.get_parameter('publish_rate').value)",
                "self.timer.timer_period_ns = min(period, self.timer.timer_period_ns)",
            ),
            "then every 50.0 ms (20.0 Hz)",
        ),
        "never slower than at first": (
            paced(
                "rate = self.get_parameter('publish_rate').value",
                "self.timer.timer_period_ns = round(1e9 / max(rate, 10))",
            ),
            "then every 100.0 ms (10.0 Hz)",
        ),
        "one timer more each time": (
            paced(
                "rate = self.get_parameter('publish_rate').value",
                "if rate != getattr(self, 'rate', 10):",
                "    self.create_timer(1 / rate, self.on_timer)",
                "self.rate = rate",
            ),
            "from",
        ),
        "the node's own default is 20": (
            (FOLLOWS, changed(CLASS, ('"publish_rate", 10', '"publish_rate", 20'))),
            "it is 20",
        ),
        "the parameter is not declared": (
            (FOLLOWS, changed(CLASS, ('rate = self.declare_parameter("publish_rate", 10).value', "rate = 10"))),
            "it is not declared",
        ),
    },
    right={
        "a new timer": paced(
            "rate = self.get_parameter('publish_rate').value",
            "if rate != getattr(self, 'rate', 10):",
            "    self.timer.cancel()",
            "    self.timer = self.create_timer(1 / rate, self.on_timer)",
            "self.rate = rate",
        ),
        "the old timer is destroyed": paced(
            "self.destroy_timer(self.timer)",
            "self.timer = self.create_timer(1 / self.get_parameter('publish_rate').value, self.on_timer)",
        ),
        "the typed value": changed(FOLLOWS, (").value", ").get_parameter_value().integer_value")),
        "get_parameters": changed(
            FOLLOWS, ('get_parameter("publish_rate").value', 'get_parameters(["publish_rate"])[0].value')
        ),
        "the period first": changed(
            paced(),
            (
                "        self.publisher.publish(self.status)\n",
                RATE + PERIOD + "\n        self.publisher.publish(self.status)\n",
            ),
        ),
        "a callback for parameters": (
            paced(),
            CLASS
            + """        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, parameters):
        from rcl_interfaces.msg import SetParametersResult
        for parameter in parameters:
            if parameter.name == "publish_rate":
                self.timer.timer_period_ns = 1_000_000_000 // parameter.value
        return SetParametersResult(successful=True)
""",
        ),
        "a fast timer that waits for its time": (
            changed(
                paced(),
                (
                    "        self.publisher.publish",
                    "        self.waited += 1\n"
                    "        if self.waited < 200 / self.get_parameter('publish_rate').value:\n            return\n"
                    "        self.waited = 0\n        self.publisher.publish",
                ),
            ),
            changed(CLASS, ("1 / rate", "0.005"), ("        super()", "        self.waited = 0\n        super()")),
        ),
    },
)

# -- launch --------------------------------------------------------------------------------------------------------------

LAUNCH = solution(PAGE, "launch")
FILE = LAUNCH.partition("\n")[0]
HEAD = f"""{FILE}
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
"""
LONG = f"""{HEAD}
def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("goal_timeout", default_value="5.0", description="Seconds"),
        DeclareLaunchArgument("publish_rate", default_value="10"),
        DeclareLaunchArgument("scan_rate", default_value="5"),
        Node(package="robot_controller", executable="navigator", name="navigator",
             parameters=[{{"goal_timeout": LaunchConfiguration("goal_timeout")}}]),
        Node(package="robot_controller", executable="status_monitor", name="status_monitor",
             parameters=[{{"publish_rate": LaunchConfiguration("publish_rate")}}]),
        Node(package="robot_controller", executable="obstacle_detector", name="obstacle_detector",
             parameters=[{{"scan_rate": LaunchConfiguration("scan_rate")}}]),
    ])
"""
DETECTOR = ' + one("obstacle_detector", "scan_rate", "5")'

SYSTEM = Answers(
    wrong={
        "values in place of arguments": (
            changed(
                LONG,
                ('LaunchConfiguration("goal_timeout")', "5.0"),
                ('LaunchConfiguration("publish_rate")', "10"),
                ('LaunchConfiguration("scan_rate")', "5"),
            ),
            "goal_timeout is 5.0 then",
        ),
        "two parameters are left out": (
            changed(
                LONG,
                ('             parameters=[{"publish_rate": LaunchConfiguration("publish_rate")}]),\n', "        ),\n"),
                ('             parameters=[{"scan_rate": LaunchConfiguration("scan_rate")}]),\n', "        ),\n"),
            ),
            "scan_rate is 5 then",
        ),
        "an argument that nobody uses": (
            changed(LONG, ('LaunchConfiguration("publish_rate")', "10")),
            "publish_rate is 10 then",
        ),
        "an argument of another name": (
            changed(
                LONG,
                ('DeclareLaunchArgument("publish_rate"', 'DeclareLaunchArgument("rate"'),
                ('LaunchConfiguration("publish_rate")', 'LaunchConfiguration("rate")'),
            ),
            "publish_rate is 10 then",
        ),
        "a second simulator": (
            changed(
                LAUNCH,
                (DETECTOR, DETECTOR + ' + [Node(package="turtlesim", executable="turtlesim_node")]'),
            ),
            "there is 2 × /turtlesim, too",
        ),
        "a navigator more": (
            changed(
                LAUNCH,
                (DETECTOR, DETECTOR + ' + [Node(package="robot_controller", executable="navigator", name="second")]'),
            ),
            "there is /second, too",
        ),
        "two nodes only": (changed(LAUNCH, (DETECTOR, "")), "it is not there"),
        "a whole number for a double": (changed(LAUNCH, ('"5.0"', '"5"')), "it is not there"),
        "the rates exchanged": (changed(LAUNCH, ('"10"', '"5"'), ('"scan_rate", "5"', '"scan_rate", "10"')), "it is 5"),
        "another default": (changed(LAUNCH, ('"5.0"', '"10.0"')), "it is 10.0"),
        "another name": (
            changed(LONG, ('name="status_monitor"', 'name="monitor"')),
            "there is /monitor, /navigator and /obstacle_detector",
        ),
        "a comma is missing": (changed(LONG, ('value="10"),', 'value="10")')), "ros2 launch robot_controller"),
        "all in a namespace": (
            changed(LONG, ('name="navigator",', 'name="navigator", namespace="robot",')),
            "/robot/navigator",
        ),
        "parameters without a list of dictionaries": (
            changed(LONG, ('[{"scan_rate": LaunchConfiguration("scan_rate")}]', '{"scan_rate": 5}')),
            "ros2 launch robot_controller",
        ),
    },
    right={
        "three times in full": LONG,
        "a loop": f"""{HEAD}
NODES = {{"navigator": ("goal_timeout", "5.0"), "status_monitor": ("publish_rate", "10"),
         "obstacle_detector": ("scan_rate", "5")}}

def generate_launch_description():
    description = LaunchDescription()
    for name, (parameter, default) in NODES.items():
        description.add_action(DeclareLaunchArgument(parameter, default_value=default))
        description.add_action(Node(
            package="robot_controller", executable=name, name=name,
            parameters=[{{parameter: LaunchConfiguration(parameter)}}]))
    return description
""",
        "typed values": changed(
            LONG,
            (
                "from launch_ros.actions import Node",
                "from launch_ros.actions import Node\nfrom launch_ros.parameter_descriptions import ParameterValue",
            ),
            (
                'LaunchConfiguration("goal_timeout")',
                'ParameterValue(LaunchConfiguration("goal_timeout"), value_type=float)',
            ),
            ('default_value="5.0"', 'default_value="5"'),
        ),
        "names left to the nodes": changed(LONG, (' name="navigator",', ""), (' name="status_monitor",', "")),
        "a function that is given the context": f"""{HEAD}
from launch.actions import OpaqueFunction

def nodes(context):
    value = context.launch_configurations
    return [
        Node(package="robot_controller", executable="navigator",
             parameters=[{{"goal_timeout": float(value["goal_timeout"])}}]),
        Node(package="robot_controller", executable="status_monitor",
             parameters=[{{"publish_rate": int(value["publish_rate"])}}]),
        Node(package="robot_controller", executable="obstacle_detector",
             parameters=[{{"scan_rate": int(value["scan_rate"])}}]),
    ]

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("goal_timeout", default_value="5.0"),
        DeclareLaunchArgument("publish_rate", default_value="10"),
        DeclareLaunchArgument("scan_rate", default_value="5"),
        OpaqueFunction(function=nodes),
    ])
""",
        "ros arguments": changed(
            LONG,
            (
                'parameters=[{"scan_rate": LaunchConfiguration("scan_rate")}]',
                'ros_arguments=["-p", ["scan_rate:=", LaunchConfiguration("scan_rate")]]',
            ),
        ),
    },
)

# -- side by side --------------------------------------------------------------------------------------------------------

SIDES = solution(PAGE, "side_by_side")
SIDES_FILE = SIDES.partition("\n")[0]
REMAP = '        remappings=[("/robot/status", "robot/status")],\n'
BOTH = '[monitor("slow", 5), monitor("fast", 20)]'

SIDE_BY_SIDE = Answers(
    wrong={
        "slow and fast exchanged": (changed(SIDES, (BOTH, '[monitor("slow", 20), monitor("fast", 5)]')), "it is 20"),
        "a third monitor": (
            changed(SIDES, (BOTH, '[monitor("slow", 5), monitor("fast", 20), monitor("third", 10)]')),
            "there is /third/status_monitor, too",
        ),
        "a third one without a namespace": (
            changed(SIDES, (BOTH, BOTH[:-1] + ', Node(package="robot_controller", executable="status_monitor")]')),
            "/status_monitor",
        ),
        "no remapping": (changed(SIDES, (REMAP, "")), "does"),
        "both at 20": (changed(SIDES, ('"slow", 5', '"slow", 20')), "it is 20"),
        "no rate": (changed(SIDES, (' parameters=[{"publish_rate": rate}],', "")), "it is 10"),
        "names in place of namespaces": (
            changed(SIDES, ("namespace=namespace", 'name=namespace + "_monitor"')),
            "there is /fast_monitor and /slow_monitor, too",
        ),
        "another namespace": (
            changed(SIDES, ('monitor("slow", 5)', 'monitor("slowly", 5)')),
            "there is 1 × /fast/status_monitor and 1 × /slowly/status_monitor",
        ),
        "the one topic of both": (
            changed(SIDES, ('("/robot/status", "robot/status")', '("/robot/status", "/slow/robot/status")')),
            "do: ",
        ),
        "another topic": (
            changed(SIDES, ('"robot/status")', '"status")')),
            "no node does",
        ),
        "slow alone, twice": (
            changed(SIDES, (BOTH, '[monitor("slow", 5), monitor("slow", 5)]')),
            "there is 2 × /slow/status_monitor",
        ),
        "with a simulator": (
            changed(SIDES, (BOTH, BOTH[:-1] + ', Node(package="turtlesim", executable="turtlesim_node")]')),
            "there is 2 × /turtlesim, too",
        ),
    },
    right={
        "two nodes in full": f"""{SIDES_FILE}
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="robot_controller", executable="status_monitor", namespace="fast", name="status_monitor",
             parameters=[{{"publish_rate": 20}}], remappings=[("/robot/status", "/fast/robot/status")]),
        Node(package="robot_controller", executable="status_monitor", namespace="/slow", name="status_monitor",
             parameters=[{{"publish_rate": 5}}], remappings=[("/robot/status", "/slow/robot/status")]),
    ])
""",
        "groups": f"""{SIDES_FILE}
from launch import LaunchDescription
from launch.actions import GroupAction
from launch_ros.actions import Node, PushRosNamespace, SetRemap

def side(name, rate):
    monitor = Node(package="robot_controller", executable="status_monitor", parameters=[{{"publish_rate": rate}}])
    return GroupAction([PushRosNamespace(name), SetRemap("/robot/status", "robot/status"), monitor])

def generate_launch_description():
    return LaunchDescription([side("slow", 5), side("fast", 20)])
""",
        "command lines": f"""{SIDES_FILE}
from launch import LaunchDescription
from launch_ros.actions import Node

def side(name, rate):
    return Node(
        package="robot_controller", executable="status_monitor",
        arguments=["--ros-args", "-r", f"__ns:=/{{name}}", "-r", "/robot/status:=robot/status",
                   "-p", f"publish_rate:={{rate}}"],
    )

def generate_launch_description():
    return LaunchDescription([side("slow", 5), side("fast", 20)])
""",
        "a loop": changed(SIDES, (BOTH, "[monitor(side, hz) for side, hz in dict(slow=5, fast=20).items()]")),
        "with arguments": changed(
            SIDES,
            (
                "from launch_ros.actions import Node",
                "from launch.actions import DeclareLaunchArgument\n"
                "from launch.substitutions import LaunchConfiguration\nfrom launch_ros.actions import Node",
            ),
            (
                BOTH,
                '[DeclareLaunchArgument("rate", default_value="5"), '
                'monitor("slow", LaunchConfiguration("rate")), monitor("fast", 20)]',
            ),
        ),
    },
)

ANSWERS = {"parameters": PARAMETERS, "launch": SYSTEM, "side_by_side": SIDE_BY_SIDE}
