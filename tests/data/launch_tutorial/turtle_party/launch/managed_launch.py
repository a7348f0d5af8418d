from launch import LaunchDescription
from launch.actions import EmitEvent, LogInfo, RegisterEventHandler
from launch.events import matches_action
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition


def generate_launch_description():
    one = LifecycleNode(package="turtle_party", executable="managed", name="one", namespace="", output="screen")

    def ask(transition):
        return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(one), transition_id=transition))

    return LaunchDescription(
        [
            RegisterEventHandler(
                OnStateTransition(
                    target_lifecycle_node=one,
                    start_state="configuring",
                    goal_state="inactive",
                    entities=[LogInfo(msg="inactive now"), ask(Transition.TRANSITION_ACTIVATE)],
                )
            ),
            RegisterEventHandler(
                OnStateTransition(target_lifecycle_node=one, goal_state="active", entities=[LogInfo(msg="active now")])
            ),
            one,
            ask(Transition.TRANSITION_CONFIGURE),
            LifecycleNode(
                package="turtle_party", executable="managed", name="two", namespace="", autostart=True, output="screen"
            ),
        ]
    )
