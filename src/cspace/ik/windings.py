"""Whole turns of revolute joints: the same pose, other numbers.

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
from cspace.tolerances import MOST_WINDINGS

__all__ = ["all_windings", "into_limits", "nearest_winding", "short_way", "turning", "violations", "wrap"]

Flags = npt.NDArray[np.bool_]
TURN = 2 * np.pi
ON_LIMIT = 1e-9
"""By how much [rad] a whole turn may take a joint past its limit: rounding."""


def turning(kinds: Sequence[str]) -> Flags:
    """Which joints turn, (dof,)."""
    return np.array([kind == "R" for kind in kinds], dtype=bool)


def short_way(gap: Array, kinds: Sequence[str]) -> Array:
    """Differences (..., dof) of configurations, those of turning joints the short way round."""
    return np.where(turning(kinds), np.pi - np.mod(np.pi - gap, TURN), gap)


def turns_of(kinds: Sequence[str]) -> Array:
    """2π for a revolute joint, 0 for a prismatic one."""
    return np.array([TURN if kind == "R" else 0.0 for kind in kinds])


def wrap(q: Array, kinds: Sequence[str]) -> Array:
    """Revolute joints in (−π, π]."""
    turn = turns_of(kinds)
    outside = (turn > 0) & ((q > np.pi) | (q <= -np.pi))
    return np.where(outside, np.pi - np.mod(np.pi - q, TURN), q)


def fewest_turns(q: Array, kinds: Sequence[str], lower: Array, upper: Array, wanted: Array) -> Array:
    """The whole number of turns nearest to `wanted` that brings each joint inside; `wanted` where none
    does.
    """
    with np.errstate(invalid="ignore"):
        least, most = np.ceil((lower - q) / TURN), np.floor((upper - q) / TURN)
    turns = np.where(least <= most, np.clip(wanted, least, most), wanted)
    return np.asarray(np.where(turns_of(kinds) > 0, turns, 0.0))


def into_limits(q: Array, kinds: Sequence[str], lower: Array, upper: Array) -> tuple[Array, Flags]:
    """Each joint moved by the fewest whole turns that bring it inside; per row whether all joints are
    inside.
    """
    moved = q + TURN * fewest_turns(q, kinds, lower, upper, np.zeros_like(q))
    fits = (moved >= lower) & (moved <= upper)
    return moved, np.asarray(fits.all(axis=-1))


def violations(q: Array, kinds: Sequence[str], lower: Array, upper: Array) -> Array:
    """By how much each joint stays outside its limits whatever turn is taken, (k, dof), zero where inside."""
    turn = turns_of(kinds)
    span = np.where(np.isfinite(upper - lower), upper - lower, np.inf)
    below, above = lower - q, q - upper
    outside = np.maximum(np.maximum(below, above), 0.0)
    # A revolute joint outside sits in the gap of the circle between upper and lower + 2π.
    with np.errstate(invalid="ignore"):
        past_upper = np.mod(q - upper, TURN)
        to_lower = np.mod(lower - q, TURN)
        around = np.where(np.mod(q - lower, TURN) <= span, 0.0, np.minimum(past_upper, to_lower))
    return np.where(turn > 0, np.where(outside > 0, around, 0.0), outside)


def nearest_winding(q: Array, seed: Array, kinds: Sequence[str], lower: Array, upper: Array) -> Array:
    """Each revolute joint by the turn that brings it closest to the seed, inside its limits if one is; on a
    limit that rounding takes it past.
    """
    wanted = np.round((seed - q) / TURN)
    moved = q + TURN * fewest_turns(q, kinds, lower - ON_LIMIT, upper + ON_LIMIT, wanted)
    inside = np.clip(moved, lower, upper)
    on_limit = turning(kinds) & (np.abs(moved - inside) <= ON_LIMIT)
    return np.asarray(np.where(on_limit, inside, moved))


def all_windings(
    q: Array, kinds: Sequence[str], lower: Array, upper: Array
) -> tuple[npt.NDArray[np.intp], Array]:
    """Every combination of whole turns inside the limits: the row each comes from, and the configurations.

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
                f"the limits leave room for more than {MOST_WINDINGS} whole-turn copies of the solutions; "
                "narrow them, or leave out windings=True"
            )
        choices = [[first + TURN * k for k in range(count)] for first, count in turns]
        for combination in itertools.product(*choices):
            rows.append(row)
            out.append(np.array(combination))
    return np.array(rows, dtype=np.intp), np.array(out).reshape(len(out), q.shape[1])


def joint_windings(angle: float, kind: str, lower: float, upper: float) -> tuple[float, int]:
    """The lowest copy of an angle inside its limits, and how many follow a turn apart."""
    if kind == "P":
        return angle, int(lower <= angle <= upper)
    least, most = np.ceil((lower - angle) / TURN), np.floor((upper - angle) / TURN)
    if least > most:
        return angle, 0
    if not np.isfinite(most - least):
        return angle + TURN * float(np.clip(0.0, least, most)), 1
    return angle + TURN * float(least), int(most - least) + 1
