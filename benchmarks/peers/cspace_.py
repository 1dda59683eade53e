"""cspace itself, through its public face."""

import cspace as cs
from peers import Task

NAME, PACKAGE, MODULE = "cspace", "cspace", "cspace"


def robot(arm):
    return cs.Robot.from_screws(
        arm.axes, arm.points, arm.T_zero, joint_types="R" * arm.dof, lower=arm.lower, upper=arm.upper
    )


def ik(arm):
    solve = robot(arm).ik
    return Task(lambda T: T, solve, lambda s: s.q, batch=lambda Ts: solve(Ts, threads=1))


def fk(arm):
    solve = robot(arm).fk
    return Task(lambda q: q, solve, lambda T: T, batch=lambda qs: solve(qs, threads=1))


def jacobian(arm):
    solve = robot(arm).jacobian
    return Task(lambda q: q, solve, lambda J: J, batch=lambda qs: solve(qs, threads=1))
