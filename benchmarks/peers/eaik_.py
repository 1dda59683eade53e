"""EAIK: analytic inverse kinematics by subproblem decomposition (Ostermeier and others)."""

import numpy as np
from eaik.IK_HP import HPRobot

from chains import offsets
from peers import Refused, Task, need_turns

NAME, PACKAGE, MODULE = "EAIK", "EAIK", "eaik.IK_HP"


def ik(arm):
    need_turns(arm)
    robot = HPRobot(arm.axes, offsets(arm))
    if not robot.hasKnownDecomposition():
        raise Refused("no known decomposition")
    unturn = arm.T_zero[:3, :3].T

    def prepare(T):
        T = T.copy()
        T[:3, :3] = T[:3, :3] @ unturn
        return T

    def batch(poses):
        return robot.IK_batched(poses, 1)

    def exact(solution):
        """Its answers less those that it marks as least-squares."""
        return np.asarray(solution.Q).reshape(-1, arm.dof)[~np.asarray(solution.is_LS, dtype=bool)]

    return Task(
        prepare,
        robot.IK,
        lambda solution: np.asarray(solution.Q),
        exact=exact,
        batch=batch,
        prepare_batch=lambda Ts: [prepare(T) for T in Ts],
    )
