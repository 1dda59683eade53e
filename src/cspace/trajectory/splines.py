"""Splines: smooth paths through waypoints, and near control points."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, positive_number, whole_number
from cspace.errors import InputError, check_known
from cspace.tables import count_things
from cspace.tolerances import FARTHEST_WAYPOINT
from cspace.trajectory.path import HIGHEST_DEGREE, Path, hermite_quintics
from cspace.trajectory.waypoints import read_waypoints

SPACINGS: Final = {"chord": 1.0, "centripetal": 0.5}
"""How the parameter grows between waypoints: by a power of their distance."""

ENDS: Final = ("natural", "clamped")
"""What a spline does at its ends."""

DEGREES: Final = (3, 5)
"""Of the splines through waypoints."""


def spline(waypoints: ArrayLike, degree: int = 3, *, ends: str = "natural", spacing: str = "chord") -> Path:
    """The spline through waypoints: cubic with continuous q'', or quintic with continuous q''''.

    waypoints (k, dof) [rad or m]. ends: "natural" with q'' = 0 (and q'''' = 0 of quintic ones), or "clamped"
    with q' = 0 (and q'' = 0). spacing: the parameter grows by the distance of the waypoints ("chord") or by
    its root ("centripetal"), which overshoots less. Waypoints that are the same as the one before are merged.

    Returns a Path; its `excursion` is how far each joint overshoots. Raises InputError for a wrong shape,
    NaN, waypoints that are all the same and another degree, UnknownNameError for other ends or spacings.
    Source: de Boor 1978, chapters IV and XIII; Lee 1989 for the spacing.
    """
    if not (isinstance(degree, int) and degree in DEGREES):
        raise InputError(f"degree is {degree!r}; splines have degree 3 or 5")
    check_known("end condition", ends, ENDS)
    check_known("spacing", spacing, SPACINGS)
    given = read_waypoints(waypoints)
    h = given.distances ** SPACINGS[spacing]
    h *= given.distances.sum() / h.sum()
    breaks = np.concatenate([[0.0], np.cumsum(h)])
    if (np.diff(breaks) <= 0.0).any():
        raise InputError("the waypoints lie too close together, relative to the length of the path")
    h = np.diff(breaks)
    made = _cubic_controls(h, given.q, ends) if degree == 3 else quintic_controls(h, given.q, ends)
    return Path(breaks, made, remarks=given.remarks)


def _cubic_controls(h: Array, q: Array, ends: str) -> Array:
    """Control points (k, 4, dof) of the cubic spline, from its slopes at the waypoints."""
    n = len(q)
    lower, diagonal, upper = np.zeros(n), np.zeros(n), np.zeros(n)
    right = np.zeros_like(q)
    rise = np.diff(q, axis=0) / h[:, None]
    lower[1:-1], upper[1:-1] = 1.0 / h[:-1], 1.0 / h[1:]
    diagonal[1:-1] = 2.0 * (lower[1:-1] + upper[1:-1])
    right[1:-1] = 3.0 * (rise[:-1] / h[:-1, None] + rise[1:] / h[1:, None])
    if ends == "natural":
        diagonal[[0, -1]], upper[0], lower[-1] = 2.0, 1.0, 1.0
        right[0], right[-1] = 3.0 * rise[0], 3.0 * rise[-1]
    else:
        diagonal[[0, -1]] = 1.0
    slopes = solve_block_tridiagonal(
        lower[:, None, None], diagonal[:, None, None], upper[:, None, None], right[:, None, :]
    )[:, 0]
    third = h[:, None] / 3.0
    control = [q[:-1], q[:-1] + third * slopes[:-1], q[1:] - third * slopes[1:], q[1:]]
    return np.stack(control, axis=1)


def quintic_controls(h: Array, q: Array, ends: str) -> Array:
    """Control points (k, 6, dof) of the quintic spline, from its slopes v and bends a at the waypoints.

    With p = h v and w = h² a, on a piece h³ q''' is 60Δ − 36p₀ − 24p₁ − 9w₀ + 3w₁ at its begin and
    60Δ − 24p₀ − 36p₁ − 3w₀ + 9w₁ at its end; h⁴ q'''' is −360Δ + 192p₀ + 168p₁ + 36w₀ − 24w₁ and
    360Δ − 168p₀ − 192p₁ − 24w₀ + 36w₁. The two rows of a waypoint are equal third and fourth derivatives.
    """
    n = len(q)
    lower, diagonal, upper = np.zeros((n, 2, 2)), np.zeros((n, 2, 2)), np.zeros((n, 2, 2))
    right = np.zeros((n, 2, q.shape[1]))
    step = np.diff(q, axis=0)
    # Coefficients (k, order, side, v or a) of h³ q''' and h⁴ q'''' in (v, a) at the two ends.
    units = np.stack([h, h * h], axis=-1)[:, None, None]
    begin = np.array([[[-36.0, -9.0], [-24.0, 3.0]], [[192.0, 36.0], [168.0, -24.0]]]) * units
    end = np.array([[[-24.0, -3.0], [-36.0, 9.0]], [[-168.0, -24.0], [-192.0, 36.0]]]) * units
    scale = 1.0 / np.stack([h**3, h**4], axis=-1)
    begin, end = begin * scale[:, :, None, None], end * scale[:, :, None, None]
    begin_step = np.array([60.0, -360.0]) * scale
    end_step = np.array([60.0, 360.0]) * scale
    # Rows are scaled by the powers of the shorter neighbour, so that all are of one size.
    near = np.minimum(h[:-1], h[1:])
    weight = np.stack([near**2, near**3], axis=-1)[:, :, None]
    lower[1:-1] = end[:-1, :, 0] * weight
    diagonal[1:-1] = (end[:-1, :, 1] - begin[1:, :, 0]) * weight
    upper[1:-1] = -begin[1:, :, 1] * weight
    right[1:-1] = weight * (
        begin_step[1:, :, None] * step[1:, None] - end_step[:-1, :, None] * step[:-1, None]
    )
    diagonal[[0, -1], 1, 1] = 1.0  # a = 0 in the second row of both ends
    if ends == "natural":
        diagonal[0, 0], upper[0, 0] = begin[0, 1, 0] * h[0] ** 3, begin[0, 1, 1] * h[0] ** 3
        lower[-1, 0], diagonal[-1, 0] = end[-1, 1, 0] * h[-1] ** 3, end[-1, 1, 1] * h[-1] ** 3
        right[0, 0] = -begin_step[0, 1] * h[0] ** 3 * step[0]
        right[-1, 0] = -end_step[-1, 1] * h[-1] ** 3 * step[-1]
    else:
        diagonal[[0, -1], 0, 0] = 1.0
    solved = solve_block_tridiagonal(lower, diagonal, upper, right)
    return hermite_quintics(h, q, solved[:, 0], solved[:, 1])


def solve_block_tridiagonal(lower: Array, diagonal: Array, upper: Array, right: Array) -> Array:
    """The solution (n, m, k) of a block-tridiagonal system, by elimination from the first block on.

    lower, diagonal, upper (n, m, m): the blocks before, on and after the diagonal; right (n, m, k).
    """
    n, m = diagonal.shape[:2]
    rows = np.empty((n, m, m + right.shape[2]))  # of each: upper and right, both reduced
    rows[0] = np.linalg.solve(diagonal[0], np.concatenate([upper[0], right[0]], axis=1))
    for i in range(1, n):
        reduced = diagonal[i] - lower[i] @ rows[i - 1, :, :m]
        known = right[i] - lower[i] @ rows[i - 1, :, m:]
        rows[i] = np.linalg.solve(reduced, np.concatenate([upper[i], known], axis=1))
    for i in range(n - 2, -1, -1):
        rows[i, :, m:] -= rows[i, :, :m] @ rows[i + 1, :, m:]
    return rows[:, :, m:]


def b_spline(control_points: ArrayLike, degree: int = 3, *, length: float | None = None) -> Path:
    """The B-spline with equal knots that begins at the first and ends at the last control point.

    control_points (k, dof) [rad or m], k > degree; the path stays within their hull and passes near them.
    degree: 1 to 5. length: of the parameter, by default that of the polyline through the control points. Of
    a point that is repeated, degree − 1 copies count: with more, the path would stand there.

    Returns a Path. Raises InputError for a wrong shape, NaN, too few points and another degree.
    Source: de Boor 1978, chapter X.
    """
    degree = whole_number(degree, "degree", 1, HIGHEST_DEGREE)
    q = as_floats(control_points, "control_points", largest=FARTHEST_WAYPOINT)
    if q.ndim != 2 or len(q) <= degree or q.shape[1] == 0:
        raise InputError(
            f"control_points has shape {q.shape}; a B-spline of degree {degree} needs"
            f" {count_things(degree + 1, 'point')} or more"
        )
    q = _limit_copies(q, max(1, degree - 1))
    if len(q) <= degree:  # copies that do not count, or points that are all the same
        degree = len(q) - 1
    if not degree:
        raise InputError("the control points are all the same; a path needs two that differ")
    polyline = float(np.linalg.norm(np.diff(q, axis=0), axis=1).sum())
    whole = polyline if length is None else positive_number(length, "length")
    if not whole > 0.0:
        raise InputError("the control points are all the same; a path needs two that differ")
    pieces = len(q) - degree
    inner = np.arange(pieces + 1.0)
    knots = np.concatenate([np.zeros(degree), inner, np.full(degree, float(pieces))])
    controls = np.stack(
        [
            [
                _blossom(q, knots, k, [inner[k]] * (degree - j) + [inner[k + 1]] * j, degree)
                for k in range(pieces)
            ]
            for j in range(degree + 1)
        ],
        axis=1,
    )
    return Path(inner * (whole / pieces), controls)


def _limit_copies(q: Array, most: int) -> Array:
    """Points (k, dof) without those that are the same as so many before."""
    same = np.append(False, (np.diff(q, axis=0) == 0.0).all(axis=1))
    since = np.arange(len(q)) - np.maximum.accumulate(np.where(same, 0, np.arange(len(q))))
    return np.asarray(q[since < most])


def _blossom(q: Array, knots: Array, piece: int, arguments: list[float], degree: int) -> Array:
    """The polar form of one piece of a B-spline, by de Boor's recursion with one argument per level."""
    points = list(q[piece : piece + degree + 1])
    for level, t in enumerate(arguments, 1):
        for i in range(degree - level + 1):
            low, high = knots[piece + i + level], knots[piece + i + degree + 1]
            share = (t - low) / (high - low)
            points[i] = (1.0 - share) * points[i] + share * points[i + 1]
    return np.array(points[0])
