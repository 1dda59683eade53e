"""Dubins and Reeds–Shepp curves: the shortest curves of a car, forwards only, and forwards and in reverse."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes, positive_number
from cspace.errors import InputError
from cspace.navigation.curves.curve import Curve
from cspace.tolerances import LARGEST_NUMBER


def dubins(start: Any, goal: Any, radius: float) -> Curve:
    """The shortest curve of a car that drives forwards with a minimum turning radius (Dubins).

    It is an arc, then a straight segment or an opposite arc of more than π, then an arc; any of them may be
    missing. start, goal (3,): x, y [m], theta [rad]. radius [m] above zero. The length is discontinuous
    where an arc becomes a full circle. An arc that differs from a full circle by no more than the rounding
    of the coordinates counts as none. Raises InputError for a value that is not a pose, and for a radius
    that is not positive.

    Dubins 1957; Shkel and Lumelsky 2001.
    """
    return find_curve(False, start, goal, radius)


def reeds_shepp(start: Any, goal: Any, radius: float) -> Curve:
    """The shortest curve of a car that drives forwards and in reverse with a minimum turning radius (Reeds
    and Shepp).

    It has up to five segments and two changes of direction: one of the 48 words of Reeds and Shepp. start,
    goal (3,): x, y [m], theta [rad]. radius [m] above zero. Raises InputError as dubins does.

    Reeds and Shepp 1990; Sussmann and Tang 1991.
    """
    return find_curve(True, start, goal, radius)


def dubins_distance(start: Any, goal: Any, radius: float) -> Any:
    """The lengths [m] of the curves of dubins, (...): a float for two poses.

    start, goal (..., 3): x, y [m], theta [rad]; leading axes broadcast. Raises InputError as dubins does.
    """
    return measure_curves(False, start, goal, radius)


def reeds_shepp_distance(start: Any, goal: Any, radius: float) -> Any:
    """The lengths [m] of the curves of reeds_shepp, (...): a float for two poses. It is a metric.

    start, goal (..., 3): x, y [m], theta [rad]; leading axes broadcast. Raises InputError as dubins does.
    """
    return measure_curves(True, start, goal, radius)


def find_curve(reverses: bool, start: Any, goal: Any, radius: Any) -> Curve:
    """The curve of one start and one goal."""
    return Curve(*_core._car_shortest(reverses, start, goal, radius, check_one))


def measure_curves(reverses: bool, start: Any, goal: Any, radius: Any) -> Any:
    """The lengths of the curves of broadcast starts and goals."""
    return _core._car_distance(reverses, start, goal, radius, measure_broadcast)


def measure_broadcast(reverses: bool, start: Any, goal: Any, radius: Any) -> Any:
    """The lengths of the curves of arguments that are not plain numbers."""
    a, b, r = check_task(start, goal, radius)
    batch = leading_axes(start=a.shape[:-1], goal=b.shape[:-1])
    rows = [np.ascontiguousarray(np.broadcast_to(p, (*batch, 3)).reshape(-1, 3)) for p in (a, b)]
    lengths = _core._car_distances(reverses, *rows, r)
    return lengths.reshape(batch) if batch else float(lengths[0])


def check_one(start: Any, goal: Any, radius: Any) -> tuple[Array, Array, float]:
    """One start and one goal (3,) and a turning radius [m]; InputError for anything else."""
    a, b, r = check_task(start, goal, radius)
    for pose, name in ((a, "start"), (b, "goal")):
        if pose.ndim != 1:
            raise InputError(f"{name} has shape {pose.shape}, expected (3,): x, y, theta")
    return a, b, r


def check_task(start: Any, goal: Any, radius: Any) -> tuple[Array, Array, float]:
    """Start and goal (..., 3) and a turning radius [m]; InputError for anything else."""
    rule = "a turning radius is one length above zero, in metres (a robot that turns on the spot "
    r = positive_number(radius, "radius", rule + "needs no such curve)", largest=LARGEST_NUMBER)
    return check_poses(start, "start", r), check_poses(goal, "goal", r), r


def check_poses(poses: Any, name: str, radius: float) -> Array:
    """Poses (..., 3) of x, y, theta; refuses coordinates so large that rounding would decide the curve."""
    array = as_floats(poses, name, last=(3,))
    if array.ndim == 1:
        x, y, theta = array.tolist()
        far, most = max(abs(x), abs(y)), abs(theta)
    else:
        far, most = np.abs(array[..., :2]).max(initial=0), np.abs(array[..., 2]).max(initial=0)
    if far > LARGEST_NUMBER * min(radius, 1.0) or most > LARGEST_NUMBER:
        raise InputError(
            f"{name} contains {max(far, most):g}; the maximum for headings and coordinates is "
            f"{LARGEST_NUMBER:g}, also in turning radii, because rounding would decide the curve"
        )
    return np.ascontiguousarray(array)
