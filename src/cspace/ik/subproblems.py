"""The six geometric subproblems from which closed-form inverse kinematics is built.

Each asks for the angles of one, two or three rotations that satisfy one small geometric condition. The first
three are the classical ones of Paden and Kahan; the numbering 1 to 6 is that of Elias & Wen.

    1  turn one point onto another              Rot(k, θ) p1 = p2                                  one answer
    2  turn two points until they meet          Rot(k1, θ1) p1 = Rot(k2, θ2) p2                    ≤ 2
    3  turn a point to a given distance         ‖Rot(k, θ) p1 − p2‖ = d                            ≤ 2
    4  turn a point into a plane                hᵀ Rot(k, θ) p = d                                 ≤ 2
    5  three turns, one meeting point           p0 + Rot(k1, θ1) p1
                                                  = p2 + Rot(k2, θ2) (p3 + Rot(k3, θ3) p4)         ≤ 4
    6  two planes, two angles                   h1ᵀ Rot(k1, θ1) p1 + h2ᵀ Rot(k2, θ2) p2 = d1,
                                                h3ᵀ Rot(k3, θ1) p3 + h4ᵀ Rot(k4, θ2) p4 = d2       ≤ 4

Rot(k, θ) is the rotation about the axis k through the origin. Points (..., 3) and lengths share one unit,
angles are in radians in (−π, π], axes may have any length above zero. Leading axes are batches and
broadcast. Where no exact answer exists the least-squares answer is given, marked as such; where a whole
curve of answers exists one of it is given, marked as such.

Sources: Paden 1986, §4.3; Kahan 1983; Elias & Wen 2022, §3. The proofs stand in the headers of
include/cspace/ik/subproblems.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.kinematics.batch import broadcast_rows
from cspace.tolerances import FARTHEST


@dataclass(frozen=True, eq=False)
class SubproblemSolution:
    """All solutions of a subproblem (or of a batch of them); true if every problem has an exact solution.

    theta: (..., k) angles [rad] of up to k solutions, or (..., k, m) for solutions of m angles; NaN beyond
        count.
    count: (...) the number of solutions. Without an exact one it is 1, the least-squares solution.
    exact: (...) whether the solutions satisfy the equation, to 1e-12 of the lengths in it.
    free: (...) whether there are infinitely many solutions, which theta represents (an arbitrary angle is 0).
    residual: (...) the error of the equation, in its unit.
    """

    theta: Array
    count: npt.NDArray[np.int32]
    exact: npt.NDArray[np.bool_]
    free: npt.NDArray[np.bool_]
    residual: Array

    def __bool__(self) -> bool:
        return bool(np.all(self.exact))

    @property
    def reason(self) -> str:
        """The number of solutions, or the error of the least-squares solution, as one sentence."""
        missed = np.size(self.exact) - np.count_nonzero(self.exact)
        if np.ndim(self.exact):
            return f"{np.size(self.exact) - missed} of {np.size(self.exact)} problems have exact solutions"
        if missed:
            return f"no exact solution: the least-squares solution has the error {float(self.residual):.3g}"
        if self.free:
            return "infinitely many solutions; one of them is given"
        return "one solution" if self.count == 1 else f"{int(self.count)} solutions"


def axis_rows(value: Any, subject: str, shape: tuple[int, ...]) -> Array:
    """Axes (..., 3) brought to length one. Raises InputError on an axis of length zero."""
    axes = as_floats(value, subject, last=shape)
    largest = np.abs(axes).max(axis=-1, keepdims=True)
    if not np.all(largest > 0):
        raise InputError(
            f"{subject} is a vector of length zero, which has no direction; give any other vector"
        )
    directions: Array = axes / largest
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return directions


def read_amounts(value: Any, subject: str, shape: tuple[int, ...]) -> Array:
    """Points, normals and lengths (..., *shape), small enough that no product of them overflows."""
    return as_floats(value, subject, last=shape, largest=FARTHEST)


def call_kernel(
    kernel: Callable[..., None],
    most: int,
    angles: int,
    given: dict[str, Any],
    vectors: tuple[int, ...] = (3,),
    numbers: tuple[int, ...] = (),
) -> SubproblemSolution:
    """Calls a kernel on broadcast arguments: k, k1, … are axes, d holds numbers, all others are vectors.

    vectors, numbers: their shapes in one problem.
    """
    own = {name: numbers if name == "d" else vectors for name in given}
    read = {name: axis_rows if name.startswith("k") else read_amounts for name in given}
    arrays = {name: (read[name](v, name, own[name]), len(own[name])) for name, v in given.items()}
    batch, rows = broadcast_rows(arrays)
    n = math.prod(batch)
    theta = np.empty((n, most, angles))
    residual, count = np.empty(n), np.empty(n, dtype=np.int32)
    exact, free = np.empty(n, dtype=np.bool_), np.empty(n, dtype=np.bool_)
    kernel(*rows.values(), theta, residual, count, exact, free)
    shape = (*batch, most) if angles == 1 else (*batch, most, angles)
    facts: Any = (fact.reshape(batch)[()] for fact in (count, exact, free, residual))
    return SubproblemSolution(theta.reshape(shape), *facts)


def subproblem_1(k: Any, p1: Any, p2: Any) -> SubproblemSolution:
    """The angle that turns p1 onto p2, or as near as it comes: min ‖Rot(k, θ) p1 − p2‖.

    k (..., 3) axis; p1, p2 (..., 3) points; theta (..., 1). Exact if both have the same height along the axis
    and the same distance from it; free if one of them lies on the axis.
    Source: Paden 1986, §4.3; Elias & Wen 2022, §3.1.
    """
    return call_kernel(_core.subproblem_1, 1, 1, {"k": k, "p1": p1, "p2": p2})


def subproblem_2(k1: Any, k2: Any, p1: Any, p2: Any) -> SubproblemSolution:
    """The angles that make two turned points meet: min ‖Rot(k1, θ1) p1 − Rot(k2, θ2) p2‖.

    k1, k2 (..., 3) axes; p1, p2 (..., 3) points; theta (..., 2, 2), an answer being (θ1, θ2). Exact if the
    points have the same distance from the origin and their circles meet: twice, or once where they touch.
    Free if the axes are parallel (θ2 = 0 is given) or a point lies on its axis.
    Source: Paden 1986, §4.3; Elias & Wen 2022, §3.2.
    """
    return call_kernel(_core.subproblem_2, 2, 2, {"k1": k1, "k2": k2, "p1": p1, "p2": p2})


def subproblem_3(k: Any, p1: Any, p2: Any, d: Any) -> SubproblemSolution:
    """The angles that turn p1 to the distance d from p2: min | ‖Rot(k, θ) p1 − p2‖ − d |.

    k (..., 3) axis; p1, p2 (..., 3) points; d (...) distance ≥ 0; theta (..., 2). Exact if d lies between the
    smallest and the largest distance of p2 from the circle of p1; free if either point lies on the axis.
    Source: Paden 1986, §4.3; Elias & Wen 2022, §3.3.
    """
    distance = read_amounts(d, "d", ())
    if np.any(distance < 0):
        raise InputError(f"d is {float(distance.min())}; a distance must be 0 or more")
    return call_kernel(_core.subproblem_3, 2, 1, {"k": k, "p1": p1, "p2": p2, "d": distance})


def subproblem_4(h: Any, k: Any, p: Any, d: Any) -> SubproblemSolution:
    """The angles that turn p into the plane hᵀ x = d: min |hᵀ Rot(k, θ) p − d|.

    h (..., 3) normal of the plane, of any length; k (..., 3) axis; p (..., 3) point; d (...) in units of
    ‖h‖ times length; theta (..., 2). Exact if the plane cuts the circle of p; free if the plane is
    perpendicular to the axis or p lies on the axis. Source: Elias & Wen 2022, §3.4.
    """
    return call_kernel(_core.subproblem_4, 2, 1, {"h": h, "k": k, "p": p, "d": d})


def subproblem_5(
    p0: Any, p1: Any, p2: Any, p3: Any, p4: Any, k1: Any, k2: Any, k3: Any
) -> SubproblemSolution:
    """The three angles with p0 + Rot(k1, θ1) p1 = p2 + Rot(k2, θ2) (p3 + Rot(k3, θ3) p4), or the least gap.

    p0 … p4 (..., 3) points; k1, k2, k3 (..., 3) axes; theta (..., 4, 3). At most four answers.
    Source: Elias & Wen 2022, §3.5.
    """

    def kernel(*rows: Any) -> None:
        _core.subproblem_5(np.stack(rows[:5], axis=1), np.stack(rows[5:8], axis=1), *rows[8:])

    given = {"p0": p0, "p1": p1, "p2": p2, "p3": p3, "p4": p4, "k1": k1, "k2": k2, "k3": k3}
    return call_kernel(kernel, 4, 3, given)


def subproblem_6(h: Any, k: Any, p: Any, d: Any) -> SubproblemSolution:
    """The two angles that satisfy two equations, or leave the shortest vector of residuals.

        h[0]ᵀ Rot(k[0], θ1) p[0] + h[1]ᵀ Rot(k[1], θ2) p[1] = d[0]
        h[2]ᵀ Rot(k[2], θ1) p[2] + h[3]ᵀ Rot(k[3], θ2) p[3] = d[1]

    h, k, p (..., 4, 3) normals of any length, axes, points; d (..., 2); theta (..., 4, 2). At most four
    answers.
    Source: Elias & Wen 2022, §3.6.
    """
    return call_kernel(_core.subproblem_6, 4, 2, {"h": h, "k": k, "p": p, "d": d}, (4, 3), (2,))


def paden_kahan_1(axis: Any, p: Any, q: Any, *, point: Any = (0.0, 0.0, 0.0)) -> SubproblemSolution:
    """Paden–Kahan I, rotation about one axis: e^(ξθ) p = q for the axis through `point`.

    axis (..., 3) direction; p, q, point (..., 3); theta (..., 1). Subproblem 1 seen from `point`.
    Source: Murray, Li & Sastry 1994, §3.2.
    """
    return subproblem_1(axis, from_point(p, "p", point), from_point(q, "q", point))


def paden_kahan_2(
    axis1: Any, axis2: Any, p: Any, q: Any, *, point: Any = (0.0, 0.0, 0.0)
) -> SubproblemSolution:
    """Paden–Kahan II, rotation about two subsequent axes: e^(ξ1θ1) e^(ξ2θ2) p = q, axes crossing in `point`.

    axis1, axis2 (..., 3) directions; p, q, point (..., 3); theta (..., 2, 2), an answer being (θ1, θ2).
    Subproblem 2: p turned by θ2 about axis2 meets q turned back by θ1 about axis1.
    Source: Murray, Li & Sastry 1994, §3.2.
    """
    p_point, q_point = from_point(p, "p", point), from_point(q, "q", point)
    return subproblem_2(-as_floats(axis1, "axis1", last=(3,)), axis2, q_point, p_point)


def paden_kahan_3(
    axis: Any, p: Any, q: Any, distance: Any, *, point: Any = (0.0, 0.0, 0.0)
) -> SubproblemSolution:
    """Paden–Kahan III, rotation to a given distance: ‖e^(ξθ) p − q‖ = δ for the axis through `point`.

    axis (..., 3) direction; p, q, point (..., 3); distance (...) δ ≥ 0; theta (..., 2). Subproblem 3 seen
    from `point`.
    Source: Murray, Li & Sastry 1994, §3.2.
    """
    return subproblem_3(axis, from_point(p, "p", point), from_point(q, "q", point), distance)


def from_point(value: Any, subject: str, point: Any) -> Array:
    """The vector (..., 3) from `point` to `value`."""
    return read_amounts(value, subject, (3,)) - read_amounts(point, "point", (3,))
