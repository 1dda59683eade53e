"""Shortest ways over grids by scipy's Dijkstra on the written-out graph: slow, and plain."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

STEPS = [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)]


def graph(blocked, corners="never", diagonals=True, costs=None):
    """The steps between free cells as a sparse matrix of their lengths, or costs, cells numbered row by
    row."""
    rows, columns = blocked.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    walled = np.pad(blocked, 1, constant_values=True)
    costs = np.ones(blocked.shape) if costs is None else costs
    padded = np.pad(costs, 1)

    def shifted(array, down, along):
        return array[1 + down : 1 + down + rows, 1 + along : 1 + along + columns]

    froms, tos, lengths = [], [], []
    for down, along in STEPS[: 8 if diagonals else 4]:
        open_ = ~blocked & ~shifted(walled, down, along)
        if down and along:
            beside = shifted(walled, down, 0).astype(int) + shifted(walled, 0, along)
            open_ &= beside <= {"never": 0, "one": 1, "always": 2}[corners]
        froms.append(number[open_])
        tos.append(number[open_] + down * columns + along)
        mean = (costs + shifted(padded, down, along))[open_] / 2
        lengths.append(np.hypot(down, along) * mean)
    joined = (np.concatenate(lengths), (np.concatenate(froms), np.concatenate(tos)))
    return coo_array(joined, shape=(number.size, number.size)).tocsr()


def distances(steps, cell, columns, limit=np.inf):
    """The lengths of the shortest ways from a cell (row, column) to all cells, inf where there is none."""
    return dijkstra(steps, indices=cell[0] * columns + cell[1], limit=limit)


def walked(blocked, cells, corners="never", diagonals=True, costs=None):
    """The length, or cost, of a way along rows, columns and diagonals through cells (row, column); None if a
    step of it is not allowed."""
    total = 0.0
    walled = np.pad(blocked, 1, constant_values=True)
    most = {"never": 0, "one": 1, "always": 2}[corners]
    for a, b in pairwise(cells):
        count = max(abs(b[0] - a[0]), abs(b[1] - a[1]))
        down, along = np.sign(b[0] - a[0]), np.sign(b[1] - a[1])
        if count and (abs(b[0] - a[0]) not in (0, count) or abs(b[1] - a[1]) not in (0, count)):
            return None
        for k in range(count):
            row, column = a[0] + k * down + 1, a[1] + k * along + 1
            if walled[row, column] or walled[row + down, column + along]:
                return None
            if down and along:
                beside = int(walled[row + down, column]) + int(walled[row, column + along])
                if not diagonals or beside > most:
                    return None
            mean = 1.0
            if costs is not None:
                mean = (costs[row - 1, column - 1] + costs[row - 1 + down, column - 1 + along]) / 2
            total += float(np.hypot(down, along)) * mean
    return total
