"""Robots get their solver here, once, when inverse kinematics is first asked of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace import _core
from cspace.ik.conditions import NoClosedFormError, explain_missing_form
from cspace.kinematics.batch import check_robot

__all__ = ["check_chain", "prepare"]

MAX_JOINTS = 16
MAX_SETTLED = 6
"""Joints that a pose settles at most."""
MOST_SOLUTIONS = 16


def prepare(robot: Any) -> None:
    """Build the solver of `robot` once: its axes, points and tip at zero go to the core, which looks for a
    form. Afterwards robot._ik_direct says whether a pose settles its joints and that solver answers; else
    some of them are locked, see cspace.ik.redundancy.solve.

    Raises InputTypeError for a value that is not a robot, NoClosedFormError for joints that mimic others, a
    floating base, no joint or more than sixteen.
    """
    check_robot(robot)
    if robot._ik_room:
        return
    check_chain(robot)
    chain = robot.chain
    prismatic = np.array([kind == "P" for kind in chain.joint_types], dtype=np.float64)
    room = _core._ik_build(
        robot,
        np.ascontiguousarray(chain.axes, dtype=np.float64),
        np.ascontiguousarray(chain.points, dtype=np.float64),
        prismatic,
        np.ascontiguousarray(chain.T_zero, dtype=np.float64),
    )
    robot._ik_direct = room > 0
    robot._ik_room = room or MOST_SOLUTIONS


def check_chain(robot: Any) -> None:
    """Raise NoClosedFormError for mimic joints, a floating base, no joint or more than sixteen."""
    chain = robot.chain
    joints = len(chain.joint_types)
    if chain.dof != joints or robot.floating or not 1 <= joints <= MAX_JOINTS:
        raise NoClosedFormError(explain_missing_form(robot))
