"""Robotics Toolbox for Python (Corke): analytic inverse kinematics derived per arm, and its compiled ETS."""

import numpy as np
import roboticstoolbox as rtb
from spatialmath import SE3

from chains import fk as chain_fk
from peers import Refused, Task

NAME, PACKAGE, MODULE = "Robotics Toolbox", "roboticstoolbox-python", "roboticstoolbox"


def dh_robot(arm):
    links = [
        rtb.RevoluteDH(a=a, alpha=alpha, d=d, offset=offset, qlim=[-np.pi, np.pi])
        if turns
        else rtb.PrismaticDH(a=a, alpha=alpha, theta=offset, offset=d, qlim=[-10, 10])
        for (alpha, a, d, offset), turns in zip(arm.dh, arm.turns, strict=True)
    ]
    robot = rtb.DHRobot(links, base=SE3(arm.T_dh_base), tool=SE3(arm.T_dh_tool), name=arm.name)
    q = np.linspace(0.3, 1.3, arm.dof)
    if np.abs(robot.fkine(q).A - chain_fk(arm, q)).max() > 1e-9:
        raise Refused("its DH robot does not reproduce the arm")
    return robot


def ik(arm):
    solver = dh_robot(arm).analytic_ik()
    return Task(
        lambda T: T,
        lambda T: solver.solve(T, joint_limits=False),
        lambda solution: np.asarray(solution.q).reshape(-1, arm.dof),
    )


def fk(arm):
    ets = dh_robot(arm).ets()
    return Task(lambda q: q, ets.eval, lambda T: T, batch=ets.eval)


def jacobian(arm):
    ets = dh_robot(arm).ets()
    return Task(lambda q: q, ets.jacob0, lambda J: J)
