"""Families of worlds of whole numbers, by size and seed, with a goal that can be reached or one that cannot.

Ends are centres of unit cells wherever possible, so that one question serves planners in the plane and
planners on cells of one metre.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np
from scipy.ndimage import label
from scipy.sparse.csgraph import connected_components

import cspace as cs
from oracles.clearance import is_free, nearest, rings_of
from oracles.grids import distances, graph
from oracles.plane import shortest
from touching_worlds import slanted_touch

STEP = 0.1


@dataclass(frozen=True, eq=False)
class Question:
    """One world and two points in it. obstacles: a list of lists of rings (n, 2)."""

    family: str
    size: int
    seed: int
    shut: bool
    """Whether the goal cannot be reached."""
    obstacles: list
    bounds: tuple
    start: np.ndarray
    goal: np.ndarray
    on_wall: bool = False
    """Whether the goal has been moved onto a wall."""

    @property
    def name(self):
        more = f"{', shut' if self.shut else ''}{', goal on a wall' if self.on_wall else ''}"
        return f"{self.family} {self.size}, seed {self.seed}{more}"

    @cached_property
    def world(self):
        return cs.PolygonWorld(self.obstacles, self.bounds)

    @cached_property
    def blocked(self):
        """The unit cells that obstacles reach into: (rows, columns)."""
        return self.world.to_grid(1.0).blocked

    @cached_property
    def on_cells(self):
        """Whether both ends are centres of free unit cells."""
        ends = np.array([self.start, self.goal])
        if not np.array_equal(ends % 1, np.full((2, 2), 0.5)):
            return False
        columns, rows = (ends - self.bounds[:2]).astype(int).T
        return not self.blocked[rows, columns].any()

    @property
    def corners(self):
        """How many corners the obstacles have."""
        return sum(len(ring) for rings in self.obstacles for ring in rings)

    @cached_property
    def length(self):
        """Of the shortest way in the plane, inf where there is none."""
        return shortest(self.obstacles, self.bounds, self.start, self.goal)

    @cached_property
    def moves(self):
        """Lengths of the shortest ways over unit cells by eight moves and by four."""
        columns = self.blocked.shape[1]
        cells = [tuple((end - self.bounds[:2]).astype(int)[::-1]) for end in (self.start, self.goal)]
        goal = cells[1][0] * columns + cells[1][1]
        steps = [graph(self.blocked, diagonals=diagonals) for diagonals in (True, False)]
        return [float(distances(step, cells[0], columns)[goal]) for step in steps]

    @cached_property
    def clearance_of_ends(self):
        return float(nearest([self.start, self.goal], rings_of(self.world))[0].min())

    @cached_property
    def clearance_of_cells(self):
        return clearance_of_cells(self.blocked)

    @cached_property
    def widest_on_cells(self):
        """The largest least clearance of the centres of a way over unit cells, by their sides."""
        away, steps = self.clearance_of_cells.ravel(), graph(self.blocked, diagonals=False)
        columns = self.blocked.shape[1]
        ends = [int(y) * columns + int(x) for x, y in (self.start, self.goal)]
        values = np.unique(away[(away > 0) & (away <= away[ends].min())])
        low, high = 0, len(values)
        while high - low > 1:
            middle = (low + high) // 2
            kept = np.flatnonzero(away >= values[middle])
            at = np.searchsorted(kept, ends)
            _, part = connected_components(steps[kept][:, kept], directed=False)
            low, high = (middle, high) if part[at[0]] == part[at[1]] else (low, middle)
        return float(values[low])

    @cached_property
    def widest(self):
        """The largest least clearance of a way, by points STEP apart: up to STEP/√2 off."""
        left, low, right, high = self.bounds
        x, y = np.arange(left, right + STEP / 2, STEP), np.arange(low, high + STEP / 2, STEP)
        points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        away = np.where(is_free(points, self.world), nearest(points, rings_of(self.world))[0], 0)
        at = [np.round((end - self.bounds[:2]) / STEP).astype(int)[::-1] for end in (self.start, self.goal)]
        return bottleneck(away.reshape(len(y), len(x)), *map(tuple, at))


def convex_fields(rng, size, shut):
    """Disjoint convex polygons, one in each cell of a raster; a yard around the goal shuts it in."""
    corners = [10 * np.array([k % size, k // size]) for k in range(size * size)]
    obstacles = [[corner + convex(rng, 9)] for corner in corners]
    if not shut:
        return obstacles, (0, 0, 10 * size, 10 * size), None, None
    yard = rng.integers(size * size)
    obstacles[yard] = [corners[yard] + box(1, 1, 9, 9), corners[yard] + box(3, 3, 7, 7)]
    return obstacles, (0, 0, 10 * size, 10 * size), None, corners[yard] + rng.integers(3, 7, 2) + 0.5


def spirals(rng, size, shut):
    """A wall of unit width that winds out in 1 + size turns, three metres apart, which overlap."""
    at, obstacles = np.zeros(2, dtype=int), []
    for leg in range(4 * (1 + size)):
        end = at + 4 * (1 + leg // 2) * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])[leg % 4]
        obstacles.append([slab(at, end)])
        at = end
    every = np.vstack([rings[0] for rings in obstacles])
    low, high = every.min(axis=0) - 3, every.max(axis=0) + 3
    if shut:
        obstacles.append([slab((-4, 0), (0, 0))])
    side = rng.integers(4)
    along = rng.integers(low, high) + 0.5
    goal = np.where([side < 2, side >= 2], (low + 0.5, high - 0.5)[side % 2], along)
    return obstacles, (*low, *high), np.array([2.5, 2.5]), goal


def mazes(rng, size, shut):
    """Square rooms of three metres between walls of one, joined by a random tree of doors and some more."""
    doors = tree_of_doors(rng, size)
    rooms = rng.permutation(size * size)[:2]
    walls = {(k, 1) for k in range(size * size) if k % size < size - 1}
    walls |= {(k, size) for k in range(size * size - size)}
    more = [wall for wall in sorted(walls - doors) if rng.random() < 0.1]
    doors |= set(more)
    if shut:
        doors = {(k, step) for k, step in doors if rooms[1] not in (k, k + step)}
    obstacles = []
    for k, step in sorted(walls - doors):
        x, y = 4 * (k % size), 4 * (k // size)
        obstacles.append([box(x + 3, y - 1, x + 4, y + 4) if step == 1 else box(x - 1, y + 3, x + 4, y + 4)])
    ends = [np.array([4 * (k % size), 4 * (k // size)]) + 1.5 for k in rooms]
    return obstacles, (0, 0, 4 * size - 1, 4 * size - 1), *ends


def tree_of_doors(rng, size):
    """Doors (room, step to the next room's number) that join all rooms without a cycle."""
    reached, doors = {0}, set()
    stack = [0]
    while stack:
        k = stack[-1]
        x, y = k % size, k // size
        steps = [s for s, ok in ((1, x < size - 1), (-1, x > 0), (size, y < size - 1), (-size, y > 0)) if ok]
        steps = [s for s in steps if k + s not in reached]
        if not steps:
            stack.pop()
            continue
        s = int(rng.choice(steps))
        reached.add(k + s)
        doors.add((min(k, k + s), abs(s)))
        stack.append(k + s)
    return doors


def u_traps(rng, size, shut):
    """One U in each cell of a raster, open to any side; the start in one, the goal in another, whose lid
    shares sides with its arms if it is shut."""
    obstacles, pockets = [], []
    for k in range(size * size):
        corner = 12 * np.array([k % size, k // size])
        turn = rng.integers(4)
        depth = rng.integers(7, 11)
        shape = np.array([(1, 1), (11, 1), (11, depth), (9, depth), (9, 3), (3, 3), (3, depth), (1, depth)])
        obstacles.append([corner + quarter_turns(shape, turn)])
        pockets.append((corner, turn, depth))
    first, last = rng.permutation(size * size)[:2] if size > 1 else (0, 0)
    places = [np.array([rng.integers(4, 8), 4]) + 0.5 for _ in range(2)]
    ends = [
        pockets[k][0] + quarter_turns(p, pockets[k][1]) for k, p in zip((first, last), places, strict=True)
    ]
    if size == 1:
        ends[1] = np.array([rng.integers(12), 0]) + 0.5
    corner, turn, depth = pockets[last]
    if shut:
        lid = np.array([(3, depth), (3, depth - 1), (9, depth - 1), (9, depth)])
        obstacles.append([corner + quarter_turns(lid, turn)])
    return obstacles, (0, 0, 12 * size, 12 * size), *ends


def narrow_gaps(rng, size, shut):
    """Two walls with a gap of 2^(1 - size) metres each, off the lattice by half of that; shut: the second has
    a gap without width."""
    gap = 2.0 ** (1 - size)
    obstacles = []
    for k, x in enumerate((6, 14)):
        low = rng.integers(2, 9) + gap * rng.choice([0, 0.5])
        high = low + (0 if k and shut else gap)
        obstacles += [[box(x, 0, x + 1, low)], [box(x, high, x + 1, 12)]]
    ends = [np.array([x, rng.integers(2, 10)]) + 0.5 for x in (2, 18)]
    return obstacles, (0, 0, 21, 12), *ends


def degenerate(rng, size, shut):
    """Polygons of few whole numbers that touch, overlap, and stand in line; ends at multiples of a half, also
    on walls and in corners."""
    side = 4 + 2 * size
    while True:
        obstacles = [[some_polygon(rng, side)] for _ in range(rng.integers(size, 3 * size + 2))]
        ends = ends_between(rng, obstacles, side, shut)
        if ends is not None:
            return obstacles, (0, 0, side, side), *ends


def touching_corners(rng, size, shut):
    """A corner on a slanted edge that is crossed elsewhere, with more obstacles the larger the size."""
    side = 3 + size
    while True:
        obstacles = [[corners] for corners in slanted_touch(rng, side, min(size, 3))]
        rng.shuffle(obstacles)
        ends = ends_between(rng, obstacles, side, shut)
        if ends is not None:
            return obstacles, (0, 0, side, side), *ends


def ends_between(rng, obstacles, side, shut):
    """A start and a goal in a square world at multiples of a half, of which half are centres of unit cells;
    None where ten draws have no such pair."""
    bounds = (0, 0, side, side)
    world = cs.PolygonWorld(obstacles, bounds)
    for _ in range(10):
        ends = rng.integers(0, 2 * side + 1, (2, 2)) / 2
        if rng.random() < 0.5:
            ends = np.minimum(np.floor(ends), side - 1) + 0.5
        if not all(world.is_free(p) for p in ends) or np.array_equal(*ends):
            continue
        if (shortest(obstacles, bounds, *ends) == np.inf) == shut:
            return ends
    return None


def costly_baits(rng, size, shut):
    """A serpentine that comes near the goal at once and reaches it late, and a bypass that first leads away:
    what a greedy search finds is up to three times as long as the shortest way."""
    lanes, height, room = 2 + 2 * size, rng.integers(8, 11), rng.integers(6, 9)
    width = 2 + room + 2 * lanes
    obstacles = [[box(1, height, width - 1, height + 1)]]
    for k in range(lanes):
        x = 1 + room + 2 * k
        obstacles.append([box(x, 1, x + 1, height) if k % 2 == 0 else box(x, 0, x + 1, height - 1)])
    if shut:
        obstacles += [
            [box(width - 3, height - 1, width - 2, height)],
            [box(width - 1, height, width, height + 1)],
        ]
    ends = [np.array([room, rng.integers(height)]) + 0.5, np.array([width - 1, 0]) + 0.5]
    return obstacles, (0, 0, width, height + 2), *ends


def two_gaps(rng, size, shut):
    """Walls with a gap of one metre on the straight way and one of three metres beside it; shut: the last
    wall has none."""
    obstacles = []
    for k in range(size):
        x, narrow = 7 + 8 * k, rng.integers(6, 9)
        wide = narrow + rng.choice([-5, 3])
        spans = [(0, 15)] if shut and k == size - 1 else between_gaps({narrow: 1, wide: 3}, 15)
        obstacles += [[box(x, low, x + 1, high)] for low, high in spans]
    ends = [np.array([x, rng.integers(6, 9)]) + 0.5 for x in (2, 8 * size + 4)]
    return obstacles, (0, 0, 8 * size + 7, 15), *ends


def between_gaps(gaps, length):
    """The spans (from, to) of a wall of that length that gaps {from: width} leave."""
    ends = [0, *(end for low in sorted(gaps) for end in (low, low + gaps[low])), length]
    return list(zip(ends[::2], ends[1::2], strict=True))


FAMILIES = {
    "convex field": convex_fields,
    "spiral": spirals,
    "maze": mazes,
    "U trap": u_traps,
    "narrow gap": narrow_gaps,
    "degenerate": degenerate,
    "touching corner": touching_corners,
    "costly bait": costly_baits,
    "two gaps": two_gaps,
}


def goal_on_wall(question):
    """The question with its goal at a corner or in the middle of a side of an obstacle, still reachable."""
    rng = np.random.default_rng(question.seed)
    rings = [np.asarray(ring, float) for rings in question.obstacles for ring in rings]
    places = np.vstack([p for ring in rings for p in (ring, (ring + np.roll(ring, 1, axis=0)) / 2)])
    for goal in rng.permutation(places):
        if question.world.is_free(goal) and not np.array_equal(goal, question.start):
            moved = replace(question, goal=goal, on_wall=True)
            if moved.length < np.inf:
                return moved
    raise ValueError(f"{question.name} has no reachable wall")


def question(family, size, seed, shut=False):
    """A world of a family, turned and mirrored by its seed, with two ends in free space."""
    rng = np.random.default_rng([list(FAMILIES).index(family), size, seed, shut])
    obstacles, bounds, start, goal = FAMILIES[family](rng, size, shut)
    M = np.array([(1, 0), (0, 1)])[:: rng.choice([-1, 1])] * rng.choice([-1, 1], (2, 1))
    low, high = np.sort((np.reshape(bounds, (2, 2)) @ M.T), axis=0)
    obstacles = [[ring @ M.T - low for ring in rings] for rings in obstacles]
    ends = [None if end is None else end @ M.T - low for end in (start, goal)]
    made = Question(family, size, seed, shut, obstacles, (0, 0, *map(int, high - low)), *ends)
    if start is None or goal is None:
        return with_ends(rng, made)
    return made


@cache
def field_to_cross(size, seed):
    """A convex field to be crossed from corner to corner; made once, as large ones take a while."""
    rng = np.random.default_rng([size, seed])
    obstacles, bounds, _, _ = convex_fields(rng, size, False)
    ends = np.array([0.5, 0.5]), np.array(bounds[2:]) - 0.5
    return Question("convex field", size, seed, False, obstacles, bounds, *ends)


def with_ends(rng, question):
    """The question with the ends that are not given drawn from the centres of free unit cells, far apart."""
    cells = np.argwhere(~question.blocked)[:, ::-1] + 0.5
    cells = cells[[is_outside(cell, question) for cell in cells]]
    away = nearest(cells, rings_of(question.world))[0]
    cells = cells[away >= min(1.5, np.median(away))]
    start = cells[rng.integers(len(cells))]
    far = cells[np.abs(cells - start).max(axis=1) > 0.4 * question.bounds[2]]
    goal = far[rng.integers(len(far))] if question.goal is None else question.goal
    return replace(question, start=start, goal=goal)


def is_outside(point, question):
    """Whether a point is not in the yard of a convex field."""
    yards = [rings[1] for rings in question.obstacles if len(rings) > 1]
    return all((point < yard.min(axis=0)).any() or (point > yard.max(axis=0)).any() for yard in yards)


def clearance_of_cells(blocked):
    """How far centres of cells (rows, columns) are from the nearest blocked cell or the outside."""
    walled = np.pad(blocked, 1, constant_values=True)
    free, walls = np.argwhere(~walled), np.argwhere(walled)
    away = np.zeros(walled.shape)
    for cell in free:
        away[tuple(cell)] = np.hypot(*np.maximum(np.abs(walls - cell) - 0.5, 0).T).min()
    return away[1:-1, 1:-1]


def bottleneck(clearance, start, goal):
    """The largest least value of a way over an array by eight moves, by bisection of its values."""
    values = np.unique(clearance[clearance <= min(clearance[start], clearance[goal])])
    low, high = 0, len(values)
    while high - low > 1:
        middle = (low + high) // 2
        part, _ = label(clearance >= values[middle], np.ones((3, 3)))
        low, high = (middle, high) if part[start] == part[goal] else (low, middle)
    return float(values[low])


def box(left, low, right, high):
    return np.array([(left, low), (right, low), (right, high), (left, high)])


def slab(a, b):
    """The wall of unit width between the unit squares with their low corners at a and b."""
    low, high = np.minimum(a, b), np.maximum(a, b) + 1
    return box(*low, *high)


def quarter_turns(points, count):
    """Points of a square of twelve, turned about its centre."""
    points = np.asarray(points)
    for _ in range(count):
        points = np.stack([12 - points[..., 1], points[..., 0]], axis=-1)
    return points


def convex(rng, most):
    """The hull of some points of whole numbers from 1 to `most`."""
    while True:
        points = sorted({(int(x), int(y)) for x, y in rng.integers(1, most + 1, (rng.integers(3, 9), 2))})
        hull = [*half_hull(points), *half_hull(points[::-1])]
        if len(hull) > 2:
            return np.array(hull)


def half_hull(points):
    kept = []
    for p in points:
        while len(kept) > 1 and turn(kept[-2], kept[-1], p) <= 0:
            kept.pop()
        kept.append(p)
    return kept[:-1]


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def some_polygon(rng, side):
    """A box, an L, or a hull of whole numbers within a square of that side."""
    kind = rng.integers(3)
    if kind == 2:
        return convex(rng, 5) + rng.integers(-1, side - 4, 2)
    left, low = rng.integers(0, side, 2)
    right, high = np.array([left, low]) + rng.integers(1, 5, 2)
    if kind == 0 or right - left < 2 or high - low < 2:
        return box(left, low, right, high)
    return np.array(
        [(left, low), (right, low), (right, low + 1), (left + 1, low + 1), (left + 1, high), (left, high)]
    )
