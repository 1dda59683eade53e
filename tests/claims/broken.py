"""Planners broken on purpose, each in one way: every function here stands in for `cs.navigate`."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np

import cspace as cs

FAR = 8.0


class Told(SimpleNamespace):
    """A route whose planner says something else than what it found."""

    def __bool__(self):
        return self.status == "found"


def told(route, **changed):
    names = ("status", "path", "length", "stats", "evidence", "world", "start", "goal")
    return Told(**({name: getattr(route, name) for name in names} | changed))


def gives_up_at_the_second_hit(*question, **options):
    """Bug 2 that takes its second contact for the first one met again."""
    route = cs.navigate(*question, **options)
    return told(route, status="unreachable") if len(route.evidence.hits) > 1 else route


def takes_rest_for_arrival(*question, **options):
    """A descent that prints success wherever it stops."""
    route = cs.navigate(*question, **options)
    length = float(np.hypot(*np.diff(route.path, axis=0).T).sum())
    return told(route, status="found", length=length)


def jumps_to_the_goal(*question, **options):
    """A descent that draws the rest of the way as a straight line."""
    route = cs.navigate(*question, **options)
    path = np.vstack([route.path, [route.goal]])
    return told(route, status="found", path=path, length=float(np.hypot(*np.diff(path, axis=0).T).sum()))


def walks_to_and_fro(*question, **options):
    """To the end of the way, back again, and once more."""
    route = cs.navigate(*question, **options)
    if not len(route.path):
        return route
    path = np.vstack([route.path, route.path[-2::-1], route.path[1:]])
    return told(route, path=path, length=3 * route.length)


def denies_what_is_far(*question, **options):
    """A search that stops at a distance and calls that a proof."""
    route = cs.navigate(*question, **options)
    far = math.dist(route.start, route.goal) > FAR
    return told(route, status="unreachable", path=np.empty((0, 2)), length=math.inf) if far else route


def cuts_through(*question, **options):
    """The straight line, whatever stands there."""
    route = cs.navigate(*question, **options)
    path = np.array([route.start, route.goal])
    return told(route, status="found", path=path, length=math.dist(*path))


def peeks(world, start, goal, planner, **options):
    """A robot without a map that looks at it."""
    route, seen = cs.navigate(world, start, goal, planner, **options), cs.navigate(world, start, goal)
    return told(route, path=seen.path, length=seen.length) if seen else route


def stays_poor(*question, **options):
    """A roadmap that never has more than few samples."""
    return cs.navigate(*question, **options | {"samples": 60})


def denies_what_is_undetermined(*question, **options):
    """Cells too coarse for a gap, taken for a wall."""
    route = cs.navigate(*question, **options | {"depth": 3, "max_depth": 3})
    return told(route, status="unreachable") if route.status == "undetermined" else route


def refuses_walls(*question, **options):
    """Takes a goal on a wall for one in an obstacle."""
    route = cs.navigate(*question, **options)
    on_wall = route.world.kind == "polygons" and route.world.clearance(route.goal) == 0
    return told(route, status="unreachable", path=np.empty((0, 2)), length=math.inf) if on_wall else route


def hurries(*question, **options):
    """Weighs what is left four times, and says that its way is within 1.5."""
    name = {"weighted_a_star": "weight", "focal_search": "bound"}[question[3]]
    return cs.navigate(*question, **options | {name: 4.0})


def prefers_length(*question, **options):
    """The shortest way along a diagram, taken for the widest."""
    return cs.navigate(*question, **options | {"prefer": "length"})


class Slow:
    """A planner whose time, by its own clock, and nodes grow as a power of the number of cells."""

    def __init__(self, power):
        self.power, self.now = power, 0.0

    def __call__(self, *question, **options):
        route = cs.navigate(*question, **options)
        spent = float(route.world.rows * route.world.columns) ** self.power
        self.now += 1e-9 * spent
        return told(route, stats=route.stats._replace(nodes=int(spent)))

    def clock(self):
        return self.now
