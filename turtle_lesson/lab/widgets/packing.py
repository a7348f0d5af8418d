"""Numbers on their way to the browser: 32-bit floats, as bytes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def pack(numbers: ArrayLike) -> bytes:
    """Numbers in their order as little-endian 32-bit floats; JavaScript reads them as a Float32Array."""
    return np.ascontiguousarray(numbers, dtype="<f4").tobytes()
