"""ik-geo: the subproblem method in Rust (Elias and Wen)."""

import numpy as np
from ik_geo import Robot

from chains import offsets
from peers import Refused, Task, need_turns

NAME, PACKAGE, MODULE = "ik-geo", "ik-geo", "ik_geo"


def factory(arm):
    """The class of solver that the axes of the arm ask for."""
    h, steps = arm.axes, offsets(arm)

    def parallel(i, j):
        return np.linalg.norm(np.cross(h[i], h[j])) < 1e-9

    def meet(i):
        return np.linalg.norm(steps[i]) < 1e-9

    if meet(4) and meet(5):
        return (
            Robot.spherical_two_parallel
            if parallel(1, 2)
            else Robot.spherical_two_intersecting
            if meet(1)
            else Robot.spherical
        )
    if parallel(1, 2) and parallel(2, 3):
        return Robot.three_parallel_two_intersecting if meet(5) else Robot.three_parallel
    raise Refused("no closed form among its classes")


def ik(arm):
    need_turns(arm)
    robot = factory(arm)(arm.axes, offsets(arm))
    unturn = arm.T_zero[:3, :3].T

    def read(answers):
        return np.array([q for q, least_squares in answers if not least_squares]).reshape(-1, arm.dof)

    def prepare(T):
        """It reads and writes rotations column by column."""
        return np.ascontiguousarray((T[:3, :3] @ unturn).T), T[:3, 3].copy()

    return Task(prepare, lambda pose: robot.get_ik(*pose), read)
