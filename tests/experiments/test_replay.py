"""A run of an experiment, opened here: the same run, step by step, whatever looks on."""

from __future__ import annotations

import gc
import os
import random
import weakref
from collections.abc import Iterator
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from turtle_lesson import start
from turtle_lesson.experiments import ExperimentError, Results, experiment, replay
from turtle_lesson.experiments.replay import Surroundings, _Tee
from turtle_lesson.ros.runtime import files
from turtle_lesson.ros.sim.errors import WorldClosed

LIMIT = 4.0
FACTOR = 1.0


def drive(lesson: Any, gain: float, loss: float = 0.0) -> dict[str, Any]:
    """Waits in all ways, draws by chance, prints, writes a file, and fails at times."""
    import rclpy
    from turtlesim.srv import TeleportAbsolute

    lesson.network("/turtle1/pose", loss=loss)
    lesson.launch("robot_controller", "start_system.launch.py")
    rclpy.init()
    node = rclpy.create_node("client")
    client = node.create_client(TeleportAbsolute, "/turtle1/teleport_absolute")
    x = float(random.uniform(2, 9) + np.random.normal(0, 0.1))
    rclpy.spin_until_future_complete(node, client.call_async(TeleportAbsolute.Request(x=x, y=gain)))
    lesson.run(1.5)
    client.call(TeleportAbsolute.Request(x=x, y=FACTOR * gain + 0.5))
    Path("notes.txt").write_text("here")
    print("stands at", round(x, 3), "in", sorted(os.listdir()))
    assert x < LIMIT, f"{x:.3f} is too far"
    return {"x": x, "seconds": lesson.now}


def stuck(lesson: Any) -> None:
    while True:
        lesson.run(0.7)


@pytest.fixture(scope="module")
def results() -> Results:
    """Some runs end well, others do not."""
    return experiment(drive, seeds=range(3), gain=[3.0], start_order="shuffled", loss=0.2, jobs=1)


@pytest.fixture(autouse=True)
def closed_afterwards() -> Iterator[None]:
    yield
    start(simulator=False)


def test_each_row_comes_out_again_in_steps(results: Results, capsys: pytest.CaptureFixture[str]) -> None:
    assert {row["outcome"] for row in results} == {"ok", "raised"}, "or this test shows nothing"
    drawn = random.Random(1)
    for row in results:
        again = results.replay(row["run"])
        assert again.now == 0 and repr(again).endswith(" at 0.000 s of robot time>")
        if row["run"] == 0:
            again.lesson.dashboard()
        while not again.done:
            again.step(drawn.choice([0.016, 0.3, 1e-9, 0.11]))
        assert again.row == row
        assert f"Run {row['run']} ended at {row['robot_time']:.3f} s of robot time, as in the table" in (
            capsys.readouterr().out
        )


def test_it_stands_where_it_is_asked_to(results: Results) -> None:
    again = results.replay()
    assert again._run.number == results.failed.rows[0]["run"], "the first one that failed, unless told"
    again.run(until=1.25)
    assert again.now == 1.25 and not again.done
    again.lesson.run(0.25)
    assert again.now == 1.5
    assert "/turtle1/pose" in again.lesson.plot_timeline("/turtle1/pose").text
    with pytest.raises(ValueError, match="a run never goes back"):
        again.run(until=1.0)
    with pytest.raises(ValueError, match="seconds must be"):
        again.step(-1)
    with pytest.raises(ExperimentError, match="is not over yet"):
        again.row  # noqa: B018
    again.run()
    assert again.row["error"].endswith("is too far")


def test_the_notebook_keeps_its_own_folder_chance_and_streams(
    results: Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    home = files.home()
    random.seed(5)
    np.random.seed(5)
    expected = (random.Random(5).random(), np.random.RandomState(5).rand())
    again = results.replay(0)
    again.step(2.0)
    assert (random.random(), np.random.rand()) == expected
    again.run()
    assert Path.cwd() == tmp_path and files.home() == home and not list(tmp_path.iterdir())
    place = Path(again._folder.name)
    assert (place / "notes.txt").exists()
    start(simulator=False)
    assert not place.exists()


def test_its_stream_may_outlive_the_notebooks(tmp_path: Path) -> None:
    with (tmp_path / "shown").open("w") as shown, redirect_stdout(shown):
        surroundings = Surroundings(tmp_path)
        stream = _Tee(lambda: surroundings._shown[0], surroundings.tail)
        stream.write("a word")
    assert (tmp_path / "shown").read_text() == "a word"
    stream.close()  # as the garbage collector does it


def test_a_later_start_ends_it(results: Results) -> None:
    again = results.replay(0)
    again.step(1.3)
    call, world = weakref.ref(again._call._greenlet), weakref.ref(again.lesson._world)
    assert again._call.computes is False
    start(simulator=False)
    with pytest.raises(WorldClosed, match="open it anew"):
        again.step()
    del again
    start(simulator=False)
    gc.collect()
    assert call() is None and world() is None


def test_a_changed_function_is_named(
    results: Results, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    failed = results.failed.rows[0]["run"]
    monkeypatch.setattr(f"{__name__}.LIMIT", 20.0)
    again = results.replay(failed)
    said = "drive, or something that it uses, has changed since this experiment; "
    assert f"{said}it is replayed as it was then.\n" in capsys.readouterr().out
    again.run()
    assert again.row == results.rows[failed]
    again = results.replay(failed, drive)
    assert f"{said}it is replayed as it is now, and may end otherwise.\n" in capsys.readouterr().out
    again.run()
    assert "That is not as in the table: outcome was 'raised' there, and is 'ok' here." in capsys.readouterr().out
    assert again.row["outcome"] == "ok"


def test_a_run_that_is_not_in_the_table_is_said(results: Results) -> None:
    with pytest.raises(ExperimentError, match="there is no run 7 in this table: it has 0, 1, 2"):
        results.replay(7)
    with pytest.raises(ExperimentError, match="no run of this table has failed"):
        results.ok.replay()


def test_a_run_that_is_in_no_table_and_comes_to_its_limit(capsys: pytest.CaptureFixture[str]) -> None:
    again = replay(stuck, simulator=False, robot_time=3.0)
    again.step(2.0)
    assert not again.done
    again.step(2.0)
    assert again.row["outcome"] == "robot time" and again.now == 3.0
    assert "Run 0 ended at 3.000 s of robot time: the run was not over when" in capsys.readouterr().out
    again.step()
    assert "Run 0 was over before this" in capsys.readouterr().out
    again.lesson.run(5)
    assert again.now == 8.0, "its world goes on for whoever looks at it"
    with pytest.raises(ExperimentError, match="missing a required argument: 'gain'"):
        replay(drive)


def spins(lesson: Any) -> dict[str, Any]:
    import rclpy

    rclpy.init()
    node = rclpy.create_node("waiter")
    for _ in range(10):
        rclpy.spin_once(node, timeout_sec=0.3)
    return {"seconds": lesson.now}


def test_a_step_may_end_within_a_call_that_could_wait_beyond_the_limit() -> None:
    again = replay(spins, simulator=False)
    again.step(1.0)
    again.run()
    assert again.row["outcome"] == "ok" and again.row["seconds"] == pytest.approx(3.0, abs=0.1)


def spins_on(lesson: Any, limit: int) -> dict[str, float]:
    """Ends by an error that a callback raises, as many programs do, or not at all."""
    import rclpy
    from turtlesim.msg import Pose

    rclpy.init()
    node, seen = rclpy.create_node("listener"), []

    def on_pose(pose: Pose) -> None:
        seen.append(pose)
        if len(seen) == limit:
            raise SystemExit

    node.create_subscription(Pose, "/turtle1/pose", on_pose, 10)
    try:
        rclpy.spin(node)
    except SystemExit:
        return {"seconds": lesson.now}
    return {}


def test_a_function_that_spins_goes_as_fast_as_possible_and_in_steps() -> None:
    again = replay(spins_on, limit=1000)
    while not again.done:
        again.step(1.7)
    assert again.row["outcome"] == "ok" and 15.9 < again.row["seconds"] < 16.1
    endless = replay(spins_on, limit=100_000, robot_time=20.0)
    endless.step(7)
    endless.run()
    assert endless.row["outcome"] == "robot time" and endless.now == 20.0


def test_an_interrupt_leaves_it_usable(results: Results) -> None:
    from turtle_lesson.ros.sim import interrupts

    again = results.replay(0)
    again.lesson._world.sim.call_later(700_000_000, interrupts._interrupt_main_thread)
    with pytest.raises(KeyboardInterrupt):
        again.run()
    assert 0.5 < again.now < 1 and not again.done
    again.run()
    assert again.row == results.rows[0]
