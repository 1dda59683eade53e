"""Hybrid A*: searches for a path of a car over poses in a lattice of positions and headings."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, one_array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.mobile import Car
from cspace.navigation.cars.car_route import CarRoute
from cspace.navigation.checks import need_grid, need_number
from cspace.navigation.curves.curve import Curve
from cspace.navigation.route import STATUSES, Stats
from cspace.tolerances import LARGEST_NUMBER


def hybrid_a_star(
    grid: Any,
    start: Any,
    goal: Any,
    *,
    vehicle: Car | None = None,
    radius: float | None = None,
    reverse: bool = True,
    box: float | None = None,
    headings: int = 72,
    reverse_cost: float = 1.2,
    gear_cost: float | None = None,
    weight: float = 2.0,
    max_nodes: int = 1_000_000,
) -> CarRoute:
    """A collision-free path of a car on an occupancy grid: arcs of its turning circle and straight
    segments.

    Best-first search over poses that the car can reach, at most one for each box of a lattice of positions
    and headings. The heuristic is the larger of two lower bounds: the length of the reeds_shepp (or dubins)
    curve without obstacles, and the path of a disc around them. Such curves are also tried as direct
    connections to the goal during the search; at the end they shorten the path. The rectangle of the car
    never overlaps a blocked cell, also between the poses; it may touch one.

    grid: an OccupancyGrid; everything outside it is blocked. start, goal (3,): x, y [m] of the middle of
    the rear axle, theta [rad]. vehicle: a Car() unless given. radius [m]: of the arcs, the car's minimum
    unless given. reverse: whether it may drive backwards. box [m]: side of the boxes, an eighth of the
    radius unless given, at least a cell; headings: their number. reverse_cost: the cost of a metre in
    reverse relative to one forwards; gear_cost [m]: of a change of direction, half a radius unless given.
    weight: the factor of the heuristic; 1 for the fewest detours on the lattice, larger for less search (2
    takes a twentieth of it on large maps, and after the final shortening the paths are no longer).
    max_nodes: the largest number of expanded poses.

    Returns CarRoute: "found"; "unreachable" where not even a disc inside the car can pass, which is a
    proof; else "undetermined". The path is not guaranteed to be the shortest. Raises InputTypeError for a
    value that is not an OccupancyGrid or Car, InputError for a start or goal where the car touches an
    obstacle, or for a number that is not positive.

    Dolgov, Thrun, Montemerlo and Diebel 2010.
    """
    need_grid(grid)
    if not isinstance(reverse, bool | np.bool_):
        raise InputTypeError(f"reverse is {reverse!r}; give True or False")
    car = Car() if vehicle is None else vehicle
    if not isinstance(car, Car):
        raise InputTypeError(f"vehicle is {name_type(car)}; give a Car")
    turning = car.turning_radius if radius is None else need_number(radius, "radius", car.turning_radius)
    side = max(turning / 8, grid.resolution) if box is None else need_number(box, "box", grid.resolution / 16)
    gear = turning / 2 if gear_cost is None else need_number(gear_cost, "gear_cost", 0.0)
    turns, backwards = need_number(headings, "headings", 4.0), need_number(reverse_cost, "reverse_cost", 1.0)
    ends = [need_number(max_nodes, "max_nodes", 1.0), need_number(weight, "weight", 0.0)]
    settings = np.array([turning, side, turns, backwards, gear, *ends])
    body = np.array(car._footprint)
    a, b = (check_pose(grid, body, pose, name) for pose, name in ((start, "start"), (goal, "goal")))
    began = perf_counter()
    status, cause, pieces, nodes, edges = _core._hybrid_a_star(grid, body, a, b, bool(reverse), settings)
    stats = Stats(nodes, edges, perf_counter() - began)
    curve = Curve(a, b, turning, tuple(pieces)) if status == 0 else None
    return CarRoute(grid, car, a, b, curve, STATUSES[status], stats, cause)


def check_pose(grid: Any, body: Array, pose: Any, name: str) -> Array:
    """A pose (3,) at which the vehicle touches nothing."""
    p = one_array(pose, name, (3,), "x, y, theta", largest=LARGEST_NUMBER)
    if not _core._car_clear(grid, body, p):
        behind, ahead, aside, _ = body
        raise InputError(
            f"at {name} ({p[0]:g}, {p[1]:g}, {p[2]:g}) the vehicle covers a blocked cell or leaves the grid;"
            f" it reaches {behind:g} m behind that place, {ahead:g} m ahead and {aside:g} m to each side;"
            " give a pose at which it is free, or another vehicle"
        )
    return p
