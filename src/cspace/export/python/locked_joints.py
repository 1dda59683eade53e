"""Locked joints at the ends of the chain move the goal: T' = B^-1 T C^-1.

B is the motion of the locked joints before the others, C that of those behind them, seen from the tip.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.export.python.base import Array, Solutions, inverse, joint_motion


def values_of(locked: npt.ArrayLike, count: int) -> Array:
    """The values of the locked joints."""
    out = np.atleast_1d(np.asarray(locked, dtype=float))
    if out.shape != (count,) or not np.isfinite(out).all():
        raise ValueError(
            f"locked must hold {count} finite value{'s' * (count > 1)}, one for each locked joint"
        )
    return out


def solve_locked(
    solve: Callable[[dict[str, Any], Array, Array], Solutions],
    arm: dict[str, Any],
    whole: dict[str, Any],
    locked_joints: list[int],
    locked: Array,
    T: Array,
    unconstrained: Array,
) -> Solutions:
    """Every configuration with the locked joints at their values; solve, arm: of the joints that move."""
    n = len(whole["axes"])
    moving = [i for i in range(n) if i not in locked_joints]
    values = zip(locked_joints, locked, strict=True)
    motion = {i: joint_motion(whole, i, float(value)) for i, value in values}
    before, behind = np.eye(4), np.eye(4)
    for i in locked_joints:
        if i < moving[0]:
            before = before @ motion[i]
        else:
            behind = behind @ motion[i]
    tip = whole["T_zero"]
    T = inverse(before) @ T @ inverse(tip) @ inverse(behind) @ tip
    found = solve(arm, T, unconstrained[moving])
    q = np.empty((len(found), n))
    q[:, moving], q[:, locked_joints] = found.q, locked
    return Solutions(q, found.status, found.self_motion, found.complete)
