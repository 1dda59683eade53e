"""Multiples of 2π of revolute joints: the same pose, other joint values.

q: (k, dof) configurations; kinds: one "R" or "P" per joint; lower, upper: (dof,) limits, infinite where
absent.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.math.wrapping import TURN, count_turns, turns_within, wrap_above, wrap_angle
from cspace.tolerances import MOST_WINDINGS, ON_LIMIT

Flags = npt.NDArray[np.bool_]


def revolute_joints(kinds: Sequence[str]) -> Flags:
    """Which joints turn, (dof,)."""
    return np.array([kind == "R" for kind in kinds], dtype=bool)


def short_way(gap: Array, kinds: Sequence[str]) -> Array:
    """Differences (..., dof) of configurations, those of revolute joints the short way round."""
    return np.where(revolute_joints(kinds), wrap_angle(gap), gap)


def wrap_joints(q: Array, kinds: Sequence[str]) -> Array:
    """Revolute joints in (−π, π]."""
    outside = revolute_joints(kinds) & ((q > np.pi) | (q <= -np.pi))
    return np.where(outside, wrap_angle(q), q)


def copies_inside(q: Array, turns: Flags, lower: Array, upper: Array, wanted: Array, slack: float) -> Array:
    """Each joint value moved by a multiple of 2π, as near to `wanted` turns as the limits allow or `wanted`
    where no multiple is inside; a value beyond a limit by `slack` or less is set to it. All (n,) or alike.
    """
    least, most = turns_within(q, q, lower - slack, upper + slack)
    taken = np.where(least <= most, np.clip(wanted, least, most), wanted)
    moved = q + np.where(turns, TURN * taken, 0.0)
    inside = np.clip(moved, lower, upper)
    return np.asarray(np.where(np.abs(moved - inside) <= slack, inside, moved))


def nearest_winding(q: Array, seed: Array, kinds: Sequence[str], lower: Array, upper: Array) -> Array:
    """Each revolute joint moved by the multiple of 2π that brings it closest to the seed, of those that bring
    it inside its limits if there are any; a joint that rounding takes past a limit is set to it.
    """
    wanted = count_turns(seed - q)
    return copies_inside(q, revolute_joints(kinds), lower, upper, wanted, ON_LIMIT)


def into_limits(
    q: Array, kinds: Sequence[str], lower: Array, upper: Array, slack: float = ON_LIMIT
) -> tuple[Array, Flags]:
    """Each revolute joint moved by the least multiple of 2π that brings it inside its limits, a joint beyond
    a limit by `slack` or less set to it; per row whether all joints are inside.
    """
    moved = q.copy()
    out = np.nonzero((q < lower) | (q > upper))
    joint = out[-1]
    turns = revolute_joints(kinds)[joint]
    moved[out] = copies_inside(q[out], turns, lower[joint], upper[joint], np.zeros(len(joint)), slack)
    return moved, np.asarray(((moved >= lower) & (moved <= upper)).all(axis=-1))


def measure_violations(
    q: Array, kinds: Sequence[str], lower: Array, upper: Array, slack: float = ON_LIMIT
) -> Array:
    """The distance of each joint from its limits over all multiples of 2π, (k, dof), zero up to `slack`."""
    moved, _ = into_limits(q, kinds, lower, upper, slack)
    excess = np.zeros_like(moved)
    out = np.nonzero((moved < lower) | (moved > upper))
    joint = out[-1]
    below, above = lower[joint] - q[out], q[out] - upper[joint]
    with np.errstate(invalid="ignore"):  # of a limit at infinity, which is not the one that is broken
        around = np.fmin(wrap_above(below, 0.0), wrap_above(above, 0.0))
    excess[out] = np.where(revolute_joints(kinds)[joint], around, np.maximum(below, above))
    return excess


def all_windings(
    q: Array, kinds: Sequence[str], lower: Array, upper: Array
) -> tuple[npt.NDArray[np.intp], Array]:
    """Every combination of multiples of 2π inside the limits: the row each comes from, and the
    configurations.

    A joint without limits is kept in (−π, π], one with a limit on one side as near to it as the limit lets
    it: it has infinitely many copies. Raises InputError for more than tolerances.MOST_WINDINGS of them.
    """
    rows: list[int] = []
    out: list[Array] = []
    for row, configuration in enumerate(q):
        turns = [
            joint_windings(angle, kind, lo, hi)
            for angle, kind, lo, hi in zip(configuration, kinds, lower, upper, strict=True)
        ]
        if math.prod(count for _, count in turns) + len(out) > MOST_WINDINGS:
            raise InputError(
                f"the limits contain more than {MOST_WINDINGS} copies of the solutions by multiples of 2π; "
                "narrow them, or leave out windings=True"
            )
        choices = [[first + TURN * k for k in range(count)] for first, count in turns]
        for combination in itertools.product(*choices):
            rows.append(row)
            out.append(np.clip(combination, lower, upper))
    return np.array(rows, dtype=np.intp), np.array(out).reshape(len(out), q.shape[1])


def joint_windings(angle: float, kind: str, lower: float, upper: float) -> tuple[float, int]:
    """The lowest copy of an angle inside its limits, up to rounding, and how many follow a turn apart."""
    lower, upper = lower - ON_LIMIT, upper + ON_LIMIT
    if kind == "P":
        return angle, int(lower <= angle <= upper)
    least, most = turns_within(angle, angle, lower, upper)
    if least > most:
        return angle, 0
    if not np.isfinite(most - least):
        return angle + TURN * float(np.clip(0.0, least, most)), 1
    return angle + TURN * float(least), int(most - least) + 1
