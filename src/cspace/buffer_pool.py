"""Memory of earlier batches, reused when unreferenced: new pages cost as much time as computing."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable

import numpy as np

from cspace.arrays import Array

__all__ = ["pooled_array"]

SMALLEST, LARGEST = 1 << 16, 1 << 26
"""Sizes worth keeping [bytes]: below, the allocator is fast; LARGEST bounds what is kept in all."""
LINE = 64
"""Bytes of a cache line."""

_lock = threading.Lock()
_blocks: list[Array] = []


def _holders(blocks: list[Array], i: int) -> int:
    """How many references to a block there are, as this very function counts them."""
    return sys.getrefcount(blocks[i])


_UNUSED = _holders([np.empty(1)], 0)
"""The value of `_holders` for a block that only its list references."""


def _has_exact_counts() -> bool:
    """Whether references are counted exactly: free-threaded interpreters do not."""
    is_locked: Callable[[], bool] = getattr(sys, "_is_gil_enabled", lambda: True)
    return is_locked()


def _aligned(block: Array, shape: tuple[int, ...], size: int) -> Array:
    """The part of a block that begins with a cache line."""
    start = -(block.ctypes.data // 8) % (LINE // 8)
    return block[start : start + size].reshape(shape)


def pooled_array(shape: tuple[int, ...]) -> Array:
    """An uninitialised float64 array of shape (...), in the memory of one that has gone, if any.

    Where references are not counted exactly it is always a new one.
    """
    size = int(np.prod(shape))
    if not SMALLEST <= 8 * size <= LARGEST or not _has_exact_counts():
        return np.empty(shape)
    needed = size + LINE // 8
    with _lock:
        for i in range(len(_blocks)):
            if _holders(_blocks, i) == _UNUSED and needed <= _blocks[i].size <= 4 * needed:
                return _aligned(_blocks[i], shape, size)
        made = np.empty(needed)
        _blocks.append(made)
        while sum(block.nbytes for block in _blocks) > LARGEST:
            del _blocks[0]
        return _aligned(made, shape, size)
