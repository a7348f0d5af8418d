"""Answers to the exercises of page 05: how many beams, what is ahead, and where a beam meets a circle."""

from __future__ import annotations

from answers import Answers, changed, solution

PAGE = "05_obstacle_detector"
SCAN = solution(PAGE, "scan")
AHEAD = solution(PAGE, "nearest_ahead")
RAY = solution(PAGE, "ray_cast")

COUNT = "return round((scan.angle_max - scan.angle_min) / scan.angle_increment) + 1"
STEPS = "(scan.angle_max - scan.angle_min) / scan.angle_increment"
WINDOW = "abs(angle) <= math.radians(30)"
BEAM = "angle = scan.angle_min + i * scan.angle_increment"
LAST = "return ahead - math.sqrt(radius ** 2 - beside ** 2)"
MISSED = "if ahead < 0 or abs(beside) > radius:"
INSIDE = """    if math.hypot(dx, dy) <= radius:
        return 0.0
"""


def counted(new: str) -> str:
    """The solution of `scan` with another way to count."""
    return changed(SCAN, (COUNT, new))


def nearest(body: str) -> str:
    """The solution of `nearest_ahead` with another function."""
    head, rest = AHEAD.split("    nearest = scan.range_max\n")
    return head + body + rest.partition("    return nearest\n")[2]


def ray(*changes: tuple[str, str]) -> str:
    """The solution of `ray_cast` with changes."""
    return changed(RAY, *changes)


ANSWERS = {
    "scan": Answers(
        wrong={
            "always 181": (counted("return 181"), "from -1 to 1 in steps of 0.5: 181, not 5"),
            "always 180": (counted("return 180"), "180 readings, and the angles ask for 181"),
            "steps alone": (counted(f"return round({STEPS})"), "180 readings, and the angles ask for 181"),
            "cut, not rounded": (counted(f"return int({STEPS}) + 1"), "from 0 to 0.3 in steps of 0.1: 3, not 4"),
            "rounded up": (counted(f"return math.ceil({STEPS} + 1)"), "not "),
            "one too many": (counted(f"return round({STEPS}) + 2"), "182 readings, and the angles ask for 181"),
            "not a whole number": (counted(f"return {STEPS} + 1"), "TypeError"),
            "forgets the return": (counted(f"round({STEPS}) + 1"), "TypeError"),
            "in degrees": (
                counted("return round(math.degrees(scan.angle_max) - math.degrees(scan.angle_min)) + 1"),
                "from -1 to 1 in steps of 0.5: 116, not 5",
            ),
            "the sum of the angles": (
                counted("return round((scan.angle_max + scan.angle_min) / scan.angle_increment) + 1"),
                "1 reading, and the angles ask for 181",
            ),
            "by the readings that are there": (counted("return len(scan.ranges)"), "0, not 5"),
            "two arguments": (changed(SCAN, ("def how_many(scan)", "def how_many(scan, step)")), "TypeError"),
            "changes the angles instead": (
                counted(f"scan.angle_max -= scan.angle_increment\n    return round({STEPS}) + 1"),
                "it looks from −90° to +90°",
            ),
        },
        right={
            "cut after a hair more": counted(f"return int({STEPS} + 0.01) + 1"),
            "cut after half more": counted(f"return int({STEPS} + 1.5)"),
            "floor": counted(f"return math.floor({STEPS} + 1e-3) + 1"),
            "step by step": counted(
                "beams = 0\n"
                "    while scan.angle_min + beams * scan.angle_increment <= scan.angle_max + 1e-5:\n"
                "        beams += 1\n"
                "    return beams"
            ),
            "names for the parts": counted(
                "width = scan.angle_max - scan.angle_min\n    steps = round(width / scan.angle_increment)\n    return 1 + steps"
            ),
            "written twice": (SCAN, SCAN),
        },
    ),
    "nearest_ahead": Answers(
        wrong={
            "20° to a side": (changed(AHEAD, (WINDOW, "abs(angle) <= math.radians(20)")), "1.5 m at -29°"),
            "45° to a side": (changed(AHEAD, (WINDOW, "abs(angle) <= math.radians(45)")), "1.0, not 1.5"),
            "left alone": (changed(AHEAD, (WINDOW, "0 <= angle <= math.radians(30)")), "2 m at -20°"),
            "right alone": (changed(AHEAD, (WINDOW, "math.radians(-30) <= angle <= 0")), "1.5 m at 29°"),
            "no abs": (changed(AHEAD, (WINDOW, "angle <= math.radians(30)")), "1.0, not 2"),
            "degrees": (changed(AHEAD, (WINDOW, "abs(angle) <= 30")), "1.0, not 2"),
            "all beams": (nearest("    return min(scan.ranges)\n"), "1.0, not 2"),
            "places of our own scanner": (nearest("    return min(scan.ranges[60:121])\n"), "beams from -180°"),
            "the middle third": (
                nearest("    n = len(scan.ranges)\n    return min(scan.ranges[n // 3:2 * n // 3 + 1])\n"),
                "beams from -60°",
            ),
            "straight ahead alone": (nearest("    return scan.ranges[len(scan.ranges) // 2]\n"), "10.0, not 2"),
            "the first one": (
                changed(AHEAD, ("nearest = min(nearest, distance)", "return distance")),
                "10.0, not 2",
            ),
            "the farthest": (changed(AHEAD, ("min(nearest", "max(nearest")), "10.0, not 2"),
            "angles from zero": (changed(AHEAD, (BEAM, "angle = i * scan.angle_increment")), "not 2"),
            "the angle instead": (changed(AHEAD, ("min(nearest, distance)", "min(nearest, angle)")), "not 2"),
            "forgets the return": (changed(AHEAD, ("    return nearest\n", "")), "TypeError"),
            "two arguments": (
                changed(AHEAD, ("def nearest_ahead(scan)", "def nearest_ahead(self, scan)")),
                "TypeError",
            ),
            "another name": (changed(AHEAD, ("def nearest_ahead(scan)", "def nearest(scan)")), "NameError"),
        },
        right={
            "min of a generator": nearest(
                "    return min(r for i, r in enumerate(scan.ranges)\n"
                "               if abs(scan.angle_min + i * scan.angle_increment) <= math.pi / 6)\n"
            ),
            "in degrees": changed(AHEAD, (WINDOW, "-30.001 <= math.degrees(angle) <= 30.001")),
            "places that are computed": nearest(
                "    first = round((-math.pi / 6 - scan.angle_min) / scan.angle_increment)\n"
                "    last = round((math.pi / 6 - scan.angle_min) / scan.angle_increment)\n"
                "    return min(scan.ranges[first:last + 1])\n"
            ),
            "by the cosine": changed(AHEAD, (WINDOW, "math.cos(angle) >= math.cos(math.radians(30))")),
            "sorted pairs": nearest(
                "    beams = sorted((r, i) for i, r in enumerate(scan.ranges))\n"
                "    return next(r for r, i in beams\n"
                "                if abs(scan.angle_min + i * scan.angle_increment) <= math.radians(30))\n"
            ),
            "with numpy": nearest(
                "    import numpy as np\n"
                "    angles = scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment\n"
                "    return float(np.asarray(scan.ranges)[np.abs(angles) <= math.radians(30)].min())\n"
            ),
            "run twice": (AHEAD, AHEAD),
        },
    ),
    "ray_cast": Answers(
        wrong={
            "without Pythagoras": (ray((LAST, "return ahead - radius")), "beside the middle"),
            "to the middle": (ray((LAST, "return ahead")), "is 3.0, not 2.0"),
            "the far side": (ray((LAST, LAST.replace("ahead -", "ahead +"))), "is 4.0, not 2.0"),
            "the straight distance": (ray((LAST, "return math.hypot(dx, dy) - radius")), "beside the middle"),
            "sees behind": (ray((MISSED, "if abs(beside) > radius:")), "it is behind"),
            "never misses": (ray((MISSED, "if ahead < 0:")), "ValueError"),
            "one side": (ray((MISSED, "if ahead < 0 or beside > radius:")), "ValueError"),
            "half the radius": (ray((MISSED, "if ahead < 0 or abs(beside) > radius / 2:")), "is 10.0, not"),
            "inside is nothing special": (ray((INSIDE, "")), "it starts inside"),
            "inside reads 10 m": (ray((INSIDE, INSIDE.replace("return 0.0", "return 10.0"))), "is 10.0, not 0.0"),
            "from the origin": (
                ray(("dx, dy, radius = circle[0] - x, circle[1] - y, circle[2]", "dx, dy, radius = circle")),
                "from another place",
            ),
            "degrees": (
                ray(
                    ("math.cos(angle)", "math.cos(math.radians(angle))"),
                    ("math.sin(angle)", "math.sin(math.radians(angle))"),
                ),
                "passed at the side",
            ),
            "no square root": (ray((LAST, "return ahead - (radius ** 2 - beside ** 2)")), "beside the middle"),
            "squares forgotten": (ray((LAST, "return ahead - math.sqrt(radius - abs(beside))")), "beside the middle"),
            "the sine's sign": (
                ray(("ahead = dx * math.cos(angle) + dy", "ahead = dx * math.cos(angle) - dy")),
                "beside the middle",
            ),
            "the angle ignored": (ray(("math.cos(angle)", "1.0"), ("math.sin(angle)", "0.0")), "is 2.0, not 10.0"),
            "forgets the return": (ray(("    return ahead - math", "    ahead - math")), "is None, not 2.0"),
            "three arguments": (
                ray(("def ray_circle(x, y, angle, circle)", "def ray_circle(angle, circle, x)")),
                "TypeError",
            ),
            "rounded to metres": (ray((LAST, f"return round({LAST.removeprefix('return ')})")), "beside the middle"),
        },
        right={
            "half chord by name": ray(
                (LAST, "half_chord = (radius * radius - beside * beside) ** 0.5\n    return ahead - half_chord")
            ),
            "a quadratic equation": """
def ray_circle(x, y, angle, circle):
    cx, cy, radius = circle
    b = (x - cx) * math.cos(angle) + (y - cy) * math.sin(angle)
    c = (x - cx) ** 2 + (y - cy) ** 2 - radius ** 2
    if c <= 0:
        return 0.0
    if b > 0 or b * b < c:
        return 10.0
    return -b - math.sqrt(b * b - c)

rclpy.try_shutdown()
rclpy.init()
detector = RayCaster()
""",
            "by the angle between": """
def ray_circle(x, y, angle, circle):
    dx, dy, radius = circle[0] - x, circle[1] - y, circle[2]
    distance, off = math.hypot(dx, dy), math.atan2(dy, dx) - angle
    if distance <= radius:
        return 0.0
    beside = distance * math.sin(off)
    if math.cos(off) < 0 or abs(beside) > radius:
        return 10.0
    return distance * math.cos(off) - math.sqrt(radius ** 2 - beside ** 2)

rclpy.try_shutdown()
rclpy.init()
detector = RayCaster()
""",
            "complex numbers": """
def ray_circle(x, y, angle, circle):
    import cmath
    middle = complex(circle[0] - x, circle[1] - y) * cmath.exp(-1j * angle)
    if abs(middle) <= circle[2]:
        return 0
    if middle.real < 0 or abs(middle.imag) >= circle[2]:
        return 10
    return middle.real - math.sqrt(circle[2] ** 2 - middle.imag ** 2)

rclpy.try_shutdown()
rclpy.init()
detector = RayCaster()
""",
            "run twice": (RAY, RAY),
        },
    ),
}
