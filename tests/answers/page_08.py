"""Answers to the exercises of page 08: what sleeps, what awaits, and in which callback group."""

from __future__ import annotations

from answers import Answer, Answers, changed, code_cells, solution, stub

PAGE = "08_executors"
AWAKE, LAZY = solution(PAGE, "awake"), stub(PAGE, "awake")
STEADY, ALONE = solution(PAGE, "steady"), stub(PAGE, "steady")
HOME = solution(PAGE, "go_home")
[BAKERS] = [cell["source"] for cell in code_cells(PAGE) if "class Baker(Node)" in cell["source"]]

OWN_GROUP = ", callback_group=MutuallyExclusiveCallbackGroup()"
REENTRANT = "from rclpy.callback_groups import ReentrantCallbackGroup\n"
MANY = ("SingleThreadedExecutor()", "MultiThreadedExecutor()")
ASK = "await self.driver.call_async(NavigateTo.Request(x=5.5, y=5.5))"
IN_A_GROUP = (OWN_GROUP, ", callback_group=ReentrantCallbackGroup()")
BAKER = "executor = MultiThreadedExecutor()\n_ = executor.add_node(Baker({}))"
FRESH = "lesson = start(seed=0, simulator=False)\nrclpy.init()\n"

ANSWERS = {
    "awake": Answers(
        wrong={
            "awaits in the default group": (changed(AWAKE, (OWN_GROUP, "")), "no answer in 20 s"),
            "sleeps in a group of its own": (
                changed(AWAKE, ("await self.pause(1.0)", "time.sleep(1.0)")),
                "the longest pause was 1.00 s",
            ),
            "many threads and one group": (changed(LAZY, MANY), "the longest pause was 1.00 s"),
            "does not work": (changed(AWAKE, ("await self.pause(1.0)", "pass")), "after 0.00 s"),
            "half a second": (changed(AWAKE, ("pause(1.0)", "pause(0.5)")), "after 0.50 s"),
            "ten seconds": (changed(AWAKE, ("pause(1.0)", "pause(10.0)")), "after 10.0"),
            "no return": (changed(AWAKE, ("        return response\n", "")), "the callback of /work returned None"),
            "no await": (changed(AWAKE, ("await self.pause", "self.pause")), "after 0.00 s"),
            "another service": (changed(AWAKE, ('"/work"', '"/job"')), "no node does"),
            "another node": (changed(AWAKE, ('"worker"', '"heart"')), "there is /heart"),
            "asyncio.sleep": (
                "import asyncio\n" + changed(AWAKE, ("self.pause(1.0)", "asyncio.sleep(1.0)")),
                "asyncio",
            ),
            "works in the background, and answers at once": (
                changed(LAZY, ("time.sleep(1.0)", "self.create_timer(1.0, lambda: None)")),
                "after 0.00 s",
            ),
        },
        right={
            "threads and a group": changed(LAZY, MANY, ("self.on_work)", "self.on_work" + OWN_GROUP + ")")),
            "a reentrant group": REENTRANT + changed(AWAKE, IN_A_GROUP),
            "many short pauses": changed(
                AWAKE, ("await self.pause(1.0)", "for _ in range(10):\n            await self.pause(0.1)")
            ),
            "a future of its own": changed(
                AWAKE,
                (
                    "await self.pause(1.0)",
                    "over = Future()\n        timer = self.create_timer(1.0, lambda: over.set_result(None))\n"
                    "        await over\n        timer.cancel()",
                ),
            ),
            "awaits, with many threads": changed(AWAKE, MANY),
        },
    ),
    "steady": Answers(
        wrong={
            "many threads, one group": (changed(ALONE, MANY), "to 400.0 ms"),
            "a group, one thread": (
                changed(STEADY, ("MultiThreadedExecutor()", "SingleThreadedExecutor()")),
                "to 400.0 ms",
            ),
            "one thread of many": (
                changed(STEADY, ("MultiThreadedExecutor()", "MultiThreadedExecutor(1)")),
                "to 400.0 ms",
            ),
            "not in the executor": (FRESH + "executor = MultiThreadedExecutor()\nbaker = Baker()", "400.0 ms"),
            "does not bake": (
                FRESH + "Baker.on_bake = lambda self: None\n" + BAKER.format("MutuallyExclusiveCallbackGroup()"),
                "it was switched on 0 times",
            ),
            "bakes for a moment": (
                Answer(STEADY, cells={"class Baker(Node)": changed(BAKERS, ("sleep(0.4)", "sleep(0.04)"))}),
                "on for 0.04 s",
            ),
            "two bakers": (STEADY + "\n_ = executor.add_node(Baker(MutuallyExclusiveCallbackGroup()))", "2 nodes"),
        },
        right={
            "a reentrant group": REENTRANT + FRESH + BAKER.format("ReentrantCallbackGroup()"),
            "by name": FRESH + BAKER.format("oven_group=MutuallyExclusiveCallbackGroup()"),
            "two threads": changed(STEADY, ("MultiThreadedExecutor()", "MultiThreadedExecutor(num_threads=2)")),
            "the group first": FRESH + "group = MutuallyExclusiveCallbackGroup()\n" + BAKER.format("group"),
        },
    ),
    "go_home": Answers(
        wrong={
            "a client in the default group": (changed(HOME, (OWN_GROUP, "")), "no answer in 20 s"),
            "says yes at once": (
                changed(HOME, (f"answer = {ASK}", ""), ("answer.success", "True")),
                "it is at (2.0",
            ),
            "always says yes": (changed(HOME, ("answer.success", "True")), "success is True"),
            "does not wait": (
                changed(HOME, (f"answer = {ASK}", ASK.removeprefix("await ")), ("answer.success", "True")),
                "it is at (2.0",
            ),
            "forgets success": (changed(HOME, ("response.success = answer.success", "pass")), "success is False"),
            "another place": (changed(HOME, ("x=5.5, y=5.5", "x=5.0, y=5.0")), "it is at (4.9"),
            "y forgotten": (changed(HOME, ("x=5.5, y=5.5", "x=5.5")), "it is at ("),
            "returns nothing": (
                changed(HOME, ("        return response\n", "")),
                "the callback of /go_home returned None",
            ),
            "asks a service that does not exist": (
                changed(HOME, ('"/navigate_to"', '"/navigate"')),
                "no answer in 20 s",
            ),
            "no await": (changed(HOME, ("await ", "")), "success"),
            "another service": (changed(HOME, ('"/go_home"', '"/home"')), "no node does"),
        },
        right={
            "a reentrant group": REENTRANT + changed(HOME, IN_A_GROUP),
            "many threads and call": changed(
                HOME, (ASK, ASK.replace("await ", "").replace("call_async", "call")), MANY
            ),
            "with a heading": changed(HOME, ("y=5.5)", "y=5.5, theta=1.0)")),
            "the service in the group": changed(
                HOME, (OWN_GROUP, ""), ("self.on_go_home)", "self.on_go_home" + OWN_GROUP + ")")
            ),
            "with a message": changed(
                HOME,
                ("response.success = answer.success", "response.success, response.message = answer.success, 'home'"),
            ),
        },
    ),
}
