"""Accelerations and forces of closed loops against Pinocchio's constraintDynamics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cspace import dynamics
from cspace.kinematics import LoopConstraints
from cspace.model import to_urdf
from cspace.robot import Robot
from kinematics.loops import closing_loop, random_tree

pytestmark = pytest.mark.oracle

pin = pytest.importorskip("pinocchio")

TOLERANCE = 1e-8  # of the largest number: theirs is a proximal iteration


def solve_theirs(model, loops, q, qd, tau):
    """The accelerations of constraintDynamics with the loops as rigid contacts without stabilisation."""
    data, kinds = model.createData(), pin.ContactType
    contacts, datas = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
    for loop in loops:
        frames = [model.frames[model.getFrameId(name)] for name in (loop.parent, loop.child)]
        places = [
            frame.placement * pin.SE3(T)
            for frame, T in zip(frames, (loop.origin, loop.child_origin), strict=True)
        ]
        kind = kinds.CONTACT_3D if loop.type == "spherical" else kinds.CONTACT_6D
        joints = [frame.parentJoint for frame in frames]
        contacts.append(
            pin.RigidConstraintModel(
                kind, model, joints[0], places[0], joints[1], places[1], pin.ReferenceFrame.LOCAL
            )
        )
        datas.append(contacts[-1].createData())
    pin.initConstraintDynamics(model, data, contacts, datas)
    settings = pin.ProximalSettings(1e-14, 1e-14, 0.0, 200)
    return pin.constraintDynamics(model, data, q, qd, tau, contacts, datas, settings).copy()


@pytest.mark.parametrize("kind", ["spherical", "fixed"])
@pytest.mark.parametrize("seed", range(6))
def test_constraint_dynamics(seed, kind):
    rng = np.random.default_rng(seed)
    description = random_tree(rng, 16, mimic=False)
    limits = {"lower": -10.0, "upper": 10.0, "velocity": 10.0, "effort": 10.0}
    description = replace(description, joints=tuple(replace(joint, **limits) for joint in description.joints))
    robot = Robot(description)
    model = pin.buildModelFromXML(to_urdf(description))
    order = [robot.joint_names.index(name) for name in list(model.names)[1:]]
    q = rng.uniform(-1, 1, robot.dof)
    for i in range(2, 16):  # the first pair of links whose loop has independent rows
        for j in range(i + 1, 16):
            loop = closing_loop(robot, q, kind, f"link_{i}", f"link_{j}", "loop", rng)
            try:
                constraints = LoopConstraints(robot, [loop])
            except ValueError:
                continue
            if np.linalg.svd(constraints.jacobian(q), compute_uv=False)[-1] > 0.05:
                break
        else:
            continue
        break
    else:
        pytest.skip("no loop with independent rows")
    qd, tau = rng.normal(size=(2, robot.dof))
    # Both need velocities that keep the loop closed: they define the rate of φ differently where it is torn.
    K = constraints.jacobian(q)
    qd = qd - np.linalg.pinv(K) @ (K @ qd)
    theirs = solve_theirs(model, [loop], q[order], qd[order], tau[order])
    ours = dynamics.constrained_forward_dynamics(constraints, q, qd, tau)
    np.testing.assert_allclose(ours[order], theirs, atol=TOLERANCE * np.abs(theirs).max())
