"""Some joints stand at given values: the others are solved, and both make a configuration.

Held at the ends they only move the goal, T' = B^-1 T C^-1 with B the motion of those before the others and
C that of those behind, seen from the tip. Held between others they displace the joints that follow.
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
    """Every configuration with these joints at their values.

    solve: of the arm of those that move; arm: its numbers if those held stand at the ends, else the whole.
    """
    n = len(whole["axes"])
    moving = [i for i in range(n) if i not in held]
    values = zip(held, fixed, strict=True)
    motion = {i: joint_motion(whole, i, float(value)) for i, value in values}
    if arm is whole:
        arm = with_joints_held(whole, motion)
    else:
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


def with_joints_held(whole: dict[str, Any], motion: dict[int, Array]) -> dict[str, Any]:
    """The arm of the other joints: what is held displaces all that follows."""
    axes, points, slides, at = [], [], [], np.eye(4)
    for i in range(len(whole["axes"])):
        if i in motion:
            at = at @ motion[i]
            continue
        axes.append(at[:3, :3] @ whole["axes"][i])
        points.append(at[:3, :3] @ whole["points"][i] + at[:3, 3])
        slides.append(whole["slides"][i])
    rows = {"axes": np.array(axes), "points": np.array(points), "slides": np.array(slides)}
    return {**whole, **rows, "T_zero": at @ whole["T_zero"]}
