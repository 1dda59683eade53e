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


def holders(blocks: list[Array]) -> int:
    """How many references to the first block there are, as this very function counts them."""
    return sys.getrefcount(blocks[0])


UNUSED = holders([np.empty(1)])
"""What `holders` says of a block that nobody but its list holds."""


def spare_array(shape: tuple[int, ...]) -> Array:
    """An uninitialised float64 array, in the memory of an earlier one that has gone if there is any."""
    size = int(np.prod(shape))
    if not SMALLEST <= 8 * size <= LARGEST:
        return np.empty(shape)
    with _lock:
        if not (_last and holders(_last) == UNUSED and size <= _last[0].size <= 4 * size):
            _last[:] = [np.empty(size)]
        return _last[0][:size].reshape(shape)
