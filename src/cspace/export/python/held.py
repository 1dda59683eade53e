"""Locked joints at the ends of the chain move the goal: T' = B^-1 T C^-1.

B is the motion of the locked joints before the others, C that of those behind them, seen from the tip.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.export.python.base import Array, Solutions, inverse, joint_motion

__all__ = ["solve_held", "values_of"]


def values_of(fixed: npt.ArrayLike, count: int) -> Array:
    """The values of the held joints."""
    out = np.atleast_1d(np.asarray(fixed, dtype=float))
    if out.shape != (count,) or not np.isfinite(out).all():
        raise ValueError(f"fixed must hold {count} finite value{'s' * (count > 1)}, one for each held joint")
    return out


def solve_held(
    solve: Callable[[dict[str, Any], Array, Array], Solutions],
    arm: dict[str, Any],
    whole: dict[str, Any],
    held: list[int],
    fixed: Array,
    T: Array,
    idle: Array,
) -> Solutions:
    """Every configuration with the locked joints at their values; solve, arm: of the joints that move."""
    n = len(whole["axes"])
    moving = [i for i in range(n) if i not in held]
    values = zip(held, fixed, strict=True)
    motion = {i: joint_motion(whole, i, float(value)) for i, value in values}
    before, behind = np.eye(4), np.eye(4)
    for i in held:
        if i < moving[0]:
            before = before @ motion[i]
        else:
            behind = behind @ motion[i]
    tip = whole["T_zero"]
    T = inverse(before) @ T @ inverse(tip) @ inverse(behind) @ tip
    found = solve(arm, T, idle[moving])
    q = np.empty((len(found), n))
    q[:, moving], q[:, held] = found.q, fixed
    return Solutions(q, found.status, found.family, found.complete)
