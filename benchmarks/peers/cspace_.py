"""cspace itself, through its public face."""

import cspace as cs
import cspace.model
from peers import Task

NAME, PACKAGE, MODULE = "cspace", "cspace", "cspace"
VERSION = cs.__version__


def robot(arm):
    screws = cs.model.from_screws(
        arm.axes, arm.points, arm.T_zero, joint_types=arm.joint_types, lower=arm.lower, upper=arm.upper
    )
    return cs.Robot(screws)


def ik(arm):
    solve = robot(arm).ik
    return Task(lambda T: T, solve, lambda s: s.q, batch=lambda Ts: solve(Ts, threads=1))


def fk(arm):
    solve = robot(arm).fk
    return Task(lambda q: q, solve, lambda T: T, batch=lambda qs: solve(qs, threads=1))


def jacobian(arm):
    solve = robot(arm).jacobian
    return Task(lambda q: q, solve, lambda J: J, batch=lambda qs: solve(qs, threads=1))


def fk_jacobian(arm):
    solve = robot(arm).fk_jacobian
    return Task(lambda q: q, solve, lambda both: both[1], batch=lambda qs: solve(qs, threads=1))
