"""Memory of the last batch, taken again when nobody holds it: fresh pages cost as much as solving."""

from __future__ import annotations

import sys
import threading

import numpy as np

from cspace.arrays import Array

__all__ = ["spare_array"]

SMALLEST, LARGEST = 1 << 16, 1 << 26
"""Sizes worth keeping [bytes]: below, the allocator is fast; above, the memory belongs to others."""

_lock = threading.Lock()
_last: list[Array] = []
# What getrefcount says of an array that only `_last` holds: the list, the local name, the argument.
_UNUSED = 3


def spare_array(shape: tuple[int, ...]) -> Array:
    """An uninitialised float64 array, in the memory of an earlier one that has gone if there is any."""
    size = int(np.prod(shape))
    if not SMALLEST <= 8 * size <= LARGEST:
        return np.empty(shape)
    with _lock:
        block = _last[0] if _last else None
        if block is None or sys.getrefcount(block) > _UNUSED or not size <= block.size <= 4 * size:
            block = np.empty(size)
            _last[:] = [block]
        return block[:size].reshape(shape)
