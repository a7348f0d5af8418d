from dataclasses import dataclass, field
from typing import Optional

import numpy as np


@dataclass
class PID:
    kp: float = 1.0
    ki: float = 0.0
    kd: float = 0.0
    limit: float = 2.0
    _last: Optional[float] = field(default=None, repr=False)
    _sum: float = field(default=0.0, repr=False)

    def __call__(self, error: float, dt: float) -> float:
        self._sum += error * dt
        slope = 0.0 if self._last is None else (error - self._last) / dt
        self._last = error
        return float(np.clip(self.kp * error + self.ki * self._sum + self.kd * slope, -self.limit, self.limit))
