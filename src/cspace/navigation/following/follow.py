"""A vehicle follows a path: the words around the simulator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, one_array, positive_number
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.math.wrapping import wrap_angle
from cspace.mobile import Car, Unicycle
from cspace.navigation.checks import need_grid
from cspace.navigation.curves.curve import Curve
from cspace.navigation.following.run import OUTCOMES, Run
from cspace.tolerances import LARGEST_NUMBER, SIMULATION_STEPS, TRACK_POSES

OPTIONS: Final[dict[str, dict[str, Any]]] = {
    "pure_pursuit": {"lookahead": None},
    "stanley": {"gain": 1.0, "softening": 0.5},
    "dynamic_window": {
        **{"lookahead": None, "margin": 0.05, "sensor_range": 4.0, "rays": 360.0},
        "weights": (0.3, 0.7, 0.1),
    },
}
"""The options of each controller and their values unless given, in the order of the compiled core."""

CONTROLLERS: Final = tuple(OPTIONS)
"""The controllers, in the order of the compiled core."""

Estimate = Callable[[float, Array], ArrayLike]
"""(t, true pose) → the pose (3,) that the vehicle believes in."""

Runs = list[tuple[int, int]]
"""The row at which each run begins, and whether it is driven forwards (1) or backwards (−1)."""


def follow(
    path: Any,
    controller: str = "pure_pursuit",
    *,
    vehicle: Unicycle | Car | None = None,
    world: Any = None,
    start: Any = None,
    speed: float | None = None,
    tolerance: float = 0.05,
    patience: float = 10.0,
    time_step: float = 0.05,
    time_limit: float | None = None,
    estimate: Estimate | None = None,
    **options: Any,
) -> Run:
    """Lets a vehicle follow a path in a simulator, within the vehicle's limits, and stops it at the end.

    path: points (m, 2) [m], driven forwards; poses (m, 3) with headings [rad], driven backwards where the
    next point lies behind; a Curve, a Route or a CarRoute. vehicle: a Unicycle() unless given. world: an
    OccupancyGrid, whose blocked cells end the run where the vehicle covers a part of one. start (3,): x, y
    [m], theta [rad], or (5,) with speed [m/s] and turn as in Run.controls; the beginning of the path unless
    given. speed [m/s]: the fastest, that of the vehicle unless given; it brakes in time for the end.
    tolerance [m]: what counts as the end. patience [s]: how long it may come no farther. time_step [s] of the
    simulator, within which speed and turn are constant. time_limit [s]. estimate: where the vehicle takes
    itself to be, as a function of the time [s] and its true pose (3,), from which it makes what sensors
    measure; it is asked at the beginning and after each step. The vehicle is steered from there, and moves
    and touches things where it is. Unless given, the vehicle knows where it is.

    Controllers and their options:
      "pure_pursuit" steers along the arc that meets the path `lookahead` [m] away: unless given, half a
        second of way at the present speed and 0.3 m at least, of a car a second and 1.5 wheelbases. Closer to
        the end it meets the end. A shorter one keeps nearer to bends, a longer one comes calmly back from
        beside the path (Coulter 1992).
      "stanley" steers the front wheels of a Car, forwards alone, by the error of heading and atan(gain ·
        error / (softening + v)); gain [1/s], softening [m/s]. In bends the rear axle cuts the corner
        (Hoffmann, Tomlin, Montemerlo and Thrun 2007).
      "dynamic_window" heads a Unicycle for the point of the path `lookahead` [m] away, around what a sensor
        of `rays` rays sees within `sensor_range` [m], `margin` [m] beside it: of the speeds that a step can
        reach and that can be braked in time, the best by `weights` of heading, free way and speed (Fox,
        Burgard and Thrun 1997).

    Of a path of points, a Car leaves out those that are closer to the ends than its wheelbase: a planner on a
    grid begins and ends with a short way to the centre of a cell, in another direction.

    Returns a Run, truthy if it arrived. Raises InputError for a path of fewer than two points or with none
    to follow, or a number outside its range; UnknownNameError for an unknown controller; InputTypeError for
    an option that it does not have, a vehicle that it cannot drive, or an estimate that is no function.
    """
    body = Unicycle() if vehicle is None else vehicle
    rows, runs = read_track(path, body.wheelbase if isinstance(body, Car) else 0.0)
    check_controller(controller, body, runs)
    fast = body.max_speed if speed is None else min(positive_number(speed, "speed"), body.max_speed)
    if world is not None:
        need_grid(world, "world")
    belief = None if estimate is None else Belief(estimate, controller)
    steering, far = tune_controller(controller, body, fast, options)
    given = {"time_step": time_step, "tolerance": tolerance, "patience": patience}
    step, *ends = (positive_number(value, name) for name, value in given.items())
    limit = choose_limit(rows, fast, step, time_limit)
    window = 2 * far + 4 * fast * step
    settings = np.array([step, limit, fast, window, *ends])
    points = np.ascontiguousarray(rows[:, :2])
    outcome, table = _core._follow(
        *(points, runs, np.array(body._limits), read_start(start, rows, runs), settings),
        *(CONTROLLERS.index(controller), steering, world, np.array(body._footprint), belief),
    )
    times: Array = step * np.arange(len(table), dtype=np.float64)
    parts = (table[:, :3], table[:, 3:5], table[:, 5], table[:, 6])
    beliefs = parts[0] if belief is None else np.array(belief.poses)
    return Run(body, controller, times, *parts, OUTCOMES[outcome], beliefs, points[-1], tightest_bend(points))


def choose_limit(rows: Array, speed: float, step: float, given: float | None) -> float:
    """How long a run may take [s]. Raises InputError for more steps than a simulation may have."""
    length = float(np.hypot(*np.diff(rows[:, :2], axis=0).T).sum())
    limit = 10 * length / speed + 60 if given is None else positive_number(given, "time_limit")
    if limit > SIMULATION_STEPS * step:
        rule = f"give numbers for at most {SIMULATION_STEPS:g} steps"
        raise InputError(f"time_step is {step:g} s, time_limit {limit:g} s; {rule}")
    return limit


class Belief:
    """Where a vehicle takes itself to be, and every pose (3,) that it did."""

    def __init__(self, estimate: Estimate, controller: str) -> None:
        if not callable(estimate):
            raise InputTypeError(
                f"estimate is {name_type(estimate)}, expected a function of the time and the true pose"
                " that returns a pose (3,)"
            )
        if controller == "dynamic_window":
            raise InputTypeError(
                "dynamic_window sees the world from where it takes itself to be; use pure_pursuit or stanley"
                " with estimate="
            )
        self.estimate = estimate
        self.poses: list[Array] = []

    def __call__(self, t: float, *pose: float) -> tuple[float, ...]:
        """The pose at a time, with the vehicle at another one. InputError for anything but a pose."""
        told = self.estimate(t, np.array(pose))
        found = one_array(told, f"the estimate at t = {t:g} s", (3,), largest=LARGEST_NUMBER)
        self.poses.append(found)
        return tuple(found.tolist())


def tune_controller(
    controller: str, vehicle: Unicycle | Car, speed: float, options: dict[str, Any]
) -> tuple[Array, float]:
    """The numbers (7,) of a controller, and how far ahead of the vehicle it looks [m]."""
    known = OPTIONS[controller]
    for name in options:
        if name not in known:
            raise InputTypeError(str(suggest("option", name, known, owner=f"controller {controller!r}")))
    given = {**known, **options}
    wheelbase = vehicle.wheelbase if isinstance(vehicle, Car) else 0.0
    seconds, far = 0.0, 2 * wheelbase
    if "lookahead" in given and given["lookahead"] is None:
        seconds = 1.5 if controller == "dynamic_window" else 1.0 if wheelbase else 0.5
        given["lookahead"] = least = max(1.5 * wheelbase, 0.3)
        far = max(seconds * speed, least)
    elif "lookahead" in given:
        far = positive_number(given["lookahead"], "lookahead")
    weights = as_floats(given.pop("weights", (1.0, 1.0, 1.0)), "weights")
    if weights.shape != (3,) or not (weights >= 0).all() or not weights.any():
        raise InputError(f"weights is {options['weights']!r}; give three numbers of zero or more")
    numbers = {name: positive_number(value, name) for name, value in given.items()}
    if controller == "dynamic_window":
        keeps = vehicle._footprint[3] + numbers["margin"]
        return np.array([keeps, far, numbers["sensor_range"], numbers["rays"], *weights.tolist()]), far
    order = [*numbers.values(), seconds]
    return np.array(order + [0.0] * (7 - len(order))), far


def check_controller(controller: str, vehicle: Unicycle | Car, runs: Runs) -> None:
    """Whether a controller of that name exists and can drive the vehicle along the runs."""
    if not isinstance(vehicle, Unicycle | Car):
        raise InputTypeError(f"vehicle is {name_type(vehicle)}; give a Unicycle or a Car")
    if not isinstance(controller, str) or controller not in CONTROLLERS:
        raise suggest("controller", controller, CONTROLLERS)
    if controller == "dynamic_window" and not isinstance(vehicle, Unicycle):
        raise InputTypeError("dynamic_window drives a disc that turns on the spot; give a Unicycle")
    if controller == "stanley" and not isinstance(vehicle, Car):
        raise InputTypeError(
            "stanley steers front wheels, a Unicycle has none; give vehicle=Car() or pure_pursuit"
        )
    backwards = any(direction < 0 for _, direction in runs)
    if controller != "pure_pursuit" and backwards:
        raise InputError(
            f"{controller} drives forwards, part of the path is driven backwards; use pure_pursuit"
        )
    if backwards and vehicle.max_reverse == 0:
        raise InputError("part of the path is driven backwards, and max_reverse of the vehicle is 0")


def read_track(path: Any, stub: float = 0.0) -> tuple[Array, Runs]:
    """The points (m, 2) or poses (m, 3) of a path without repeated ones, and its runs.

    stub: how close to an end points are left out [m].
    """
    if hasattr(path, "path"):
        if not path:
            raise InputError(f"the path to follow was not found: {path.reason}")
        path = getattr(path, "curve", path.path)
    if isinstance(path, Curve):
        path = path.sample(path.radius / TRACK_POSES)
    rows = as_floats(path, "path", largest=LARGEST_NUMBER)
    if rows.ndim != 2 or rows.shape[1] not in (2, 3):
        raise InputError(f"path has shape {rows.shape}, expected points (m, 2) or poses (m, 3)")
    moves = np.hypot(*np.diff(rows[:, :2], axis=0).T)
    rows = rows[np.concatenate([np.ones(min(len(rows), 1), bool), moves > 0])]
    if len(rows) < 2:
        raise InputError("path has no length; give two different points or more")
    if rows.shape[1] == 2:
        s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(rows, axis=0).T))])
        keeps = (s >= stub) & (s <= s[-1] - stub)
        keeps[[0, -1]] = True
        return rows[keeps] if (rows[0] != rows[-1]).any() else rows, [(0, 1)]
    steps = np.diff(rows[:, :2], axis=0)
    middle = rows[:-1, 2] + 0.5 * wrap_angle(np.diff(rows[:, 2]))
    ahead = steps[:, 0] * np.cos(middle) + steps[:, 1] * np.sin(middle)
    signs = np.where(ahead < 0, -1, 1)
    begins = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist()]
    return rows, [(k, int(signs[k])) for k in begins]


def tightest_bend(points: Array) -> float:
    """The least radius [m] of arcs that round the corners of a path (m, 2): each takes half of the shorter
    side, or all of it at an end of the path."""
    steps = np.diff(points, axis=0)
    lengths, angles = np.hypot(*steps.T), np.arctan2(steps[:, 1], steps[:, 0])
    share = np.full(len(lengths), 0.5)
    share[[0, -1]] = 1.0
    room = np.minimum((share * lengths)[:-1], (share * lengths)[1:])
    half = np.abs(np.tan(0.5 * wrap_angle(np.diff(angles))))
    with np.errstate(divide="ignore"):
        return float((room / half).min(initial=np.inf))


def read_start(start: Any, rows: Array, runs: Runs) -> Array:
    """Pose, speed and turn (5,) at which a run begins."""
    if start is None:
        dx, dy = runs[0][1] * (rows[1, :2] - rows[0, :2])
        theta = rows[0, 2] if rows.shape[1] == 3 else np.arctan2(dy, dx)
        return np.array([*rows[0, :2], theta, 0.0, 0.0])
    begin = as_floats(start, "start", largest=LARGEST_NUMBER)
    if begin.shape not in ((3,), (5,)):
        raise InputError(
            f"start has shape {begin.shape}, expected (3,): x, y, theta, or (5,) with speed and turn"
        )
    return np.concatenate([begin, np.zeros(5 - len(begin))])
