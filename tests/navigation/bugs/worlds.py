"""World families of blocked cells, with questions at corners, on sides and inside cells."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from oracles.cell_worlds import CellWorld

MATRICES = [((1, 0), (0, 1)), ((2, 1), (-1, 3)), ((1, 1), (-1, 1)), ((3, 1), (1, 2))]


def scattered(rng, n):
    return rng.random((n, n)) < rng.uniform(0.1, 0.6)


def chequers(rng, n):
    return (np.indices((n, n)).sum(axis=0) % 2 == 0) & (rng.random((n, n)) < 0.9)


def spiral(rng, n):
    blocked = np.ones((n, n), dtype=bool)
    r, c, dr, dc = 0, 0, 0, 1
    blocked[0, 0] = False
    while True:
        for _ in range(2):
            ahead, further = (r + dr, c + dc), (r + 2 * dr, c + 2 * dc)
            open_ahead = 0 <= ahead[0] < n and 0 <= ahead[1] < n and blocked[ahead]
            clear = not (0 <= further[0] < n and 0 <= further[1] < n) or blocked[further]
            if open_ahead and clear:
                break
            dr, dc = dc, -dr
        else:
            break
        r, c = ahead
        blocked[r, c] = False
    if rng.random() < 0.3:
        blocked[tuple(rng.integers(n, size=2))] = True
    return blocked


def trap(rng, n):
    blocked = np.zeros((n, n), dtype=bool)
    blocked[1, 1:-1] = blocked[-2, 1:-1] = blocked[1:-1, -2] = True
    if n > 4 and rng.random() < 0.5:
        blocked[1:-1, 1] = True
        if rng.random() < 0.5:
            blocked[rng.integers(2, n - 2), 1] = False
    return blocked


def comb(rng, n):
    blocked = np.zeros((n, n), dtype=bool)
    blocked[1:, 1::4] = True
    blocked[:-1, 3::4] = True
    return blocked


def rings(rng, n):
    away = np.minimum(*np.indices((n, n)), out=None)
    away = np.minimum(away, n - 1 - np.maximum(*np.indices((n, n))))
    blocked = away % 2 == 1
    if rng.random() < 0.6:
        blocked[rng.integers(n)] = False
    return blocked


FAMILIES = [scattered, chequers, spiral, trap, comb, rings]


def some_point(rng, n):
    """A point (column, row) of the closed grid, at quarters of cells."""
    return tuple(Fraction(int(k), int(rng.choice([1, 2, 4]))) for k in rng.integers(0, n + 1, 2))


def questions(seed, count, family, largest=8):
    """(world, start, goal): points (column, row); the start lies in the closure of free space."""
    rng = np.random.default_rng([seed, FAMILIES.index(family)])
    while count:
        n = int(rng.integers(4, largest + 1))
        world = CellWorld(family(rng, n), np.array(MATRICES[rng.integers(len(MATRICES))]))
        part = world.parts()
        for _ in range(4):
            start, goal = some_point(rng, n), some_point(rng, n)
            if count and world.parts_at(start, part) and world.parts_at(goal, part):
                count -= 1
                yield world, start, goal
