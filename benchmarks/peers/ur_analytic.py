"""ur-analytic-ik: closed forms for the arms of Universal Robots, by their published DH parameters."""

import numpy as np
import ur_analytic_ik

from chains import alignment
from peers import Refused, Task

NAME, PACKAGE, MODULE = "ur-analytic-ik", "ur_analytic_ik", "ur_analytic_ik"


def ik(arm):
    model = getattr(ur_analytic_ik, arm.name, None)
    if model is None:
        raise Refused("not a nominal arm of Universal Robots")
    frames = alignment(arm, lambda q: np.asarray(model.forward_kinematics(*q)))
    if frames is None:
        raise Refused("its frames and those of the arm differ by more than base and tool")
    base, tool = frames
    return Task(
        lambda T: np.ascontiguousarray(base @ T @ tool),
        model.inverse_kinematics,
        lambda found: np.array(found).reshape(-1, arm.dof),
    )
