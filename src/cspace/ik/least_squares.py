"""Where nothing reaches a goal: the configuration of least error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cspace import _core
from cspace.ik.solutions import NEAREST, Solutions, nearest_to_goal, position_goal
from cspace.ik.wrapping import wrap_joints


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
    q = wrap_joints(q, solver.joint_types)
    note = f"no configuration reaches the goal; the nearest one misses it by {text}"
    return Solutions.of(solver, goal, NEAREST, q[None, :], (-1,), (False,), note)


def least_squares_partial(found: Solutions) -> Solutions:
    """Of a partial goal: the configuration of the arm with the goal's joints, without these joints."""
    about, goal = found._about, found._about.goal
    q, _, miss = nearest_to_goal(found)
    q = wrap_joints(q, about.extended.joint_types)[None]
    note = f"no configuration reaches {goal.text}; the nearest one misses it by {miss}"
    about = replace(about, q=q)
    return Solutions.of(found.solver, found.goal, NEAREST, goal.own_joints(q), (-1,), (False,), note, about)
