"""Where nothing reaches a goal: the configuration that misses it least."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.ik.context import About
from cspace.ik.goals.solve_partial import own_columns
from cspace.ik.solutions import NEAREST, Solutions, nearest_to_goal, position_goal
from cspace.ik.wrapping import wrap

__all__ = ["least_squares_answer"]


def least_squares_answer(robot: Any, found: Solutions) -> Solutions:
    goal = found.goal
    if found._partial is not None:
        return least_squares_partial(robot, found)
    if goal.shape == (3,):
        q, missing = _core._ik_nearest_position(robot, goal)
        goal, text = position_goal(goal), f"{missing:.4g} m"
    else:
        q, away, turned = _core._ik_nearest_pose(robot, goal, 1.0)
        text = f"{away:.4g} m and {np.degrees(turned):.4g}°"
    q = wrap(q, robot.joint_types)
    note = f"nothing reaches the goal; the nearest configuration misses it by {text}"
    return cast(Solutions, _core._ik_make(robot, goal, NEAREST, q[None, :], (-1,), (False,), note))


def least_squares_partial(robot: Any, found: Solutions) -> Solutions:
    """The nearest configuration of the longer arm, without the goal's joints."""
    about, goal = found._about, found._partial
    q, _, miss = nearest_to_goal(found)
    q = wrap(q, about.whole.joint_types)[None]
    note = f"nothing reaches {goal.text}; the nearest configuration misses it by {miss}"
    own = np.ascontiguousarray(q[:, own_columns(robot, goal)])
    about = About(goal, about.whole, q, about.freedom)
    return cast(Solutions, _core._ik_make(robot, found.goal, NEAREST, own, (-1,), (False,), note, about))
