"""The shortest way among polygons, exact: every corner, crossing and end is a place, each of its free sectors
a state, and two places that see each other join the sectors through which they do.

What `oracles.shortest` does point by point is done here for arrays of whole numbers, so that worlds of
hundreds of corners take a second; both were written apart, and a test compares them. Coordinates are whole
numbers or fractions; only the lengths that are added up are rounded. A way may touch walls, but a place where
walls meet is passed within one sector alone, so that nothing squeezes between two obstacles.
"""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from functools import cmp_to_key

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

LARGEST = 2**20  # products of three such numbers stay below 2^63


def shortest(obstacles, bounds, start, goal):
    """The length of the shortest way, inf where there is none. obstacles: a list of rings (n, 2) each."""
    plane = Plane(obstacles, bounds, [start, goal])
    ends = [plane.states_of(plane.place_of(p)) for p in (start, goal)]
    if not all(ends):
        raise ValueError("an end does not lie in the closure of free space")
    lengths = dijkstra(plane.graph(), directed=False, indices=ends[0], min_only=True)
    return float(min(lengths[state] for state in ends[1])) if set(ends[0]).isdisjoint(ends[1]) else 0.0


class Plane:
    """The arrangement of all walls, with the given points among its places."""

    def __init__(self, obstacles, bounds, points):
        edges, owners = walls(obstacles, bounds)
        places = {p for edge in edges for p in edge} | {fractions(p) for p in points} | crossings(edges)
        self.scale = math.lcm(*(v.denominator for p in places for v in p))
        self.number = {p: k for k, p in enumerate(sorted(places))}
        whole = [[int(v * self.scale) for v in p] for p in self.number]
        small = max(abs(v) for p in whole for v in p) < LARGEST
        self.at = np.array(whole, dtype=np.int64 if small else object)
        self.owners = np.array(owners)
        self.a, self.b = (np.array([self.number[edge[side]] for edge in edges]) for side in (0, 1))
        self.pieces = self.split()
        self._sectors()

    def place_of(self, point):
        return self.number[fractions(point)]

    def split(self):
        """The pieces of walls between neighbouring places, as pairs of places."""
        found = set()
        for a, b in zip(self.a, self.b, strict=True):
            along, to = self.at[b] - self.at[a], self.at - self.at[a]
            dot = to @ along
            on = np.flatnonzero((cross(along, to) == 0) & (dot >= 0) & (dot <= along @ along))
            ordered = on[np.argsort(dot[on].astype(float) if dot.dtype != object else dot[on])]
            found |= {(min(p, q), max(p, q)) for p, q in itertools.pairwise(ordered)}
        return sorted((int(p), int(q)) for p, q in found)

    def _sectors(self):
        """Around each place the directions of walls, counterclockwise, and the state of the sector that
        follows each; None where an obstacle fills it."""
        around = [[] for _ in self.at]
        for p, q in self.pieces:
            around[p].append(tuple(self.at[q] - self.at[p]))
            around[q].append(tuple(self.at[p] - self.at[q]))
        self.around = [sorted(directions, key=cmp_to_key(turn)) for directions in around]
        self.count, self.states = 0, []
        for place, directions in enumerate(self.around):
            states = []
            for k in range(max(len(directions), 1)):
                free = self.is_free(place, between(directions, k))
                states.append(self.count if free else None)
                self.count += free
            self.states.append(states)

    def is_free(self, place, direction):
        """Whether free space begins at a place in a direction that runs along no wall: by the walls that a
        ray crosses, obstacle by obstacle."""
        a, b = (self.at[ends] - self.at[place] for ends in (self.a, self.b))
        of_a, of_b = cross(direction, a), cross(direction, b)
        beyond = cross(a, b - a) * sign(of_b - of_a) > 0
        odd = np.bincount(self.owners[((of_a > 0) != (of_b > 0)) & beyond], minlength=2) % 2
        return bool(odd[0] == 1 and not odd[1:].any())

    def states_of(self, place):
        return [state for state in self.states[place] if state is not None]

    def state_towards(self, place, direction):
        """The state of the sector that holds a direction, or begins with it."""
        directions = self.around[place]
        before = sum(turn(d, direction) <= 0 for d in directions)
        return self.states[place][before - 1 if directions else 0]

    def graph(self):
        """Which states see each other: a symmetric sparse matrix of lengths."""
        edges, walls = [], set(self.pieces)
        p, q = np.array(self.pieces).T
        ends = [sign(cross(self.at[q] - self.at[p], self.at[k] - self.at[p])) for k in range(len(self.at))]
        of_place = np.array(ends)
        for i in range(len(self.at)):
            for j in self.seen_from(i, p, q, of_place):
                d = self.at[j] - self.at[i]
                length = math.sqrt(float(d @ d)) / self.scale
                for s, t in self.joined(i, j, d, (i, j) in walls):
                    edges.append((s, t, length))
        rows, columns, lengths = zip(*edges, strict=True) if edges else ((), (), ())
        return coo_array((lengths, (rows, columns)), shape=(self.count, self.count)).tocsr()

    def seen_from(self, i, p, q, of_place):
        """The later places j whose segment from i meets no place between and crosses no wall."""
        to = self.at - self.at[i]
        to_j = to[i + 1 :]
        area = to_j[:, None, 0] * to[None, :, 1] - to_j[:, None, 1] * to[None, :, 0]
        dot = to_j[:, None, 0] * to[None, :, 0] + to_j[:, None, 1] * to[None, :, 1]
        whole = (to_j * to_j).sum(axis=1)[:, None]
        between_ = ((area == 0) & (dot > 0) & (dot < whole)).any(axis=1)
        sides = sign(area)
        crossed = (sides[:, p] * sides[:, q] < 0) & (of_place[i] * of_place[i + 1 :] < 0)
        return i + 1 + np.flatnonzero(~between_ & ~crossed.any(axis=1))

    def joined(self, i, j, d, is_wall):
        """The pairs of states that a segment joins: the sector it runs through, or along a wall those on both
        sides."""
        here, there = self.state_towards(i, tuple(d)), self.state_towards(j, tuple(-d))
        if not is_wall:
            pairs = [(here, there)]
        else:
            after = self.around[j].index(tuple(-d)) - 1, self.around[i].index(tuple(d)) - 1
            pairs = [(here, self.states[j][after[0]]), (self.states[i][after[1]], there)]
        return [(s, t) for s, t in pairs if s is not None and t is not None]


def fractions(point):
    return Fraction(float(point[0])), Fraction(float(point[1]))


def walls(obstacles, bounds):
    """Every edge as a pair of points, and the number of what it bounds: 0 for the bounds, then obstacles."""
    left, low, right, high = bounds
    around = [(left, low), (right, low), (right, high), (left, high)]
    edges, owners = [], []
    for owner, rings in enumerate([[around], *obstacles]):
        for ring in rings:
            points = [fractions(p) for p in ring]
            for a, b in zip(points, points[1:] + points[:1], strict=True):
                edges.append((a, b))
                owners.append(owner)
    return edges, owners


def crossings(edges):
    """The places at which two edges cross inside both."""
    found = set()
    boxes = [[sorted((a[k], b[k])) for k in (0, 1)] for a, b in edges]
    for i, (a, b) in enumerate(edges):
        for j in range(i):
            if any(boxes[i][k][1] < boxes[j][k][0] or boxes[j][k][1] < boxes[i][k][0] for k in (0, 1)):
                continue
            c, d = edges[j]
            of_c, of_d = area(a, b, c), area(a, b, d)
            of_a, of_b = area(c, d, a), area(c, d, b)
            if of_c * of_d < 0 and of_a * of_b < 0:
                t = of_a / (of_a - of_b)
                found.add((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
    return found


def area(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def cross(u, v):
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def sign(values):
    return np.where(values > 0, 1, np.where(values < 0, -1, 0))


def turn(u, v):
    """Which of two directions comes first, counterclockwise from the x axis."""
    half_u, half_v = (int(w[1] < 0 or (w[1] == 0 and w[0] < 0)) for w in (u, v))
    if half_u != half_v:
        return half_u - half_v
    side = u[0] * v[1] - u[1] * v[0]
    return -1 if side > 0 else int(side < 0)


def between(directions, k):
    """A direction strictly inside the sector after direction k."""
    if not directions:
        return np.array([1, 0])
    u, v = (np.array(directions[i % len(directions)], dtype=object) for i in (k, k + 1))
    side = u[0] * v[1] - u[1] * v[0]
    if side == 0:
        return np.array([-u[1], u[0]]) if u @ v < 0 else -u
    return u + v if side > 0 else -(u + v)
