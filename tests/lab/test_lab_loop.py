"""What views ask for happens in the notebook's thread, wherever the message arrives."""

from __future__ import annotations

import asyncio
import threading

from turtle_lesson.lab.widgets.backend import Loop


def test_an_order_that_arrives_in_another_thread_is_carried_out_in_the_notebooks() -> None:
    async def cell() -> list[int]:
        loop, done = Loop(), []
        threading.Thread(target=loop.soon, args=(lambda: done.append(threading.get_ident()),)).start()
        while not done:
            await asyncio.sleep(0.001)
        return done

    assert asyncio.run(cell()) == [threading.get_ident()]
