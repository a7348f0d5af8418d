"""Vectors of any length."""

from __future__ import annotations

from typing import Any

import numpy as np


def vector_norm(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """The length of a vector, or of the vectors along an axis; goes into `out` if that is given."""
    lengths = np.sqrt(np.sum(np.square(np.asarray(data, dtype=np.float64)), axis=axis))
    if out is not None:
        out[...] = lengths
        return None
    return float(lengths) if np.ndim(data) == 1 else np.atleast_1d(lengths)


def unit_vector(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """The same vector, or vectors along an axis, with length 1; goes into `out` if that is given."""
    array = np.array(data, dtype=np.float64)
    lengths = np.sqrt(np.sum(array * array, axis=axis, keepdims=axis is not None))
    result = array / lengths if array.size else array
    if out is not None:
        out[...] = result
        return None
    return result


def random_vector(size: int) -> Any:
    """Random numbers from 0 to 1."""
    return np.random.random(size)
