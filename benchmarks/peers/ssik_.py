"""ssik: subproblem and algebraic solvers behind one manipulator class.

Its general solver derives equations for each arm, which takes seconds to minutes; it ships them for the arms
it knows and keeps those of others on disk. Here every process begins without any kept from before.
"""

import os
import tempfile

import numpy as np
from ssik import Manipulator

from chains import alignment, offsets
from peers import Task, need_turns

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
    return from_axes(arm), np.eye(4), unturn


def from_axes(arm):
    return Manipulator.from_axes(arm.axes, offsets(arm))


def derive(robot):
    """The work that the general solver needs once for an arm, without what it kept on disk from before."""
    with tempfile.TemporaryDirectory() as empty:
        os.environ["SSIK_DERIVATION_CACHE"] = empty
        robot.prepare()


def ik(arm):
    need_turns(arm)
    robot, base, tool = fastest(arm)
    derive(robot)  # of a shipped arm this returns at once

    def call(T):
        return robot.solve(T, respect_limits=False, enumerate_windings=False)

    return Task(
        lambda T: np.ascontiguousarray(base @ T @ tool),
        call,
        lambda found: np.array([s.q for s in found]).reshape(-1, arm.dof),
    )


def nearest(arm):
    """Its first answer to a pose and a seed, NaN for none, and what brings a pose into its frames."""
    robot, base, tool = fastest(arm)
    derive(robot)
    asked = {
        "max_solutions": 1,
        "seed_metric": "wrap_l2",
        "respect_limits": False,
        "enumerate_windings": False,
    }
    nothing = np.full(arm.dof, np.nan)

    def call(goal):
        found = robot.solve(goal[0], q_seed=goal[1], **asked)
        return found[0].q if found else nothing

    return call, lambda T: np.ascontiguousarray(base @ T @ tool)


def path(arm):
    """All branches along a path of poses (n, 4, 4), and what brings the poses into its frames."""
    robot, base, tool = fastest(arm)
    derive(robot)
    return robot.solve_path, lambda T: np.ascontiguousarray(base @ T @ tool)


def tracks(answer):
    """The configurations (n, dof) of each branch of a path."""
    return [np.array([step.q for step in track]) for track in answer.tracks.values()]
