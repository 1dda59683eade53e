"""Where nothing reaches a goal: the configuration of least error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cspace import _core
from cspace.ik.solutions import NEAREST, UNREACHABLE, Solutions, nearest_to_goal, position_goal
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.wrapping import wrap

__all__ = ["least_squares_answer", "least_squares_batch"]


def least_squares_answer(found: Solutions) -> Solutions:
    """The configuration of least error for one goal that nothing reaches."""
    solver, goal = found.solver, found.goal
    if found._partial is not None:
        return least_squares_partial(found)
    if goal.shape == (3,):
        q, missing = _core._ik_nearest_position(solver, goal)
        goal, text = position_goal(goal), f"{missing:.4g} m"
    else:
        q, away, turned = _core._ik_nearest_pose(solver, goal, 1.0)
        text = f"{away:.4g} m and {np.degrees(turned):.4g}°"
    q = wrap(q, solver.joint_types)
    note = f"nothing reaches the goal; the nearest configuration misses it by {text}"
    return Solutions.of(solver, goal, NEAREST, q[None, :], (-1,), (False,), note)


def least_squares_partial(found: Solutions) -> Solutions:
    """Of a partial goal: the configuration of the arm with the goal's joints, without these joints."""
    about, goal = found._about, found._about.goal
    q, _, miss = nearest_to_goal(found)
    q = wrap(q, about.extended.joint_types)[None]
    note = f"nothing reaches {goal.text}; the nearest configuration misses it by {miss}"
    about = replace(about, q=q)
    return Solutions.of(found.solver, found.goal, NEAREST, goal.own_joints(q), (-1,), (False,), note, about)


def least_squares_batch(found: SolutionsBatch, threads: int) -> SolutionsBatch:
    """The batch with the configuration of least error for each goal that nothing reaches."""
    bad = np.argwhere(found._status == UNREACHABLE)
    if not len(bad):
        return found
    q, count, verdict = found.q.copy(), found.count.copy(), found._verdict.copy()
    if found._partial is None and found.goal.shape[found.count.ndim :] == (4, 4):
        goals = np.ascontiguousarray(found.goal[tuple(bad.T)])
        rows = wrap(_core._ik_nearest_poses(found.solver, goals, 1.0, threads), found.solver.joint_types)
    else:
        rows = np.array([least_squares_answer(found[tuple(index)]).q[0] for index in bad])
    if not q.shape[-2]:
        q = np.full((*q.shape[:-2], 1, q.shape[-1]), np.nan)
    q[(*bad.T, 0)] = rows
    count[tuple(bad.T)], verdict[tuple(bad.T)] = 1, NEAREST
    return found._with(q, count, verdict)
