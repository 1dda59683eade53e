"""Where nothing reaches a goal: the configuration of least error."""

from __future__ import annotations

from dataclasses import replace

from cspace.ik.answers import NEAREST
from cspace.ik.solutions import Solutions, nearest_to_goal
from cspace.ik.wrapping import wrap_joints


def least_squares_answer(found: Solutions) -> Solutions:
    """The configuration of least error for one goal that nothing reaches."""
    q = wrap_joints(nearest_to_goal(found)[0], found._whole[0].joint_types)[None]
    about = replace(found._about, q=q) if found._about and found._partial else None
    own = found._wanted.own_joints(q)
    return Solutions.of(found.solver, found.goal, NEAREST, own, (-1,), (False,), None, about)
