"""ssik: subproblem and algebraic solvers behind one manipulator class."""

import numpy as np
from ssik import Manipulator

from chains import alignment, offsets
from peers import Task

NAME, PACKAGE, MODULE = "ssik", "ssik", "ssik"


def fastest(arm):
    """Its compiled artefact of the arm where it ships one with the same geometry, else its general entry.

    Returns the solver and the transforms (4, 4) that bring a pose into its frames.
    """
    try:
        prebuilt = Manipulator.from_prebuilt(arm.name)
    except (KeyError, ValueError, LookupError):
        prebuilt = None
    if prebuilt is not None:
        frames = alignment(arm, prebuilt.fk)
        if frames is not None:
            return prebuilt, *frames
    unturn = np.eye(4)
    unturn[:3, :3] = arm.T_zero[:3, :3].T
    return Manipulator.from_axes(arm.axes, offsets(arm)), np.eye(4), unturn


def ik(arm):
    robot, base, tool = fastest(arm)
    robot.prepare()

    def call(T):
        return robot.solve(T, respect_limits=False, enumerate_windings=False)

    return Task(
        lambda T: np.ascontiguousarray(base @ T @ tool),
        call,
        lambda found: np.array([s.q for s in found]).reshape(-1, arm.dof),
    )
