"""Memory is handed out again only when nobody holds it."""

import sys

import numpy as np

from cspace import buffer_pool
from cspace.buffer_pool import LARGEST, SMALLEST, _blocks, pooled_array

SHAPE = (1000, 8, 6)


def test_an_array_in_use_is_never_handed_out_again():
    held = [pooled_array(SHAPE) for _ in range(4)]
    for i, array in enumerate(held):
        array[:] = i
    assert all(np.all(array == i) for i, array in enumerate(held))


def test_a_view_keeps_its_memory():
    row = pooled_array(SHAPE)[17]
    row[:] = 1.0
    pooled_array(SHAPE)[:] = 2.0
    assert np.all(row == 1.0)


def test_memory_that_has_gone_is_taken_again():
    first = pooled_array(SHAPE)
    assert first.flags.c_contiguous
    address = first.ctypes.data
    del first
    assert pooled_array(SHAPE).ctypes.data == address


def test_several_arrays_of_one_call_come_back_in_the_next():
    pair = [pooled_array(SHAPE), pooled_array(SHAPE)]
    addresses = {array.ctypes.data for array in pair}
    del pair
    again = [pooled_array(SHAPE), pooled_array(SHAPE)]
    assert {array.ctypes.data for array in again} == addresses


def test_memory_begins_with_a_cache_line():
    for rows in (200, 1000, 1001):
        assert rows * 8 * 6 * 8 >= SMALLEST
        assert pooled_array((rows, 8, 6)).ctypes.data % 64 == 0


def test_what_is_kept_is_bounded():
    for rows in range(4, 40):
        pooled_array((rows * LARGEST // 8 // 40,))
    assert sum(block.nbytes for block in _blocks) <= LARGEST
    assert pooled_array((2 * LARGEST // 8,)).nbytes == 2 * LARGEST
    assert sum(block.nbytes for block in _blocks) <= LARGEST


def test_a_free_threaded_interpreter_shares_no_memory(monkeypatch):
    """It does not count references exactly, so no array that is in use may be taken for unused."""
    monkeypatch.setattr(sys, "_is_gil_enabled", lambda: False, raising=False)
    monkeypatch.setattr(buffer_pool, "_holders", lambda blocks, i: buffer_pool._UNUSED)
    kept = len(buffer_pool._blocks)
    first, second = pooled_array((1 << 14,)), pooled_array((1 << 14,))
    assert not np.shares_memory(first, second)
    assert len(buffer_pool._blocks) == kept
