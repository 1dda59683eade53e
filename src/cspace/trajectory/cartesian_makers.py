"""Makers of Cartesian paths: lines, arcs, screws, and polylines of poses with blended corners."""

from __future__ import annotations

from math import comb
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, bounded_number, one_array, one_number
from cspace.errors import InputError
from cspace.spatial import as_pose, inverse_pose, log_so3, screw_of
from cspace.spatial.checks import PoseLike, one_pose
from cspace.tolerances import (
    COLLINEAR_POINTS,
    FARTHEST,
    FARTHEST_POINT,
    NEAR_HALF_TURN,
    REPEATED_POSE,
    SHORTEST_BLEND,
    SMOOTH_CORNER,
)
from cspace.trajectory.cartesian_path import DEGREE, CartesianPath, CartesianPiece

ROTATIONS: Final = ("interpolate", "keep", "follow")
"""What the rotation of the tip does along an arc."""

BLEND_SPACING: Final = 1 / 3
"""Distance of the control points of a blend, as a fraction of its length on each leg: within a tenth of the
peak curvature of a circle up to 90°."""

BLEND_MISS: Final = (16 - 25 * BLEND_SPACING) / 32
"""How far a blend passes from its corner, per length on each leg and per change of direction."""

REVERSAL: Final = 0.1
"""Sum of the directions before and after a corner below which no blend turns the path around: it stops."""

NO_POLYNOMIAL: Final = np.zeros((DEGREE + 1, 3))
Z: Final = np.array([0.0, 0.0, 1.0])


def line_path(T_start: PoseLike, T_goal: PoseLike) -> CartesianPath:
    """The straight line of the tip between two poses, its rotation about a fixed axis.

    T_start, T_goal (4, 4): T_base_tip. Raises InputError for poses 180° apart: either way is shortest.
    """
    return pose_path([_near_pose(T_start, "start pose"), _near_pose(T_goal, "goal pose")])


def screw_path(T_start: PoseLike, T_goal: PoseLike) -> CartesianPath:
    """The screw motion between two poses: a rotation about an axis that stands still, and a slide along it.

    T_start, T_goal (4, 4): T_base_tip. Its way does not depend on which point of the tip is followed
    (Chasles).
    """
    start, goal = _near_pose(T_start, "start pose"), _near_pose(T_goal, "goal pose")
    _check_turn(start, goal, "the start and the goal pose")
    screw = screw_of(goal @ inverse_pose(start))
    if screw.is_translation:
        return line_path(start, goal)
    angle, pitch = float(screw.magnitude), float(screw.pitch)
    arm = _arm_from(screw.axis, screw.point, start[:3, 3])
    return _turning_piece(start, screw.axis, arm, angle, pitch, angle * screw.axis)


def arc_path(
    T_start: PoseLike,
    T_goal: PoseLike | None = None,
    *,
    via: ArrayLike | None = None,
    center: ArrayLike | None = None,
    axis: ArrayLike | None = None,
    angle: float | None = None,
    rotation: str | None = None,
) -> CartesianPath:
    """A circular arc of the tip.

    Either from a start to a goal pose (4, 4) through a point `via` (3,) [m], or about an axis: a direction
    (3,) through `center` (3,), by an angle [rad], positive by the right hand; more than a full turn is
    allowed. rotation: "interpolate" between start and goal about a fixed axis (the default with a goal),
    "keep", or "follow", as if fixed to the turning circle (the default about an axis: a valve, a door).

    Points on a line give a line. Raises InputError for arguments that do not fit together, and a via point
    that repeats an end.
    """
    start = _near_pose(T_start, "start pose")
    by_via = T_goal is not None and via is not None and center is axis is angle is None
    by_axis = T_goal is via is None and center is not None and axis is not None and angle is not None
    if by_via:
        how = "interpolate" if rotation is None else rotation
        return _arc_through(start, _near_pose(T_goal, "goal pose"), via, how)  # type: ignore[arg-type]
    if by_axis:
        how = "follow" if rotation is None else rotation
        return _arc_about(start, center, axis, angle, how)  # type: ignore[arg-type]
    raise InputError("an arc needs a goal pose and via=, or else center=, axis= and angle=")


def _arc_about(
    start: Array, center: ArrayLike, axis: ArrayLike, angle: float, rotation: str
) -> CartesianPath:
    if not (isinstance(rotation, str) and rotation in ("keep", "follow")):
        raise InputError(f"rotation is {rotation!r}; about an axis it is 'keep' or 'follow'")
    point = one_array(center, "center", (3,), "a point", largest=FARTHEST_POINT)
    direction = one_array(axis, "axis", (3,), "a direction", largest=FARTHEST)
    size = float(np.linalg.norm(direction))
    if not size > 0.0:
        raise InputError("axis is zero; it needs a direction")
    turn = one_number(angle, "angle", largest=FARTHEST_POINT)
    unit = direction / size
    spin = turn * unit if rotation == "follow" else np.zeros(3)
    return _turning_piece(start, unit, _arm_from(unit, point, start[:3, 3]), turn, 0.0, spin)


def _arc_through(start: Array, goal: Array, via: ArrayLike, rotation: str) -> CartesianPath:
    if not (isinstance(rotation, str) and rotation in ROTATIONS):
        raise InputError(f"rotation is {rotation!r}; expected one of {', '.join(ROTATIONS)}")
    circle = _circle_through(
        start[:3, 3], one_array(via, "via", (3,), "a point", largest=FARTHEST_POINT), goal[:3, 3]
    )
    if circle is None:
        T = np.array(goal)
        if rotation != "interpolate":
            T[:3, :3] = start[:3, :3]
        return line_path(start, T)
    axis, arm, angle = circle
    if rotation == "interpolate":
        _check_turn(start, goal, "the start and the goal pose")
        spin = log_so3(goal[:3, :3] @ start[:3, :3].T)
    else:
        spin = angle * axis if rotation == "follow" else np.zeros(3)
    return _turning_piece(start, axis, arm, angle, 0.0, spin)


def pose_path(
    poses: ArrayLike, *, deviation: float = 0.0, turn_deviation: float | None = None
) -> CartesianPath:
    """Straight lines of the tip through poses, their corners blended.

    poses (n, 4, 4): T_base_tip. deviation [m]: a blend passes its corner within so much, and within half of
    each leg; zero stops at each corner. turn_deviation [rad]: the same of the rotation, by default as many
    radians as deviation has metres. Blends are quintic Bézier curves of the point and of the rotation vector
    at the corner, so that the second derivative is continuous; where the path turns back it stops.

    Raises InputError for fewer than two different poses, and neighbours 180° apart.
    """
    T = as_pose(poses, "poses")
    as_floats(T[..., :3, 3], "the position of poses", largest=FARTHEST_POINT)
    if T.ndim != 3 or len(T) < 2:
        raise InputError(f"poses has shape {T.shape}, expected (n, 4, 4) with n of at least 2")
    miss = bounded_number(deviation, "deviation", 0.0, "it must not be negative")
    turn_miss = miss if turn_deviation is None else turn_deviation
    legs = _Legs(T)
    cut = legs.cut_corners(miss, bounded_number(turn_miss, "turn_deviation", 0.0, "it must not be negative"))
    pieces: list[CartesianPiece] = []
    stops: list[float] = []
    s = 0.0
    for k in range(legs.count):
        begin, end = cut[k], legs.lengths[k] - cut[k + 1]
        if end - begin > REPEATED_POSE:  # else blends meet
            pieces.append(legs.make_line(k, begin, end))
            s += end - begin
        if k + 1 < legs.count:
            if cut[k + 1] > 0.0:
                pieces.append(legs.make_blend(k, cut[k + 1]))
                s += pieces[-1].length
            elif legs.changes[k] > SMOOTH_CORNER:
                stops.append(s)
    return CartesianPath(pieces, stops)


def _near_pose(T: PoseLike, subject: str) -> Array:
    """A pose (4, 4); InputError for one that is too far from the base."""
    pose = one_pose(T, subject)
    as_floats(pose[:3, 3], f"the position of the {subject}", largest=FARTHEST_POINT)
    return pose


def is_repeated(T: Array, other: Array) -> bool:
    """Whether two poses (4, 4) are the same to rounding, so that nothing moves from one to the other."""
    return bool(np.abs(_step_between(T, other)).max() <= REPEATED_POSE)


def _step_between(T: Array, other: Array) -> Array:
    """Displacement and rotation vector (6,) from one pose to another, in base axes."""
    return np.concatenate([other[:3, 3] - T[:3, 3], log_so3(other[:3, :3] @ T[:3, :3].T)])


class _Legs:
    """The straight lines between different poses: directions (count, 6) per unit of s, and lengths."""

    def __init__(self, T: Array) -> None:
        rows = [0]
        steps: list[Array] = []
        for k in range(1, len(T)):
            last = T[rows[-1]]
            _check_turn(last, T[k], f"poses {rows[-1]} and {k}")
            step = _step_between(last, T[k])
            if np.abs(step).max() > REPEATED_POSE:
                rows.append(k)
                steps.append(step)
        if not steps:
            raise InputError("all poses are the same; a path needs two different ones")
        self.T: Array = T[rows]
        step_rows = np.array(steps)
        sizes = np.linalg.norm(step_rows.reshape(-1, 2, 3), axis=2)
        self.lengths: Array = sizes.max(axis=1)
        self.directions: Array = step_rows / self.lengths[:, None]
        self.changes: Array = np.linalg.norm(np.diff(self.directions, axis=0), axis=1)
        self.count = len(steps)

    def cut_corners(self, miss: float, turn_miss: float) -> Array:
        """How much of the legs on both sides the blend at each pose replaces (count + 1,); zero for none."""
        cut = np.zeros(self.count + 1)
        for k in range(1, self.count):
            before, after = self.directions[k - 1], self.directions[k]
            if self.changes[k - 1] <= SMOOTH_CORNER or np.linalg.norm(before + after) < REVERSAL:
                continue
            change = np.linalg.norm((after - before).reshape(2, 3), axis=1)
            allowed = [
                d / (BLEND_MISS * c)
                for d, c in zip((miss, turn_miss), change, strict=True)
                if c > SMOOTH_CORNER
            ]
            reach = min(0.5 * self.lengths[k - 1], 0.5 * self.lengths[k], *allowed)
            cut[k] = reach if reach > SHORTEST_BLEND * self.lengths.max() else 0.0
        return cut

    def make_line(self, k: int, begin: float, end: float) -> CartesianPiece:
        """The stretch of leg k between two distances from its first pose."""
        point, turn = np.array(NO_POLYNOMIAL), np.array(NO_POLYNOMIAL)
        velocity, spin = self.directions[k, :3], self.directions[k, 3:]
        point[0], point[1] = self.T[k, :3, 3] + begin * velocity, velocity
        turn[0], turn[1] = begin * spin, spin
        return CartesianPiece(end - begin, point, turn, self.T[k, :3, :3], Z, 0.0, np.zeros(3))

    def make_blend(self, k: int, cut: float) -> CartesianPiece:
        """The blend between leg k and the next, which begins and ends at a distance from their pose."""
        away = cut * np.array([1.0, 1 - BLEND_SPACING, 1 - 2 * BLEND_SPACING])[:, None]
        before, after = self.directions[k], self.directions[k + 1]
        control = np.concatenate([-away * before, away[::-1] * after])
        length = DEGREE * BLEND_SPACING * cut
        power = _power_of_bezier(control) / length ** np.arange(DEGREE + 1)[:, None]
        point, turn = power[:, :3], power[:, 3:]
        point[0] += self.T[k + 1, :3, 3]
        return CartesianPiece(length, point, turn, self.T[k + 1, :3, :3], Z, 0.0, np.zeros(3))


def _power_of_bezier(control: Array) -> Array:
    """The coefficients of 1, u, … of a Bézier curve with control points (degree + 1, m), u from 0 to 1."""
    n = len(control) - 1
    matrix = np.array(
        [
            [comb(n, j) * comb(j, i) * (-1.0) ** (i + j) if i <= j else 0.0 for i in range(n + 1)]
            for j in range(n + 1)
        ]
    )
    return np.asarray(matrix @ control)


def _turning_piece(
    start: Array, axis: Array, arm: Array, angle: float, pitch: float, spin: Array
) -> CartesianPath:
    """The tip on a helix about an axis, while its rotation turns by the vector `spin`.

    arm (3,) [m]: from the nearest point of the axis to the tip at the start.
    """
    size = float(np.linalg.norm(spin))
    length = max(abs(angle) * float(np.hypot(np.linalg.norm(arm), pitch)), size)
    if not length > REPEATED_POSE:
        raise InputError(
            f"the arc or screw has a length of {length:.3g}: the tip moves by no more and turns by {size:.3g}"
            f" rad; one must exceed {REPEATED_POSE:g} m or rad, so give a larger angle or radius, or none"
        )
    way, turn = np.array(NO_POLYNOMIAL), np.array(NO_POLYNOMIAL)
    way[0], way[1] = start[:3, 3], angle * pitch / length * axis
    turn[1] = spin / length
    return CartesianPath([CartesianPiece(length, way, turn, start[:3, :3], axis, angle / length, arm)])


def _arm_from(axis: Array, point: Array, tip: Array) -> Array:
    """The vector to a tip (3,) from the nearest point of an axis through a point (3,)."""
    arm = tip - point
    return np.asarray(arm - (arm @ axis) * axis)


def _circle_through(first: Array, via: Array, last: Array) -> tuple[Array, Array, float] | None:
    """Axis, arm from the centre to the first point, and angle of the arc through three points; None if they
    are on a line.

    The change of direction at the middle point is half the angle of the arc (inscribed angle). The radius and
    the arm follow from it and from the chord, so that the arc ends at the last point even where the centre is
    far away.
    """
    a, b, c = via - first, last - first, last - via
    sizes = np.linalg.norm(a), np.linalg.norm(b), np.linalg.norm(c)
    if sizes[0] <= REPEATED_POSE or sizes[2] <= REPEATED_POSE:
        raise InputError("via is an end of the arc; it must lie between start and goal")
    if sizes[1] <= REPEATED_POSE:
        raise InputError("the goal of the arc is its start; give center=, axis= and angle= for a full circle")
    normal = np.cross(a, c)
    doubled_area, along = float(np.linalg.norm(normal)), float(a @ c)
    if doubled_area <= COLLINEAR_POINTS * sizes[0] * sizes[2]:
        if along < 0.0:
            raise InputError(
                f"via is {sizes[0]:.3g} m from the start and not between start and goal, which lie in one"
                f" direction from it, to {COLLINEAR_POINTS:g} rad; give a point between them, or a nearer one"
            )
        return None
    chord = b / sizes[1]
    for _ in range(2):  # the first leaves the rounding of a normal whose points are nearly on a line
        normal = normal - (normal @ chord) * chord
        normal /= np.linalg.norm(normal)
    half_angle = float(np.arctan2(doubled_area, along))
    sine, cosine = np.sin(half_angle), np.cos(half_angle)
    arm = -(sizes[1] / (2.0 * sine)) * (cosine * np.cross(normal, chord) + sine * chord)
    return normal, arm, 2.0 * half_angle


def _check_turn(first: Array, second: Array, subject: str) -> None:
    angle = float(np.linalg.norm(log_so3(second[:3, :3] @ first[:3, :3].T)))
    if angle > np.pi - NEAR_HALF_TURN:
        raise InputError(
            f"{subject} are 180° apart, so the direction of rotation between them is not unique; insert a"
            " pose between them"
        )
