"""Memory is handed out again only when nobody holds it."""

import numpy as np

from cspace.ik.spare import spare_array

SHAPE = (1000, 8, 6)


def test_an_array_in_use_is_never_handed_out_again():
    held = [spare_array(SHAPE) for _ in range(4)]
    for i, array in enumerate(held):
        array[:] = i
    assert all(np.all(array == i) for i, array in enumerate(held))


def test_a_view_keeps_its_memory():
    row = spare_array(SHAPE)[17]
    row[:] = 1.0
    spare_array(SHAPE)[:] = 2.0
    assert np.all(row == 1.0)


def test_memory_that_has_gone_is_taken_again():
    first = spare_array(SHAPE)
    address = first.ctypes.data
    del first
    assert spare_array(SHAPE).ctypes.data == address
