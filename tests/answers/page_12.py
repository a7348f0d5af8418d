"""Answers to the exercises of page 12: a run that can fail, an interval, and a navigator on a slow network."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "12_a_thousand_runs"
PUNCTUAL = solution(PAGE, "punctual")
INTERVAL = solution(PAGE, "interval")
ROBUST = solution(PAGE, "robust")

ARRIVED = '    assert it.answer.success, "it gave up"\n'
IN_TIME = '    assert it.seconds <= 2.0, "it came late"\n'


def steer(turning: str, braking: str) -> str:
    """The navigator with other gains for turning and for braking."""
    return changed(ROBUST, ("0.7 * gain", turning), ("gain / 2", braking))


def body(lines: str) -> str:
    """`interval` with this body."""
    return "import math\n\ndef interval(good, runs):\n" + "\n".join(
        f"    {line}" for line in lines.strip().splitlines()
    )


ANSWERS = {
    "punctual": Answers(
        wrong={
            "cannot fail": (changed(PUNCTUAL, (ARRIVED, ""), (IN_TIME, "")), "seed 3, 2."),
            "late is fine": (changed(PUNCTUAL, (IN_TIME, "")), "seed 3, 2."),
            "giving up is fine": (changed(PUNCTUAL, (ARRIVED, "")), "seed 2, 0.6 s: it returned"),
            "2.5 s": (changed(PUNCTUAL, ("<= 2.0", "<= 2.5")), "seed 3, 2."),
            "1.5 s": (changed(PUNCTUAL, ("<= 2.0", "<= 1.5")), "seed 12, 1.7 s: it raised AssertionError"),
            "the other way round": (changed(PUNCTUAL, ("<= 2.0", ">= 2.0")), "seed 12, 1.7 s: it raised"),
            "returns nothing": (
                changed(PUNCTUAL, ('return {"seconds": round(it.seconds, 2)}', "pass")),
                "it returned None",
            ),
            "pass": ("def punctual(lesson, latency=0.0, **settings):\n    pass", "the turtle did not move"),
            "prints instead of raising": (
                changed(PUNCTUAL, (IN_TIME, '    if it.seconds > 2.0:\n        print("late")\n')),
                "seed 3, 2.",
            ),
            "says so in the row alone": (
                changed(PUNCTUAL, (IN_TIME, ""), ("2)}", '2), "late": it.seconds > 2}')),
                "seed 3, 2.",
            ),
            "forgets the latency": (changed(PUNCTUAL, ("go(lesson, latency, ", "go(lesson, ")), "made it 0 s"),
            "without settings": (changed(PUNCTUAL, (", **settings", "")), "unexpected keyword argument"),
            "always raises": (changed(PUNCTUAL, ("it.answer.success", "not it")), "seed 12, 1.7 s: it raised"),
        },
        right={
            "an if and a raise": changed(
                PUNCTUAL,
                (ARRIVED, '    if not it.answer.success:\n        raise RuntimeError("it gave up")\n'),
            ),
            "one assert": changed(PUNCTUAL, (ARRIVED, ""), ("it.seconds <=", "it.answer.success and it.seconds <=")),
            "by trip": (
                "def punctual(lesson, **settings):\n"
                "    row = trip(lesson, **settings)\n"
                '    assert row["seconds"] <= 2.0\n'
                "    return row"
            ),
            "more columns": changed(PUNCTUAL, ("2)}", '2), "off": float(it.off)}')),
        },
    ),
    "interval": Answers(
        wrong={
            "the textbook's simple one": (
                body("p = good / runs\nhalf = 1.96 * math.sqrt(p * (1 - p) / runs)\nreturn p - half, p + half"),
                "interval(36, 40) is 0.807 to 0.993, not 0.769 to 0.960",
            ),
            "always everything": (body("return 0.0, 1.0"), "is 0.000 to 1.000"),
            "the example": (body("return 0.769, 0.960"), "interval(7, 12) is 0.769 to 0.960"),
            "one number": (body("return good / runs"), "should return two numbers"),
            "pass": (body("pass"), "it returned None"),
            "high and low": (
                INTERVAL.replace("(middle - half)", "(middle + half)", 1).replace(
                    "            (middle + half)", "            (middle - half)"
                ),
                "interval(36, 40) is 0.960 to 0.769",
            ),
            "90 %": (changed(INTERVAL, ("1.96", "1.645")), "not 0.769 to 0.960"),
            "without the factor in front": (changed(INTERVAL, (" / (1 + z**2 / runs)", "")), "not 0.769 to 0.960"),
            "runs instead of their square": (changed(INTERVAL, ("4 * runs**2", "4 * runs")), "not 0.769 to 0.960"),
            "half not multiplied by z": (changed(INTERVAL, ("z * math.sqrt", "math.sqrt")), "not 0.769 to 0.960"),
            "in percent": (changed(INTERVAL, ("((middle - half)", "(100 * (middle - half)")), "is 76.9"),
        },
        right={
            "a list": body(
                "p, z = good / runs, 1.96\n"
                "m = (p + z**2 / (2 * runs)) / (1 + z**2 / runs)\n"
                "h = z / (1 + z**2 / runs) * math.sqrt(p * (1 - p) / runs + (z / (2 * runs))**2)\n"
                "return [m - h, m + h]"
            ),
            "the roots of an equation": body(
                "import numpy as np\n"
                "p, z = good / runs, 1.96\n"
                "return sorted(np.roots([1 + z**2 / runs, -(2 * p + z**2 / runs), p**2]).real)"
            ),
            "with counts": body(
                "z2, bad = 1.96**2, runs - good\n"
                "half = 1.96 * math.sqrt(good * bad / runs + z2 / 4)\n"
                "return (good + z2 / 2 - half) / (runs + z2), (good + z2 / 2 + half) / (runs + z2)"
            ),
            "a more exact z": "from statistics import NormalDist\n"
            + changed(INTERVAL, ("1.96", "NormalDist().inv_cdf(0.975)")),
            "by the table": (
                "from turtle_lesson.experiments.results import wilson\n\n"
                "def interval(good, runs):\n    return wilson(good, runs)"
            ),
        },
    ),
    "robust": Answers(
        wrong={
            "as it was": (steer("gain", "gain / 2"), "were reached, then"),
            "as page 03 left it": (steer("gain", "gain"), "were reached, then"),
            "brakes later": (steer("0.7 * gain", "2 * gain"), "were reached, then"),
            "turns the other way": (steer("-0.7 * gain", "gain / 2"), "0 were reached, then"),
            "turns too much": (steer("2 * gain", "gain / 2"), "0 were reached, then"),
            "too careful": (steer("gain / 4", "gain / 4"), "were reached, then"),
            "stands still": (steer("0.0", "0.0"), "0 were reached, then"),
            "another argument": (changed(ROBUST, ("goal, gain)", "goal)")), "TypeError"),
        },
        right={
            "two gains of its own": steer("2.8", "2.0"),
            "a limit": steer("min(gain, 2.6)", "min(gain / 2, 2.0)"),
            "by the pose as it is now": changed(
                ROBUST,
                (
                    "    if distance(pose, goal)",
                    "    pose = Pose(x=pose.x + 0.1 * pose.linear_velocity * math.cos(pose.theta),\n"
                    "                y=pose.y + 0.1 * pose.linear_velocity * math.sin(pose.theta),\n"
                    "                theta=pose.theta)\n"
                    "    if distance(pose, goal)",
                ),
            ),
            "a slower turn": changed(
                ROBUST, ("return speed, 0.7 * gain * turn", "return speed, max(-4.0, min(4.0, 0.7 * gain * turn))")
            ),
        },
    ),
}
