"""Tasks: how many numbers a goal has, and how many dimensions an arm's tip moves in."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from cspace.robot import Robot


TASKS: Final[Mapping[str, int]] = MappingProxyType(
    {"pose": 6, "position": 3, "direction": 2, "planar": 3, "planar-position": 2}
)
"""A task and its numbers: planar is x, y and a heading; planar-position x and y."""


def default_task(robot: Robot) -> str:
    """The task that an arm's shape suggests: a planar arm's is planar, three joints place a point."""
    if robot.tip is None:
        return "pose"
    from cspace.plot.skeleton import planar_basis

    if planar_basis(robot.chain) is not None:
        return "planar" if robot.dof >= 3 else "planar-position"
    return "position" if robot.dof <= 3 else "pose"
