"""Worlds of blocked cells under a whole-numbered map of the plane: what hangs together is counted by cells.

Cells are sheared and stretched by a matrix of integers, so that walls run in many directions and every
question about them has an exact answer in fractions.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np


@dataclass
class CellWorld:
    """blocked: (rows, columns); M: (2, 2) of whole numbers, its determinant positive: (x, y) = M (column,
    row)."""

    blocked: np.ndarray
    M: np.ndarray

    def place(self, column, row):
        """Where a point of the grid lies in the world, as numbers that doubles hold exactly."""
        return tuple(float(v) for v in self.M @ np.array([column, row], dtype=float))

    def polygons(self):
        """Each blocked cell as a polygon, and all around as bounds would be: four slabs beyond the border."""
        rows, columns = self.blocked.shape
        cells = [(c, r, c + 1, r + 1) for r, c in np.argwhere(self.blocked)]
        cells += [(-1, -1, columns + 1, 0), (-1, rows, columns + 1, rows + 1)]
        cells += [(-1, 0, 0, rows), (columns, 0, columns + 1, rows)]
        return [
            np.array([self.place(a, b), self.place(c, b), self.place(c, d), self.place(a, d)])
            for a, b, c, d in cells
        ]

    def parts(self):
        """The part of free space of each cell, -1 where blocked: cells hang together by sides."""
        rows, columns = self.blocked.shape
        part = np.full((rows, columns), -1)
        for seed in np.argwhere(~self.blocked):
            if part[tuple(seed)] >= 0:
                continue
            number, stack = part.max() + 1, [tuple(seed)]
            part[tuple(seed)] = number
            while stack:
                r, c = stack.pop()
                for nr, nc in ((r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)):
                    inside = 0 <= nr < rows and 0 <= nc < columns
                    if inside and not self.blocked[nr, nc] and part[nr, nc] < 0:
                        part[nr, nc] = number
                        stack.append((nr, nc))
        return part

    def cells_at(self, point):
        """The cells whose closure holds a point (column, row) of fractions, inside the grid."""
        rows, columns = self.blocked.shape
        spans = []
        for value, most in zip(point, (columns, rows), strict=True):
            low = value.numerator // value.denominator
            spans.append([k for k in ((low - 1, low) if low == value else (low,)) if 0 <= k < most])
        return [(r, c) for r in spans[1] for c in spans[0]]

    def parts_at(self, point, part):
        """The parts of free space in whose closure a point lies."""
        return {part[cell] for cell in self.cells_at(point)} - {-1}

    def entries(self, start, goal):
        """How often the segment from start to goal (column, row) leaves free space, or passes a point where
        walls meet from one side to the other."""
        cuts = {Fraction(0), Fraction(1)}
        d = [b - a for a, b in zip(start, goal, strict=True)]
        for a, step in zip(start, d, strict=True):
            if step:
                low, high = sorted((a, a + step))
                first, last = -(-low.numerator // low.denominator), high.numerator // high.denominator
                cuts |= {(k - a) / step for k in range(first, last + 1)}
        ordered = sorted(cuts)
        free, count = None, 0
        for t, u in pairwise(ordered):
            middle = [a + (t + u) / 2 * step for a, step in zip(start, d, strict=True)]
            cells = self.cells_at(middle)
            now = {cell for cell in cells if not self.blocked[cell]}
            if free is None:
                count += not now
            elif free and (not now or not self._joined(free, now, t, start, d)):
                count += 1
            free = now
        return count

    def _joined(self, before, after, t, start, d):
        """Whether free cells around the point at t lead from the cells before it to those after it."""
        around = self.cells_at([a + t * step for a, step in zip(start, d, strict=True)])
        free = [cell for cell in around if not self.blocked[cell]]
        seen, stack = set(before), list(before)
        while stack:
            r, c = stack.pop()
            for cell in free:
                if cell not in seen and abs(cell[0] - r) + abs(cell[1] - c) == 1:
                    seen.add(cell)
                    stack.append(cell)
        return bool(seen & after)


def crosses_wall(path, world):
    """Whether a path (m, 2) goes through the inside of a blocked cell by more than rounding."""
    inverse = np.linalg.inv(world.M.astype(float))
    rows, columns = world.blocked.shape
    slack = 1e-9
    points = np.asarray(path) @ inverse.T
    for a, b in pairwise(points):
        cuts = {0.0, 1.0}
        for k in range(2):
            if abs(b[k] - a[k]) > slack:
                low, high = sorted((a[k], b[k]))
                cuts |= {
                    (n - a[k]) / (b[k] - a[k]) for n in range(int(np.ceil(low)), int(np.floor(high)) + 1)
                }
        ordered = sorted(cuts)
        for t, u in pairwise(ordered):
            x, y = a + (t + u) / 2 * (b - a)
            deep = min(x - np.floor(x), np.ceil(x) - x, y - np.floor(y), np.ceil(y) - y)
            if deep < slack:
                continue
            r, c = int(np.floor(y)), int(np.floor(x))
            if not (0 <= r < rows and 0 <= c < columns) or world.blocked[r, c]:
                return True
    return False
