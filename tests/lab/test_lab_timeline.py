"""The timeline and the sequence diagram: what they tell of what really happened."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest
import rclpy

from turtle_lesson import Lesson, start

SIMPLE = Path(__file__).parents[1] / "data" / "simple_stage"


@pytest.fixture
def lesson() -> Iterator[Lesson]:
    lesson = start()
    yield lesson
    lesson._world.close()


def sleepy(group: str = "", threads: int = 1, name: str = "sleepy") -> None:
    """A node with a timer that takes half a second of each second, and another that ticks ten times a second."""
    import rclpy
    from rclpy.callback_groups import ReentrantCallbackGroup
    from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
    from rclpy.node import Node

    class Sleepy(Node):
        def __init__(self) -> None:
            super().__init__(name)
            callbacks = ReentrantCallbackGroup() if group else None
            self.create_timer(1.0, self.on_slow, callbacks)
            self.create_timer(0.1, self.on_tick, callbacks)

        def on_slow(self) -> None:
            time.sleep(0.55)

        def on_tick(self) -> None:
            pass

    rclpy.init()
    executor = MultiThreadedExecutor(threads) if threads > 1 else SingleThreadedExecutor()
    executor.add_node(Sleepy())
    executor.spin()


def test_a_sleeping_callback_holds_up_the_others(lesson: Lesson) -> None:
    lesson._world.spawn(sleepy, name="sleepy")
    lesson.run(2.9)
    assert repr(lesson.plot_timeline("/sleepy")) == (
        "Timeline from 0.00 s to 2.90 s of robot time. "
        "/sleepy.on_slow (every 1 s): 2 calls, one every 1000.0 ms on average, the longest gap 1000.0 ms; "
        "lasted at most 0.55 s, 1.10 s in all. "
        "/sleepy.on_tick (every 0.1 s): 18 calls, one every 158.8 ms on average, the longest gap 650.0 ms; "
        "none took any robot time; 2 had to wait, at most 0.55 s; 10 ticks were skipped."
    )


def test_with_several_threads_nothing_waits(lesson: Lesson) -> None:
    lesson._world.spawn(lambda: sleepy("reentrant", 2), name="sleepy")
    lesson.run(2.9)
    text = lesson.plot_timeline("sleepy.on_tick").text
    assert "28 calls, one every 100.0 ms on average, the longest gap 100.0 ms; none took any robot time." in text


def test_an_async_callback_awaits_and_others_run(lesson: Lesson) -> None:
    import rclpy

    lesson.launch("robot_controller", "start_system.launch.py")
    from robot_controller.srv import NavigateTo

    rclpy.init()
    client = rclpy.create_node("me").create_client(NavigateTo, "/navigate_to")
    client.call_async(NavigateTo.Request(x=8.0, y=5.5))
    lesson.run(0.5)
    text = lesson.plot_timeline("/navigator").text
    assert "on_navigate_to (/navigate_to): 1 call; it awaited 0.50 s; 1 continues." in text
    assert "/navigator.on_steering_timer (every 0.1 s): 10 calls" in text


def test_topics_are_shown_without_being_disturbed(lesson: Lesson) -> None:
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(2.05)
    before = lesson._recording.node.count_subscribers("/turtle1/color_sensor")
    picture = lesson.plot_timeline("/robot/status", "turtle1/color_sensor", since=1.0, until=2.0)
    assert picture.text == (
        "Timeline from 1.00 s to 2.00 s of robot time. "
        "/robot/status: 11 messages, one every 100.0 ms on average (10.0 Hz), the shortest interval 100.0 ms and the "
        "longest 100.0 ms; the last at 2.00 s. "
        "/turtle1/color_sensor: 63 messages, one every 16.0 ms on average (62.5 Hz), the shortest interval 16.0 ms and the "
        "longest 16.0 ms; the last at 2.00 s."
    )
    assert picture.png()
    assert lesson._recording.node.count_subscribers("/turtle1/color_sensor") == before


def test_a_topic_of_two_publishers_and_one_that_fell_silent(lesson: Lesson) -> None:
    first = lesson.launch("robot_controller", "start_system.launch.py")
    lesson.launch("robot_controller", "start_system.launch.py", publish_rate=10, scan_rate=4)
    lesson.run(1)
    text = lesson.plot_timeline("/obstacles").text
    assert "12 messages" in text
    first.stop()
    lesson.run(4)
    assert "then nothing" not in lesson.plot_timeline("/obstacles").text
    lesson._world.processes[-1].interrupt()
    lesson.run(4)
    assert "then nothing for 4." in lesson.plot_timeline("/obstacles").text


def test_without_names_all_nodes_are_shown_as_a_picture(lesson: Lesson) -> None:
    lesson.run(1)
    picture = lesson.plot_timeline()
    assert picture.text.startswith(
        "Timeline from 0.00 s to 1.00 s of robot time. /turtlesim._on_command (/turtle1/cmd_vel)"
    )
    assert picture.figure is not None
    assert picture.figure.get_size_inches()[0] == 6.4


def test_before_any_time_has_passed_it_says_so(lesson: Lesson) -> None:
    assert "No robot time has passed yet" in lesson.plot_timeline("/turtlesim").text
    assert "No callback has run yet" in start(simulator=False).plot_timeline().text


def test_what_is_no_row_is_explained(lesson: Lesson) -> None:
    lesson.run(1)
    with pytest.raises(ValueError, match='Did you mean "/turtle1/pose"'):
        lesson.plot_timeline("/turtle1/poes")
    with pytest.raises(TypeError, match="a row is the name of a topic or of a node"):
        lesson.plot_timeline(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"has no callback tick\. It has: _on_clear"):
        lesson.plot_timeline("/turtlesim.tick")
    with pytest.raises(ValueError, match="since must be a time"):
        lesson.plot_timeline("/turtlesim", since="then")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="since must come before until"):
        lesson.plot_timeline("/turtlesim", since=5)


# -- the sequence diagram ----------------------------------------------------------------------------------------------


@pytest.fixture
def simple(tmp_path: Path) -> Iterator[Lesson]:
    """The navigator that sleeps in its service's callback."""
    import shutil

    from turtle_lesson.learner.story import FINISHED

    shutil.copytree(FINISHED, tmp_path / "robot_controller")
    shutil.copytree(SIMPLE, tmp_path / "robot_controller", dirs_exist_ok=True)
    lesson = start(package=tmp_path / "robot_controller")
    lesson.launch("robot_controller", "start_system.launch.py")
    yield lesson
    lesson._world.close()


def test_a_call_is_told_from_the_question_to_the_answer(simple: Lesson) -> None:
    import rclpy
    from robot_controller.srv import NavigateTo

    rclpy.init()
    client = rclpy.create_node("asker").create_client(NavigateTo, "/navigate_to")
    client.call_async(NavigateTo.Request(x=0.2))
    client.call_async(NavigateTo.Request(x=0.4))
    simple.run(4)
    picture = simple.plot_sequence("/navigate_to")
    assert picture.text == (
        "2 calls of /navigate_to. "
        "At 0.900 s /asker asked /navigate_to (x 0.2, y 0, theta 0); /navigator received it 0.12 ms later; "
        "answered after 1.00 s (success True, time_taken 1.00001); "
        "had to wait meanwhile: on_goal (/navigate_to) 1 time, at most 1.00 s. "
        "At 0.900 s /asker asked /navigate_to (x 0.4, y 0, theta 0); /navigator received it 0.12 ms later; "
        "on_goal began after a wait of 1.00 s; answered after 2.00 s (success True, time_taken 1.00001)."
    )
    arrows = [line.split(":")[0] for line in picture.mermaid.splitlines() if ">>" in line]
    assert arrows == ["p0->>p1", "p0->>p1", "p1-->>p0", "p1-->>p0"]
    assert picture.mermaid.count("\nactivate p1") == picture.mermaid.count("\ndeactivate p1") == 2
    assert set(picture._repr_mimebundle_()) == {"text/html", "text/vnd.mermaid", "text/plain"}
    drawing = ElementTree.fromstring(picture.svg)
    words = [each.text for each in drawing.iter("{http://www.w3.org/2000/svg}text")]
    assert words[-2:] == ["/asker", "/navigator"]
    assert sum("answer after" in word for word in words) == 2
    assert "after a wait of 1.00 s" in " ".join(words)


def test_a_call_that_is_not_answered_yet(simple: Lesson) -> None:
    import rclpy
    from robot_controller.srv import NavigateTo

    rclpy.init()
    client = rclpy.create_node("asker").create_client(NavigateTo, "/navigate_to")
    for _ in range(2):
        client.call_async(NavigateTo.Request(x=5.0, y=5.0))
    simple.run(4)
    first, second = simple.plot_sequence().text.split(". At")[1:]
    assert "has not answered yet; had to wait meanwhile: on_goal (/navigate_to) 1 time, at most 4.00 s" in first
    assert "no callback has begun yet" in second
    assert "1 continues; 1 waits now, the first since 0.90 s" in simple.plot_timeline("/navigator").text
    assert "waits: no callback has begun yet" in simple.plot_sequence().mermaid
    assert "waits: no callback has begun" in simple.plot_sequence().svg


def test_a_command_is_named_by_its_words(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    from turtle_lesson.ros.cli.shell import run_line

    run_line(lesson._world, 'ros2 service call /spawn turtlesim/srv/Spawn "{x: 2.0, y: 2.0, name: end}"')
    picture = lesson.plot_sequence()
    assert 'ros2 service call asked /spawn (x 2, y 2, theta 0, name "end"); /turtlesim received it' in picture.text
    assert "#101;nd" in picture.mermaid.split("accDescr", 1)[1].split("\n", 1)[1]


def test_nothing_was_called_yet_or_not_in_these_seconds(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    from turtle_lesson.ros.cli.shell import run_line

    assert lesson.plot_sequence().text == "No node has called a service yet. Try: ros2 service call /navigate_to …"
    run_line(lesson._world, "ros2 service call /clear std_srvs/srv/Empty")
    assert 'Did you mean "/clear"?' in lesson.plot_sequence("/claer").text
    assert "the calls were between 0.100 s" not in lesson.plot_sequence("/clear").text
    lesson.run(1)
    assert "No node called /clear from 1.00 s" in lesson.plot_sequence("/clear", since=1).text
    with pytest.raises(TypeError, match="a service is named as in"):
        lesson.plot_sequence(1)  # type: ignore[arg-type]


def test_parameters_are_left_out_unless_asked_for(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    from turtle_lesson.ros.cli.shell import run_line

    run_line(lesson._world, "ros2 param set /turtlesim background_r 3")
    assert "No node has called a service yet" in lesson.plot_sequence().text
    assert "ros2 param set asked /turtlesim/set_parameters" in lesson.plot_sequence("/turtlesim/set_parameters").text
    assert "/turtlesim.set_parameters (/turtlesim/set_parameters): 1 call" in lesson.plot_timeline("/turtlesim").text


# -- the trace itself --------------------------------------------------------------------------------------------------


def test_a_world_without_a_trace_notes_nothing() -> None:
    from turtle_lesson.ros.runtime.world import open_world

    world = open_world()
    world.spawn(sleepy, name="sleepy")
    world.sim.run_until(2_000_000_000)
    assert world.trace is None
    world.close()


def test_the_trace_forgets_what_is_old(lesson: Lesson, monkeypatch: pytest.MonkeyPatch) -> None:
    trace = lesson._trace
    lesson.run(600)
    ticks = next(each for each in trace.callbacks if each.name == "_on_tick")
    assert len(ticks.ended) == 30_000
    assert all(len(stamps) <= 50_000 for stamps in trace.published.values())


def test_hidden_nodes_and_plumbing_are_left_out(lesson: Lesson) -> None:
    lesson.run(1)
    assert {each.node for each in lesson._trace.callbacks} == {"/turtlesim"}
    topics = {topic for topic, _ in lesson._trace.published if "/_action/" not in topic}  # those can be asked for
    assert topics == {"/turtle1/pose", "/turtle1/color_sensor"}


def test_a_callback_that_raises_ends_in_the_trace_too(lesson: Lesson, capsys: pytest.CaptureFixture[str]) -> None:
    import rclpy

    def broken() -> None:
        rclpy.init()
        node = rclpy.create_node("broken")

        def on_timer() -> None:
            time.sleep(0.2)
            raise KeyError("x")

        node.create_timer(0.1, on_timer)
        rclpy.spin(node)

    lesson._world.spawn(broken, name="broken")
    lesson.run(1)
    assert "on_timer (every 0.1 s): 1 call; it lasted 0.20 s." in lesson.plot_timeline("/broken").text


def test_a_node_of_very_many_topics_has_the_first_ones_noted(lesson: Lesson) -> None:
    from std_msgs.msg import Int32

    def program() -> None:
        rclpy.init()
        node = rclpy.create_node("many")
        for _ in range(2):  # the second publisher of a topic is no further topic
            publishers = [node.create_publisher(Int32, f"t{number}", 10) for number in range(40)]
        for publisher in publishers:
            publisher.publish(Int32())

    lesson._world.spawn(program, name="many")
    lesson.run(0.1)
    assert "/t31: 1 message" in lesson.plot_timeline("/t31").text
    with pytest.raises(ValueError, match="/t32 is not recorded: only the first 32 topics of each node are"):
        lesson.plot_timeline("/t32")
