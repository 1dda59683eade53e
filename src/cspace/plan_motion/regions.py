"""Configurations of a region of poses: poses are drawn evenly, and all IK solutions of each are kept."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.collision.checks import explain_contacts
from cspace.ik.near_rows import solve_locked_redundant, sort_near
from cspace.ik.on_limits import keep_within
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.plan_motion.goals import Goals
from cspace.plan_motion.poses import scale_redundant
from cspace.planning import ArmSpace, Region
from cspace.planning.region import DIMENSIONS
from cspace.search.halton import halton_points

if TYPE_CHECKING:
    from cspace.robot import Robot

ENOUGH_GOALS: Final = 16
"""Free configurations after which no more poses are drawn: the planner tries the nearest three first."""

FIRST_POSES: Final = 64
"""Poses that are drawn at first; each time as many follow as there were."""

MOST_POSES: Final = 4096
"""Poses after which the search for a free configuration ends: some tens of milliseconds."""

MOST_EXPLAINED: Final = 256
"""Blocked configurations whose contacts are counted for the reason."""

POSE_JOINTS: Final = 6
"""Joints that reach a pose; arms with fewer are asked for positions and directions."""


@dataclass
class Drawn:
    """What became of the poses that were drawn. free, blocked: lists of rows (k, dof)."""

    poses: int = 0
    unreached: int = 0
    outside: int = 0
    free: list[Array] = field(default_factory=list)
    blocked: list[Array] = field(default_factory=list)

    @property
    def count(self) -> int:
        """Of the free configurations."""
        return sum(map(len, self.free))


def sample_region(robot: Robot, space: ArmSpace, start: Array, region: Region) -> Goals:
    """Free configurations of a region, the nearest to the start first, or counts of what was drawn."""
    drawn = Drawn()
    while drawn.poses < MOST_POSES and drawn.count < ENOUGH_GOALS:
        draw_poses(robot, space, start, region, drawn, max(drawn.poses, FIRST_POSES))
    rows = np.concatenate(drawn.free)
    if not len(rows):
        return Goals(rows, describe_drawn(robot, space, drawn), is_whole=False)
    order = np.argsort(np.square(rows - start).sum(axis=1), kind="stable")
    return Goals(np.ascontiguousarray(rows[order]), is_whole=False)


def draw_poses(robot: Robot, space: ArmSpace, start: Array, region: Region, drawn: Drawn, count: int) -> None:
    """Draw more poses of a region and sort their configurations into free and blocked ones."""
    q, found = solve_poses(robot, space, region, drawn.poses, count)
    kept, within = keep_within(robot.solver, q, robot.limits, slice(POSE_JOINTS))
    rows = sort_near(robot.solver, kept, robot.limits, start)
    rows = np.ascontiguousarray(rows[region.contains(robot.fk(rows))])
    touching = space.checker.core.check_rows(rows, 1).view(np.bool_)
    drawn.free.append(rows[~touching])
    drawn.blocked.append(rows[touching])
    drawn.poses += count
    drawn.unreached += int(np.count_nonzero(found == 0))
    drawn.outside += int(np.count_nonzero((found > 0) & (within == 0)))


def solve_poses(
    robot: Robot, space: ArmSpace, region: Region, first: int, count: int
) -> tuple[Array, npt.NDArray[np.int64]]:
    """The solutions of poses first … first + count − 1 of a region: q (count, k, dof), NaN behind those of
    each, and how many each has. Of a redundant arm they are those at one value of its redundant joints."""
    poses = region.sample(first, count, draw_positions(robot, region, first, count))
    if robot.solver.is_redundant:
        u = halton_points(first, count, DIMENSIONS + len(robot.solver.redundant_joints))[:, DIMENSIONS:]
        return solve_locked_redundant(robot.solver, poses, scale_redundant(robot, space, u))
    found = robot.ik(poses) if space.dof >= POSE_JOINTS else robot.ik(**parts_of(region, poses))
    batch = cast(SolutionsBatch, found)
    return batch.q, batch.count


def draw_positions(robot: Robot, region: Region, first: int, count: int) -> Array | None:
    """Positions (count, 3) that the tip can take, for a region without a box."""
    if region.box is not None:
        return None
    q = robot.random_configuration(count, rng=first, reach=1.0)
    return np.asarray(robot.fk(q)[:, :3, 3])


def parts_of(region: Region, poses: Array) -> dict[str, Any]:
    """The parts of poses (n, 4, 4) that a region constrains, as keywords of robot.ik."""
    parts: dict[str, Any] = {}
    if region.box is not None:
        parts["position"] = poses[:, :3, 3]
    if region.rotation is not None:
        parts["rotation"] = poses[:, :3, :3]
    if region.direction is not None:
        parts |= {"direction": poses[:, :3, :3] @ region.axis, "tool_axis": region.axis}
    return parts


def describe_drawn(robot: Robot, space: ArmSpace, drawn: Drawn) -> str:
    """Why a region has no free configuration, as far as it is known."""
    rows = np.concatenate(drawn.blocked)
    names = [robot.joint_names[k] for k in robot.solver.redundant_joints] if robot.solver.is_redundant else ()
    locked = f" at the value of {', '.join(names)} drawn for them" if names else ""
    text = (
        f"no free configuration was found: of {drawn.poses} poses that meet the goal {drawn.unreached} have"
        f" no IK solution{locked}, {drawn.outside} none within limits"
    )
    if not len(rows):
        return text
    named = explain_contacts(space.geometry, rows[:MOST_EXPLAINED], space.scene, space.margin)
    return f"{text}; {len(rows)} configurations of the others touch something: {named}"
