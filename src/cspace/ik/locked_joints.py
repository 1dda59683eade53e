"""Joints held at values: which they are, and the solver of the others."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, suggest
from cspace.model import from_screws
from cspace.tolerances import FARTHEST

__all__ = [
    "LockedArm",
    "between_others",
    "by_name",
    "joint_number",
    "leads_ahead",
    "lock_joints",
    "locked_in_words",
    "locked_values",
    "value_in_words",
    "with_joints_locked",
    "without_locked",
]


@dataclass(frozen=True)
class LockedArm:
    """An arm with some joints at given values: the solver of the others, whose rows become the arm's."""

    solver: _core.RedundantSolver
    robot: Any
    free: tuple[int, ...]  # the joints that the solver knows
    locked: dict[int, float]

    @property
    def parameters(self) -> tuple[str, ...]:
        return tuple(self.robot.joint_names[self.free[k]] for k in self.solver.locked)

    @property
    def freedom(self) -> tuple[str, ...]:
        """What the goal leaves free, by the locked joints in its place."""
        return self.parameters if self.solver.redundancy_degree else ()

    def whole(self, q: Array) -> Array:
        """Rows (..., n free joints) as rows of the arm."""
        if not self.locked:
            return q
        out = np.empty((*q.shape[:-1], self.robot.dof))
        out[..., list(self.free)] = q
        for joint, value in self.locked.items():
            out[..., joint] = value
        return out


def joint_number(robot: Any, key: Any, subject: str) -> int:
    names = robot.joint_names
    if isinstance(key, str):
        if key not in names:
            raise suggest("joint", key, names, owner=robot.name)
        return int(names.index(key))
    if isinstance(key, bool) or not isinstance(key, (int, np.integer)):
        raise InputTypeError(
            f"{subject} names a joint by a {type(key).__name__}, expected its name or number"
        )
    if not -len(names) <= key < len(names):
        raise InputError(f"{subject} has joint {key}, but {robot.name} has joints 0 to {len(names) - 1}")
    return int(key) % len(names)


def locked_values(robot: Any, locked: Any) -> dict[int, Any]:
    """The locked joints by number, ascending, each with a number or an array of them."""
    if not isinstance(locked, Mapping):
        raise InputTypeError(
            f"locked is a {type(locked).__name__}, expected a dict from joints to values: {{'joint_7': 0.3}}"
        )
    out: dict[int, Any] = {}
    for key, value in locked.items():
        joint = joint_number(robot, key, "locked")
        if joint in out:
            raise InputError(f"locked names {robot.joint_names[joint]!r} twice")
        out[joint] = as_floats(value, f"locked[{key!r}]", largest=FARTHEST)
    if len(out) >= len(robot.joint_names):
        raise InputError(f"locked holds every joint of {robot.name}: none is left to move")
    return dict(sorted(out.items()))


def by_name(robot: Any, locked: Mapping[Any, Any]) -> dict[str, Any]:
    """Values of locked joints by the joints' names."""
    out: dict[str, Any] = {}
    for key, value in locked.items():
        name = key if isinstance(key, str) else robot.joint_names[joint_number(robot, key, "locked")]
        if name in out:
            raise InputError(f"locked names {name!r} twice, by name and by number; give each joint one value")
        if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim):
            raise InputTypeError(
                f"locked[{key!r}] is a {type(value).__name__}, expected one number with parts of a pose"
            )
        out[name] = value
    return out


def locked_in_words(robot: Any, locked: Mapping[int, Any]) -> str:
    """Joints with the values at which they are locked: lift = 0.2 m, wrist = 1.5 rad."""
    values = ((robot.joint_names[k], value_in_words(robot, k, value)) for k, value in locked.items())
    return ", ".join(f"{name} = {value}" for name, value in values)


def value_in_words(robot: Any, joint: int, value: Any) -> str:
    """A joint's value with its unit."""
    return f"{float(value):.6g} {'rad' if robot.joint_types[joint] == 'R' else 'm'}"


def leads_ahead(robot: Any) -> npt.NDArray[np.bool_]:
    """Which joints are prismatic joints that a goal adds and that only lead ahead, as a look does."""
    out = np.zeros(robot.dof, dtype=bool)
    out[list(robot._ik_uncounted)] = robot.limits.lower[list(robot._ik_uncounted)] == 0.0
    return out


def make_solver(
    robot: Any, keep: tuple[int, ...], locked: dict[int, float], limited: bool
) -> _core.RedundantSolver:
    """The solver of the joints `keep`; those between them stand at their fixed values."""
    chain = robot.chain
    axes, points, T_zero = chain.axes, chain.points, chain.T_zero
    if locked:
        axes, points, T_zero = with_joints_locked(chain, locked)
    rows = list(keep)
    weight = np.array([float(k not in robot._ik_uncounted) for k in rows])
    far = np.full(len(rows), np.inf)
    lower, upper = (robot.limits.lower[rows], robot.limits.upper[rows]) if limited else (-far, far)
    return _core.RedundantSolver(
        np.ascontiguousarray(axes[rows], dtype=np.float64),
        np.ascontiguousarray(points[rows], dtype=np.float64),
        np.array([chain.joint_types[k] == "P" for k in rows]),
        np.ascontiguousarray(T_zero, dtype=np.float64),
        np.ascontiguousarray(lower, dtype=np.float64),
        np.ascontiguousarray(upper, dtype=np.float64),
        weight,
    )


def with_joints_locked(chain: Any, locked: dict[int, float]) -> tuple[Array, Array, Array]:
    """The screws of a chain behind joints that stand still: each locked joint displaces all that follow."""
    from cspace.spatial import exp_se3

    axes, points = chain.axes.copy(), chain.points.copy()
    T = np.eye(4)
    for k in range(len(axes)):
        h, p = chain.axes[k], chain.points[k]
        axes[k], points[k] = T[:3, :3] @ h, T[:3, :3] @ p + T[:3, 3]
        if k in locked:
            turns = chain.joint_types[k] == "R"
            twist = np.concatenate([np.cross(p, h), h]) if turns else np.concatenate([h, np.zeros(3)])
            T = T @ exp_se3(twist * locked[k])
    return axes, points, T @ chain.T_zero


def without_locked(robot: Any, locked: Mapping[int, float]) -> Any:
    """The arm of the joints that move, without limits; the locked ones stand at their values."""
    chain = robot.chain
    rows = [k for k in range(len(chain.joint_types)) if k not in locked]
    axes, points, T_zero = with_joints_locked(chain, dict(locked))
    return type(robot)(
        from_screws(
            axes[rows],
            points[rows],
            T_zero,
            joint_types="".join(chain.joint_types[k] for k in rows),
            name=robot.name,
            joint_names=[chain.joint_names[k] for k in rows],
        )
    )


def between_others(n: int, locked: Collection[int]) -> tuple[int, ...]:
    """The locked joints of n that stand between joints that move: they change a link."""
    moving = [k for k in range(n) if k not in locked]
    return tuple(k for k in sorted(locked) if moving[0] < k < moving[-1])


MOST_KEPT = 8
"""Solvers kept per robot for different held values: more are a loop over values, which builds its own."""


def lock_joints(robot: Any, locked: dict[int, float], *, limited: bool = True) -> LockedArm:
    """The solver with these joints at their values, with or without limits; the last few are kept."""
    free = tuple(k for k in range(len(robot.joint_names)) if k not in locked)
    kept: dict[Any, LockedArm] = robot.__dict__.setdefault("_held", {})
    key = (limited, *locked.items())
    found = kept.get(key)
    if found is None:
        if len(kept) >= MOST_KEPT:
            kept.pop(next(iter(kept)), None)
        found = kept[key] = LockedArm(make_solver(robot, free, locked, limited), robot, free, locked)
    return found
