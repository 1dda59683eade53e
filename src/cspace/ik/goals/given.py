"""Goals as callers give them, checked and laid out as arrays: poses, points, points with an angle."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array, as_floats, leading_axes, one_array
from cspace.errors import InputError, InputTypeError
from cspace.ik.solver import Solver
from cspace.ik.wrapping import revolute_joints
from cspace.spatial import as_pose, exp_so3
from cspace.spatial.poses import assemble
from cspace.tolerances import FARTHEST, LEVEL_SLIDE, UPRIGHT_TURN


def goal_array(goal: Any) -> Array:
    """The goals as contiguous float64; a plain batch stays unchecked, as the core checks every goal."""
    if type(goal) is np.ndarray and goal.dtype == np.float64 and goal.ndim > 2 and goal.shape[-2:] == (4, 4):
        return np.require(goal, requirements=["C", "A"])
    return np.require(as_pose(goal, "goal"), requirements=["C", "A"])


def checked_poses(T: Array) -> Array:
    """Poses that may have come unchecked, none of them too far away."""
    T = as_pose(T, "goal")
    if len(beyond := np.argwhere(is_far(T[..., :3, 3]))):
        index = tuple(map(int, beyond[0]))
        raise too_far(f"goal {index}" if index else "goal", T[index][:3, 3])
    return T


def points_in_base(solver: Solver, position: Any) -> Array:
    """Points in the base (..., 3); those of the plane (..., 2) at the height that a planar arm keeps."""
    p = as_floats(position, "position")
    if p.ndim > 0 and p.shape[-1] == 2:
        p = lift_points(solver, p)
    if p.ndim == 0 or p.shape[-1] != 3:
        raise InputError(
            f"position has shape {p.shape}, expected (..., 3), or (..., 2) for an arm in the plane"
        )
    if p.ndim == 1 and is_far(p):
        raise too_far("position", p)
    return np.ascontiguousarray(p)


def is_open(value: Any) -> bool:
    """Whether some coordinates of a point are None."""
    return isinstance(value, (tuple, list)) and any(v is None for v in value)


def open_in_space(solver: Solver, position: Any) -> Any:
    """A point of the plane with one coordinate open (None), in space; every other position as it is."""
    if not is_open(position) or len(position) != 2:
        return position
    if all(v is None for v in position):
        return (None, None, None)
    return (*position, float(lift_points(solver, np.zeros(2))[2]))


def planar_poses(solver: Solver, goal: Any, position: Any, angle: Any) -> Array:
    """Poses of an arm in the plane from points (..., 2) and angles (...) of the tip's x axis."""
    if goal is not None or position is None:
        raise InputTypeError("angle= can only be combined with position=(x, y) of a planar arm")
    p = as_floats(position, "position", last=(2,), largest=FARTHEST)
    T_zero = solver.chain.T_zero
    turn = as_floats(angle, "angle", largest=FARTHEST) - np.arctan2(T_zero[1, 0], T_zero[0, 0])
    leading_axes(position=p.shape[:-1], angle=turn.shape)
    R = exp_so3(turn[..., None] * np.array([0.0, 0.0, 1.0])) @ T_zero[:3, :3]
    return assemble(R, lift_points(solver, p))


def lift_points(solver: Solver, p: Array) -> Array:
    """Points (..., 2) of the plane z = constant in which an arm keeps its tip, as points (..., 3)."""
    chain = solver.chain
    along_z = np.abs(chain.axes[:, 2])
    in_plane = np.where(revolute_joints(chain.joint_types), along_z > 1 - UPRIGHT_TURN, along_z < LEVEL_SLIDE)
    if not in_plane.all():
        raise InputError(
            f"position has shape {p.shape}, but {solver.name} is not a planar arm; give three coordinates"
        )
    return np.concatenate([p, np.full((*p.shape[:-1], 1), chain.T_zero[2, 3])], axis=-1)


def one_configuration(solver: Solver, value: Any, subject: str) -> Array:
    """One configuration (dof,), contiguous."""
    return one_array(value, subject, (solver.dof,), "one configuration", largest=FARTHEST)


def rows_for_goals(value: Any, subject: str, n: int, shape: tuple[int, ...]) -> Array:
    """Configurations: one (n,) for all goals of a shape, or one for each, (*shape, n)."""
    rows = as_floats(value, subject, last=(n,), largest=FARTHEST)
    if rows.ndim == 1:
        return rows
    try:
        return np.broadcast_to(rows, (*shape, n))
    except ValueError:
        each = f" for all goals or {(*shape, n)}, one for each" if shape else ""
        raise InputError(f"{subject} has shape {rows.shape}, expected ({n},){each}") from None


def is_far(p: Array) -> Any:
    """Whether points (..., 3) lie too far away, (...); sums that no float64 holds are not formed."""
    return np.minimum(np.abs(p), 2 * FARTHEST).sum(axis=-1) > FARTHEST


def too_far(subject: str, p: Array) -> InputError:
    return InputError(f"{subject} lies at {p.tolist()} m; the largest distance is {FARTHEST:g} m")
