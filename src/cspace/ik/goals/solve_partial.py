"""Partial goals solved: as poses of the arm with the joints that stand for what the goal leaves open."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.ik.context import About
from cspace.ik.goals.partial import PartialGoal
from cspace.ik.locked_joints import leads_ahead
from cspace.ik.prepare import prepare
from cspace.ik.solutions import EXACT, INCOMPLETE, NEAREST, SINGULAR, UNREACHABLE, Solutions, how_many
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.wrapping import short_way
from cspace.model import from_screws
from cspace.spatial import log_so3

__all__ = ["met_by_open_joints", "own_columns", "solve_partial", "whole_arm"]

SAME = 1e-8
"""Configurations of the arm itself closer than this [rad, m] are one: a goal's other joints may reach it in
several ways.
"""
MOST_KEPT = 32
"""Longer arms kept per robot."""
STILL = 1e-9
"""Part of a family's direction below which a joint of the arm stands still in it."""


def solve_partial(
    robot: Any, goal: PartialGoal, ask: Callable[[Any, Array], Solutions | SolutionsBatch]
) -> Solutions | SolutionsBatch:
    """Every configuration that meets the goal. ask(whole, T): how the longer arm is asked for its poses."""
    whole = whole_arm(robot, goal)
    found = ask(whole, goal.T)
    if isinstance(found, SolutionsBatch):
        return batch_of_own(robot, goal, whole, found)
    return of_own(robot, goal, whole, found)


@dataclass(frozen=True)
class Many:
    """The goals of a batch, each of which can be asked again."""

    goal: PartialGoal

    def one(self, robot: Any, index: Any) -> Solutions:
        """The solutions of the goal at an index."""
        goal = self.goal.take(index)
        whole = whole_arm(robot, goal)
        prepare(whole)
        if not whole._ik_direct:
            from cspace.ik.redundancy.solve import redundant_answer

            answer = redundant_answer(whole, goal.T, locked=None, samples=None, near=None, threads=1)
            return of_own(robot, goal, whole, cast(Solutions, answer))
        found = cast(Solutions, _core._ik_single(whole, np.ascontiguousarray(goal.T)))
        return of_own(robot, goal, whole, found)


def own_columns(robot: Any, goal: PartialGoal) -> slice:
    """The columns of the longer arm's configurations that are the arm's own."""
    return slice(len(goal.before), len(goal.before) + robot.dof)


def met_by_open_joints(whole: Any, own: slice, seed: Array, T: Array) -> Array:
    """A configuration of the longer arm: the arm's own joints at the seed (dof,), the goal's where they bring
    it closest to the goal, by Gauss–Newton steps.
    """
    most_steps, settled, stride, damping = 40, 1e-12, 0.5, 1e-9
    q = np.zeros((*seed.shape[:-1], whole.dof))
    q[..., own] = seed
    is_open = np.ones(whole.dof, dtype=bool)
    is_open[own] = False
    ahead = leads_ahead(whole)
    if ahead.any():  # a look is as long as the goal is far, wherever it points
        away = T[..., :3, 3] - whole.fk(q)[..., :3, 3]
        q = np.where(ahead, np.linalg.norm(away, axis=-1)[..., None], q)
        is_open &= ~ahead
    turns = np.array([kind == "R" for kind in whole.joint_types])[is_open]
    for _ in range(most_steps):
        pose = whole.fk(q)
        turn = log_so3(T[..., :3, :3] @ np.swapaxes(pose[..., :3, :3], -1, -2))
        twist = np.concatenate([T[..., :3, 3] - pose[..., :3, 3], turn], axis=-1)
        J = whole.jacobian(q)[..., is_open]
        Jt = np.swapaxes(J, -1, -2)
        step = np.linalg.solve(Jt @ J + damping * np.eye(J.shape[-1]), Jt @ twist[..., None])[..., 0]
        reach = np.abs(step[..., turns]).max(axis=-1, initial=0.0, keepdims=True)
        q[..., is_open] += step * np.minimum(1.0, stride / np.maximum(reach, stride))
        if np.abs(step).max(initial=0.0) < settled:
            break
    return q


def whole_arm(robot: Any, goal: PartialGoal) -> Any:
    """The arm with the goal's joints behind its tip and before its base; the last few kinds are kept."""
    built = robot.__dict__.setdefault("_ik_wholes", {})
    found = built.get(goal.key)
    if found is None:
        if len(built) >= MOST_KEPT:  # angles and tool axes of a loop, each its own arm
            built.pop(next(iter(built)), None)
        found = built[goal.key] = make_whole(robot, goal)
    return found


def make_whole(robot: Any, goal: PartialGoal) -> Any:
    chain, T = robot.chain, robot.chain.T_zero.copy()
    axes = [axis for _, axis in goal.before] + list(chain.axes)
    points = [np.zeros(3) for _ in goal.before] + list(chain.points)
    for i, (_, axis) in enumerate(goal.behind):
        if goal.tilt and i == len(goal.behind) - 1:
            T[:3, :3] = T[:3, :3] @ tilted(axis, goal.tilt)
        axes.append(T[:3, :3] @ axis)
        points.append(T[:3, 3])
    first, last = len(goal.before), len(goal.behind)
    lower, upper = robot.limits.lower, robot.limits.upper
    ahead = [0.0 if kind == "P" and "look_at" in goal.kind else -np.inf for kind, _ in goal.behind]
    description = from_screws(
        axes,
        points,
        T,
        joint_types="".join(kind for kind, _ in goal.before)
        + robot.joint_types
        + "".join(kind for kind, _ in goal.behind),
        lower=np.concatenate([np.full(first, -np.inf), lower, ahead]),
        upper=np.concatenate([np.full(first, np.inf), upper, np.full(last, np.inf)]),
        name=robot.name,
        joint_names=[
            *goal.joint_names[:first],
            *robot.joint_names,
            *goal.joint_names[first:],
        ],
    )
    whole = type(robot)(description)
    whole._ik_uncounted = (*range(first), *range(first + robot.dof, whole.dof))
    if "ray" in goal.kind:  # whose point is the one nearest to the base
        whole._ik_reach = reach_of(robot)
    return whole


def reach_of(robot: Any) -> float:
    """No point of the tip is farther from the base [m]: all links in one line; without end for prismatic
    joints, whose limits a solution may break."""
    chain = robot.chain
    if "P" in chain.joint_types:
        return float("inf")
    corners = np.vstack([np.zeros(3), chain.points, chain.T_zero[:3, 3]])
    return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()) * (1 + 1e-9)


def tilted(axis: Array, angle: float) -> Array:
    """A rotation by `angle` about a direction perpendicular to `axis`."""
    square = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    x, y, z = square / np.linalg.norm(square)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return cast(Array, np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K)


def of_own(robot: Any, goal: PartialGoal, whole: Any, found: Solutions) -> Solutions:
    own = own_columns(robot, goal)
    rows, self_motions = [], []
    kept: list[Array] = []
    for row, q in enumerate(found.q):
        moves = found._is_self_motion[row] and (not whole._ik_direct or moves_itself(whole, q, own))
        if not meets(goal, robot, q[own]) or any(is_same(robot, q[own], other) for other in kept):
            continue
        kept.append(q[own])
        rows.append(row)
        self_motions.append(moves)
    status = found._status
    if status in (EXACT, SINGULAR):
        status = SINGULAR if any(self_motions) else EXACT if rows else UNREACHABLE
    certain = found.complete
    if (
        any(self_motions) and not whole._ik_direct
    ):  # members of families that nobody describes where joints are locked
        certain, status, self_motions = False, EXACT, [False] * len(rows)
    verdict = status + (INCOMPLETE if not certain and status != NEAREST else 0)
    about = About(goal, whole, found.q[rows], () if found._about is None else found._about.freedom)
    q = np.ascontiguousarray(found.q[rows][:, own])
    branches, note = tuple(range(len(rows))), found._note
    if note is not None and len(rows) != len(found):
        note = note.replace(how_many(len(found)), how_many(len(rows)), 1)
    return cast(
        Solutions, _core._ik_make(robot, goal.T, verdict, q, branches, tuple(self_motions), note, about)
    )


def moves_itself(whole: Any, q: Array, own: slice) -> bool:
    """Whether the arm's own joints take part in the self-motion through q."""
    direction = _core._ik_direction(whole, np.ascontiguousarray(q), True)
    return direction is None or bool(np.abs(direction[own]).max() > STILL)


def meets(goal: PartialGoal, robot: Any, q: Array) -> bool:
    """A tool that looks at a point has it before it, not behind."""
    return "look_at" not in goal.kind or bool(goal.residual(robot.fk(q)) < 1e-6)


def is_same(robot: Any, a: Array, b: Array) -> bool:
    return bool(np.abs(short_way(a - b, robot.joint_types)).max() < SAME)


def batch_of_own(robot: Any, goal: PartialGoal, whole: Any, found: SolutionsBatch) -> SolutionsBatch:
    """Goal by goal: rows that differ in the goal's joints alone are one."""
    q = np.full((*found.q.shape[:-1], robot.dof), np.nan)
    count, verdict = np.zeros_like(found.count), found._verdict.copy()
    for index in np.ndindex(found.count.shape):
        one = of_own(robot, goal.take(index), whole, found[index])
        count[index] = len(one)
        q[index][: len(one)] = one.q
        verdict[index] = one._verdict
    return SolutionsBatch(robot, goal.T, q, count, verdict, Many(goal), found.freedom)
