"""What a robot would start and the simulation cannot: a launch names it once, and starts the rest."""

from __future__ import annotations

from pathlib import Path

import pytest
from launch_world import FakeWorld, launch, node, write, write_launch_file

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.launching.errors import LaunchError
from turtle_lesson.ros.launching.service import launch_file, show_arguments

OTHERS = "Node(package='robot_controller', executable='obstacle_detector'),"


def warnings(capsys: pytest.CaptureFixture[str]) -> list[str]:
    begin = "[WARNING] [launch]: "
    return [line.removeprefix(begin) for line in capsys.readouterr().out.splitlines() if line.startswith(begin)]


@pytest.mark.parametrize(
    ("action", "said"),
    [
        (
            "Node(package='rviz2', executable='rviz2', arguments=['-d', 'x.rviz']),",
            "rviz2 is left out: there are no windows",
        ),
        ("Node(package='rqt_graph', executable='rqt_graph'),", "rqt_graph is left out: there are no windows here"),
        ("ExecuteProcess(cmd=['rviz2']),", "rviz2 is left out: there are no windows here"),
        ("ExecuteProcess(cmd=['/usr/bin/gzserver', 'x.world']),", "gzserver is left out: there is no Gazebo here"),
        (
            "Node(package='gazebo_ros', executable='spawn_entity.py'),",
            "spawn_entity.py of gazebo_ros is left out: there is",
        ),
        ("Node(package='slam_toolbox', executable='x'),", "x of slam_toolbox is left out: it is not part of this simu"),
        ("ExecuteProcess(cmd=['ls', '-l']),", "ls is left out: it is a program of the operating system"),
        (
            "ExecuteProcess(cmd=['bash', '-c', 'echo a | grep b']),",
            "the command 'echo a | grep b' is left out: it uses '|'",
        ),
        ("ExecuteProcess(cmd=['ros2', 'launch', 'a', 'b']),", "ros2 launch a b is left out: a launch file is included"),
        (
            "LifecycleNode(package='nav2_amcl', executable='amcl', name='amcl', namespace='', autostart=True),",
            "amcl of nav2_amcl is left out",
        ),
        (
            "ComposableNodeContainer(name='c', namespace='', package='rclcpp_components', executable='component_container',"
            " composable_node_descriptions=[ComposableNode(package='composition', plugin='composition::Talker')]),",
            "ComposableNodeContainer is left out: composable nodes are C++ libraries, and only Python nodes run here",
        ),
        (
            "LoadComposableNodes(target_container='c', composable_node_descriptions=[]),",
            "LoadComposableNodes is left out",
        ),
    ],
)
def test_it_is_named_once_and_the_rest_starts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], action: str, said: str
) -> None:
    world, handle = launch(tmp_path, f"{node()}{action}\n{OTHERS}\n{action}")
    assert [process.name for process in world.processes] == ["navigator", "obstacle_detector"]
    assert handle.running
    (warning,) = warnings(capsys)
    assert warning.startswith(said)


def test_its_parameters_are_not_looked_at(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    description = "{'robot_description': Command(['no_such_command ', FindPackageShare('robot_controller')])}"
    launch(
        tmp_path,
        f"Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=[{description}]),",
    )
    assert len(warnings(capsys)) == 1


@pytest.mark.parametrize("executable", ["fast", "faster", "component"])
def test_a_cpp_program_of_the_workspace(tmp_path: Path, capsys: pytest.CaptureFixture[str], executable: str) -> None:
    write(
        tmp_path,
        """\
        project(arm)
        find_package(ament_cmake REQUIRED)
        add_executable(fast src/fast.cpp)
        add_executable(faster src/faster.cpp)
        rclcpp_components_register_node(arm PLUGIN "arm::Arm" EXECUTABLE component)
        """,
        "CMakeLists.txt",
    )
    world = FakeWorld()
    world.packages.add(Package("arm", tmp_path / "share/arm", source=tmp_path, prefix=tmp_path))
    path = write_launch_file(tmp_path, f"{node()}Node(package='arm', executable='{executable}'),")
    launch_file(world, path)
    assert len(world.processes) == 1
    line = {"fast": 3, "faster": 4, "component": 5}[executable]
    why = f"it is a C++ program (CMakeLists.txt, line {line}), and only Python programs run here"
    assert warnings(capsys) == [f"{executable} of arm is left out: {why}"]
    with pytest.raises(LaunchError) as caught:
        launch_file(world, write_launch_file(tmp_path, "Node(package='arm', executable='fats'),"))
    begin = "Did you mean 'fast'? arm has C++ programs alone, which are not built here: "
    assert caught.value.hint == f"{begin}fast, faster, component."


@pytest.mark.parametrize(
    "source",
    [
        "os.path.join(get_package_share_directory('gazebo_ros'), 'launch', 'gazebo.launch.py')",
        "PathJoinSubstitution([FindPackageShare('gazebo_ros'), 'launch', 'gazebo.launch.py'])",
        "PythonLaunchDescriptionSource([get_package_share_directory('gazebo_ros'), '/launch/gazebo.launch.py'])",
    ],
)
def test_an_included_launch_file_of_a_package_that_only_robots_have(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], source: str
) -> None:
    path = write_launch_file(
        tmp_path,
        f"IncludeLaunchDescription({source}, launch_arguments={{'world': 'x'}}.items()),\n{node()}",
    )
    path.write_text("import os\nfrom ament_index_python import get_package_share_directory\n" + path.read_text())
    world = FakeWorld()
    launch_file(world, path)
    assert [process.name for process in world.processes] == ["navigator"]
    why = "there is no Gazebo here; the simulated world is turtlesim"
    assert warnings(capsys) == [f"gazebo.launch.py of gazebo_ros is left out: {why}"]
    assert show_arguments(world, path).endswith("No arguments.")


def test_in_xml_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = """\
        <launch>
          <include file="$(find-pkg-share nav2_bringup)/launch/bringup_launch.py"><arg name="a" value="b"/></include>
          <node pkg="rviz2" exec="rviz2" args="-d $(find-pkg-share nav2_bringup)/x.rviz"/>
          <node_container pkg="rclcpp_components" exec="component_container" name="c" namespace="">
            <composable_node pkg="composition" plugin="composition::Talker" name="t"><param name="p" value="1"/>
            </composable_node>
          </node_container>
          <load_composable_node target="c"><composable_node pkg="a" plugin="b"/></load_composable_node>
          <node pkg="robot_controller" exec="navigator"/>
        </launch>
        """
    world = FakeWorld()
    launch_file(world, write(tmp_path, text, "test.launch.xml"))
    assert [process.name for process in world.processes] == ["navigator"]
    assert [line.partition(" is left out")[0] for line in warnings(capsys)] == [
        "bringup_launch.py of nav2_bringup", "rviz2", "ComposableNodeContainer", "LoadComposableNodes",
    ]  # fmt: skip


def test_a_file_of_such_a_package_that_the_launch_file_itself_reads(tmp_path: Path) -> None:
    read = "open(get_package_share_directory('nav2_bringup') + '/params/nav2_params.yaml')"
    path = write(
        tmp_path,
        f"""
        from ament_index_python import get_package_share_directory
        from launch import LaunchDescription

        def generate_launch_description():
            return LaunchDescription([{read}])
        """,
    )
    with pytest.raises(LaunchError) as caught:
        launch_file(FakeWorld(), path)
    assert caught.value.hint == "nav2_bringup is not available here: it is not part of this simulation."


def test_a_launch_file_that_imports_such_a_package(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    inner = write(tmp_path, "from nav2_common.launch import RewrittenYaml\n", "inner.launch.py")
    with pytest.raises(LaunchError) as caught:
        launch_file(FakeWorld(), inner)
    assert caught.value.hint == "nav2_common is not available here: it is not part of this simulation."
    capsys.readouterr()
    world, _ = launch(tmp_path, f"IncludeLaunchDescription({str(inner)!r}),\n{node()}")
    assert len(world.processes) == 1
    why = "it imports nav2_common, and it is not part of this simulation"
    assert warnings(capsys) == [f"inner.launch.py is left out: {why}"]


def test_outside_of_a_launch_such_a_package_is_not_found() -> None:
    with pytest.raises(KeyError, match="rviz2 is not available here: there are no windows"):
        FakeWorld().packages.get("rviz2")


@pytest.mark.parametrize(
    ("prefix", "program"),
    [
        ("'xterm -e'", "xterm"),
        ("[LaunchConfiguration('t', default='/usr/bin/konsole'), ' -e']", "konsole"),
        ("'gdb -ex run --args'", "gdb"),
        ("['/usr/bin/', 'nice -n 5']", "nice"),
        ("''", ""),
    ],
)
def test_what_a_prefix_puts_before_nodes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], prefix: str, program: str
) -> None:
    world, _ = launch(tmp_path, node(prefix=prefix) + node("status_monitor", prefix=prefix))
    assert len(world.processes) == 2
    said = [f"{program} is left out: programs run here without a prefix"] if program else []
    assert warnings(capsys) == said


def test_what_waits_for_it_is_named_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(
        tmp_path,
        """
        from launch import LaunchDescription
        from launch.actions import RegisterEventHandler, Shutdown
        from launch.event_handlers import OnProcessExit
        from launch_ros.actions import Node

        def generate_launch_description():
            spawn = Node(package='gazebo_ros', executable='spawn_entity.py')
            rviz = Node(package='rviz2', executable='rviz2')
            node = Node(package='robot_controller', executable='navigator')
            return LaunchDescription([
                RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[node])),
                RegisterEventHandler(OnProcessExit(target_action=rviz, on_exit=[Shutdown()])),
                spawn, rviz,
            ])
        """,
    )
    world = FakeWorld()
    launch_file(world, path)
    assert world.processes == []
    said = "OnProcessExit of spawn_entity.py of gazebo_ros is left out, too, with what it starts"
    assert warnings(capsys)[2:] == [said]
