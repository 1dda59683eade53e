"""Tasks: how many numbers a goal has, and how many dimensions an arm's tip moves in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from cspace.arrays import Array
from cspace.tolerances import POSSIBLE_MOTION

if TYPE_CHECKING:
    from cspace.robot import Robot


TASKS: Final[Mapping[str, int]] = MappingProxyType(
    {"pose": 6, "position": 3, "direction": 2, "planar": 3, "planar-position": 2}
)
"""A task and its numbers: planar is x, y and a heading; planar-position x and y."""

SAMPLES: Final = 8
"""Configurations whose Jacobians are looked at; a rank is lost at all of them only if it is never there."""


def motion_rank(robot: Robot, rows: str | Iterable[str] = "all") -> int:
    """In how many dimensions, of the six or of some rows, the tip moves in general."""
    from cspace.kinematics import singular_values

    if not len(robot.joint_names):
        return 0
    q = np.random.default_rng(1).uniform(-1.3, 1.3, size=(SAMPLES, len(robot.joint_names)))
    largest = singular_values(robot, q)[:, :1]
    return int((singular_values(robot, q, rows=rows) > POSSIBLE_MOTION * largest).sum(axis=1).max())


def singularity_of_rows(robot: Robot, q: Array, rows: str | Iterable[str]) -> Array | None:
    """The smallest singular value of these rows of the Jacobian, per configuration of q (k, n), among as many
    as the arm has freedoms in them: an arm in the plane loses none by not leaving it. None where it has none.
    """
    from cspace.kinematics import singular_values

    rank = motion_rank(robot, rows)
    return singular_values(robot, q, rows=rows)[:, rank - 1] if rank else None


def default_task(robot: Robot) -> str:
    """The task that an arm's shape suggests: a planar arm's is planar, three joints place a point."""
    if robot.tip is None:
        return "pose"
    from cspace.plot.skeleton import planar_basis

    if planar_basis(robot.chain) is not None:
        return "planar" if robot.dof >= 3 else "planar-position"
    return "position" if robot.dof <= 3 else "pose"


def rows_of_task(robot: Robot) -> str:
    """The rows of the Jacobian that count: the linear ones for an arm that only places a point."""
    return "linear" if default_task(robot) in ("position", "planar-position") else "all"
