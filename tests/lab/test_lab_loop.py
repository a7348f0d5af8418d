"""What widgets do happens in the notebook's thread, be it asked for there, in a robot process or elsewhere."""

from __future__ import annotations

import asyncio
import threading

from turtle_lesson.lab.widgets.backend import Loop
from turtle_lesson.ros.runtime.world import World


def test_a_callback_in_a_robot_process_is_in_the_notebooks_thread(world: World) -> None:
    async def cell() -> list[str]:
        loop, done = Loop(), []
        world.spawn(lambda: loop.now_or_soon(done.append, "from a process"), name="node")
        world.sim.run_until(world.now + 1)
        assert done == ["from a process"]
        threading.Thread(target=loop.now_or_soon, args=(done.append, "from a thread")).start()
        while len(done) < 2:
            await asyncio.sleep(0.001)
        return done

    assert asyncio.run(cell()) == ["from a process", "from a thread"]
