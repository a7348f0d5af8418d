from math import atan2, cos, sin


def normalize(angle: float) -> float:
    return atan2(sin(angle), cos(angle))
