"""Pinocchio: rigid-body algorithms; forward kinematics and Jacobians here."""

import numpy as np
import pinocchio as pin

from peers import Task

NAME, PACKAGE, MODULE = "Pinocchio", "pin", "pinocchio"


def frame_with_z(axis):
    """A rotation whose third column is the axis, so that the joint is one of the fast aligned ones."""
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(axis, x), axis])


def model(arm):
    """The arm as a Pinocchio model, its data and the id of its tip frame."""
    built, parent, T_parent = pin.Model(), 0, np.eye(4)
    for i in range(arm.dof):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = frame_with_z(arm.axes[i]), arm.points[i]
        step = np.linalg.inv(T_parent) @ T
        parent = built.addJoint(parent, pin.JointModelRZ(), pin.SE3(step), f"joint_{i}")
        T_parent = T
    tip = pin.SE3(np.linalg.inv(T_parent) @ arm.T_zero)
    frame = built.addFrame(pin.Frame("tip", parent, 0, tip, pin.FrameType.OP_FRAME))
    return built, built.createData(), frame


def fk(arm):
    built, data, frame = model(arm)

    def call(q):
        pin.forwardKinematics(built, data, q)

    def read(_):
        return pin.updateFramePlacement(built, data, frame).homogeneous

    return Task(lambda q: q, call, read)


def jacobian(arm):
    built, data, frame = model(arm)

    def call(q):
        return pin.computeFrameJacobian(built, data, q, frame, pin.LOCAL_WORLD_ALIGNED)

    return Task(lambda q: q, call, lambda J: J)


MOST_STEPS, REACHED, DAMPING = 200, 1e-9, 1e-10
"""Steps of a descent, the error [m, rad] at which it ends, and what keeps its equations solvable."""


def descent(arm):
    """The loop that its users write: q ← q + Jᵀ (J Jᵀ + λ I)⁻¹ e with e = log of the goal seen from the tip,
    J the Jacobian in the tip. Answers with NaN where it does not arrive."""
    built, data, frame = model(arm)
    damping, nothing = DAMPING * np.eye(6), np.full(arm.dof, np.nan)

    def call(goal):
        target, q = goal
        for _ in range(MOST_STEPS):
            pin.forwardKinematics(built, data, q)
            gap = pin.updateFramePlacement(built, data, frame).actInv(target)
            error = pin.log6(gap).vector
            if np.abs(error).max() < REACHED:
                return q
            J = pin.computeFrameJacobian(built, data, q, frame, pin.LOCAL)
            q = q + J.T @ np.linalg.solve(J @ J.T + damping, error)
        return nothing

    return call, pin.SE3
