"""Answers to the cases of page 09: mends of the fault, and of its symptom only, of half of it, or of something else."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "09_debugging_lab"
MESSAGE = solution(PAGE, "message_case")
MONITOR, NAVIGATOR = "ros2 run robot_controller status_monitor", "ros2 run robot_controller navigator"
LAUNCH = "ros2 launch robot_controller start_system.launch.py"
LIMITER = "ros2 run robot_draft speed_limiter"
STATUS = "ros2 topic pub -r 10 /robot/status robot_controller/msg/TurtleStatus"
EDIT, _, _ = MESSAGE.partition("cd trouble_ws")

NODE = """import rclpy
from robot_controller.msg import TurtleStatus
from turtlesim.msg import Pose
kill -INT 1004
rclpy.try_shutdown()
rclpy.init()
node = rclpy.create_node("status_monitor")
publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
status = TurtleStatus(battery=100.0)
def on_pose(pose):
    status.x, status.y = pose.x, pose.y
node.create_subscription(Pose, "/turtle1/pose", on_pose, 10)
_ = node.create_timer(0.1, lambda: publisher.publish(status))"""

FAKE = """import rclpy
from robot_controller.srv import NavigateTo
kill -INT 1004
rclpy.try_shutdown()
rclpy.init()
node = rclpy.create_node("navigator")
def on_goal(request, response):
    response.success = True
    return response
_ = node.create_service(NavigateTo, "/navigate_to", on_goal)"""

RELAY = """import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from robot_controller.srv import NavigateTo
rclpy.try_shutdown()
rclpy.init()
node = rclpy.create_node("relay")
group = ReentrantCallbackGroup()
client = node.create_client(NavigateTo, "/navigation/navigate_to", callback_group=group)
async def on_goal(request, response):
    return await client.call_async(request)
_ = node.create_service(NavigateTo, "/navigate_to", on_goal, callback_group=group)"""

PASS_ON = """import rclpy
from geometry_msgs.msg import Twist
kill -INT 1005
rclpy.try_shutdown()
rclpy.init()
node = rclpy.create_node("pass_on")
commands = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
_ = node.create_subscription(Twist, "/wanted_vel", commands.publish, 10)"""

ANSWERS = {
    "topic_case": Answers(
        wrong={
            "started again as it was": (
                f"kill -INT 1004 && {MONITOR} --ros-args -p publish_rate:=2",
                "every 500.0 ms",
            ),
            "the monitor is ended": ("kill -INT 1004", "it is not there"),
            "a second monitor": (MONITOR, "2 nodes of this name"),
            "nine a second": ("ros2 param set /status_monitor publish_rate 9", "every 111.1 ms"),
            "twenty a second": ("ros2 param set /status_monitor publish_rate 20", "every 50.0 ms"),
            "one every ten seconds": ("ros2 param set /status_monitor publish_rate 1", "every 1000.0 ms"),
            "another node's parameter": ("ros2 param set /obstacle_detector scan_rate 10", "every 500.0 ms"),
            "messages from the terminal beside it": (f'{STATUS} "{{battery: 99.0}}" &', "from 2 publishers"),
            "messages from the terminal in its place": (
                f'kill -INT 1004 && {STATUS} "{{battery: 99.0}}" &',
                "it is not there",
            ),
            "at the right rate on another topic": (
                f"kill -INT 1004 && {MONITOR} --ros-args -r /robot/status:=/status",
                "no node does",
            ),
            "under another name": (
                f"kill -INT 1004 && {MONITOR} --ros-args -r __node:=monitor",
                "it is not there; there is /monitor",
            ),
            "a node that does not follow the turtle": (
                changed(NODE, ("status.x, status.y = pose.x, pose.y", "pass")),
                "it says (0.00, 0.00)",
            ),
            "the launch beside the old one": (LAUNCH, "2 nodes of this name"),
        },
        right={
            "started anew": f"kill -INT 1004 && {MONITOR}",
            "started anew with the rate": f"kill -INT 1004 && {MONITOR} --ros-args -p publish_rate:=10",
            "all started anew by the launch file": f"kill -INT 1004 1005 1006\n{LAUNCH}",
            "in Python": 'handle = lesson.launch("robot_controller", "start_system.launch.py", publish_rate="10")\n'
            "kill -INT 1004 1005 1006",
            "a node in a cell": NODE,
        },
    ),
    "service_case": Answers(
        wrong={
            "started again as it was": (
                f"kill -INT 1004 && {NAVIGATOR} --ros-args -r /navigate_to:=/navigation/navigate_to",
                "no node offers it",
            ),
            "started under a third name": (
                f"kill -INT 1004 && {NAVIGATOR} --ros-args -r /navigate_to:=/navigate",
                "no node offers it",
            ),
            "a second navigator": (NAVIGATOR, "2 nodes of this name"),
            "the navigator is ended": ("kill -INT 1004", "it is not there"),
            "the caller uses the wrong name, too": (
                'ros2 service call /navigation/navigate_to robot_controller/srv/NavigateTo "{x: 8.0, y: 5.5}"',
                "no node offers it",
            ),
            "a service that always says yes": (FAKE, "success is True after 0.00 s, at (5.54, 5.54)"),
            "another node is started anew": (f"kill -INT 1005 && {MONITOR}", "no node offers it"),
            "the drive is done by hand": (
                'ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute "{x: 8.0, y: 5.5}"',
                "no node offers it",
            ),
            "its commands go astray": (
                f"kill -INT 1004 && {NAVIGATOR} --ros-args -r /turtle1/cmd_vel:=/cmd_vel",
                "success is False",
            ),
        },
        right={
            "all started anew by the launch file": f"kill -INT 1004 1005 1006\n{LAUNCH}",
            "a remapping that puts it right": f"kill -INT 1004 && {NAVIGATOR} --ros-args -r navigate_to:=/navigate_to",
            "with a longer time-out": f"kill -INT 1004 && {NAVIGATOR} --ros-args -p goal_timeout:=8.0",
            "a node that passes the calls on": RELAY,
        },
    ),
    "message_case": Answers(
        wrong={
            "built again": ("cd trouble_ws\ncolcon build\ncd ..", "it is not found at all"),
            "sourced only": (
                f"source trouble_ws/install/setup.bash\n{MONITOR}",
                "robot_controller/msg/TurtleStatus",
            ),
            "built and sourced, but not named": (
                f"cd trouble_ws\ncolcon build\nsource install/setup.bash\ncd ..\n{MONITOR}",
                "no program can use it here",
            ),
            "named, but not built": (f"{EDIT}source trouble_ws/install/setup.bash", "no program can use it here"),
            "named and built, but not sourced": (f"{EDIT}cd trouble_ws\ncolcon build\ncd ..", "it is not found at all"),
            "no monitor started": (MESSAGE.replace(MONITOR, ""), "it is not there"),
            "the workspace that is well, instead": (
                f"source workspace/install/setup.bash\n{MONITOR}",
                "it is found in workspace/install/robot_controller",
            ),
            "the service's file instead": (
                changed(MESSAGE, ('"msg/TurtleStatus.msg"', '"srv/NavigateTo.srv"')),
                "no program can use it here",
            ),
        },
        right={
            "the whole file anew": "import shutil\n"
            'shutil.copy("workspace/src/robot_controller/CMakeLists.txt", "trouble_ws/src/robot_controller/CMakeLists.txt")\n'
            f"cd trouble_ws\ncolcon build --packages-select robot_controller\nsource install/setup.bash\n{MONITOR}",
            "without quotation marks": changed(MESSAGE, ("""' "msg/TurtleStatus.msg"'""", "' msg/TurtleStatus.msg'")),
            "local_setup.bash": changed(MESSAGE, ("setup.bash", "local_setup.bash")),
            "the launch file": changed(MESSAGE, (MONITOR, LAUNCH)),
        },
    ),
    "turtle_case": Answers(
        wrong={
            "more patience": ("ros2 param set /navigator goal_timeout 25.0", "s on average"),
            "more speed": ("ros2 param set /speed_limiter max_speed 8.0", "success is False"),
            "a command a second": ("ros2 param set /speed_limiter command_period 1.0", "s on average"),
            "a command each half second": ("ros2 param set /speed_limiter command_period 0.5", "s on average"),
            "the limiter is ended": ("kill -INT 1005", "success is False"),
            "the limiter started again as it was": (
                f"kill -INT 1005 && {LIMITER} --ros-args -p command_period:=4.0",
                "success is False",
            ),
            "a second navigator": (NAVIGATOR, "2 nodes of this name"),
            "commands from the terminal": (
                'ros2 topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}}" &',
                "success is False",
            ),
            "the simulator started again": (
                "kill -INT 1003 && ros2 run turtlesim turtlesim_node",
                "success is False",
            ),
            "the turtle put there": (
                'ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute "{x: 8.0, y: 5.5}"',
                "success is False",
            ),
            "the navigator is ended": ("kill -INT 1004", "it is not there"),
        },
        right={
            "the limiter started anew": f"kill -INT 1005 && {LIMITER}",
            "no pause at all": "ros2 param set /speed_limiter command_period 0.0",
            "without a limiter": f"kill -INT 1004 1005\n{NAVIGATOR}",
            "all started anew by the launch file": f"kill -INT 1004 1005 1006 1007\n{LAUNCH}",
            "another node in the limiter's place": PASS_ON,
        },
    ),
}
