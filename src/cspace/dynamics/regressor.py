"""The regressor of inverse dynamics: the torques are linear in the masses of the robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, Protocol, cast

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, guard_memory
from cspace.dynamics.rows import EARTH, check_gravity
from cspace.kinematics import Assembly
from cspace.kinematics.batch import Batch, check_robot, refuse_infinite, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.model import Description, tree
from cspace.spatial.checks import PoseLike
from cspace.spatial.rotations import skew
from cspace.spatial.vectors import cross

BODY: Final = ("m", "hx", "hy", "hz", "Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz")
"""The parameters of a body: mass [kg], first moments m c [kg·m], inertia about the origin [kg·m²]."""

RESISTANCES: Final = ("armature", "damping", "friction")
"""The parameters of joints, in the order of their columns."""

TENSOR: Final = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
"""Where the entries of a symmetric matrix stand among its six numbers, row by row."""

CHUNK: Final = 2_000_000
"""Entries of a regressor that long data are read in: 16 MB."""


class Described(Protocol):
    """A robot that branches is a Robot."""

    description: Description


@dataclass(frozen=True, eq=False)
class MovingBody:
    """What a joint carries, or a floating base (joint −1), in the frame of its first link.

    name: of the link, empty without one. R (3, 3), p (3,) [m]: the frame of the link in that of the joint.
    """

    joint: int
    name: str
    R: Array
    p: Array


@dataclass(frozen=True, eq=False)
class Motion:
    """How a frame moves, per row, in the axes of the world: R (rows, 3, 3), its position p, angular velocity
    w, angular acceleration alpha, and acceleration less gravity a, each (rows, 3)."""

    R: Array
    p: Array
    w: Array
    alpha: Array
    a: Array


def regressor(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    friction: bool = True,
    T_world_base: PoseLike | None = None,
) -> Array:
    """The matrix Y with tau = Y(q, q̇, q̈) π; see parameters for π.

    The columns do not depend on the masses of the robot, which may have none.

    q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,) [m/s²]. friction: with columns for damping and dry
    friction. T_world_base (..., 4, 4): where the base is.

    Returns Y (..., dof, p).
    Raises InputError for a wrong shape or NaN.

    Atkeson, An and Hollerbach 1986.
    """
    batch = rows_of(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base)
    refuse_infinite(batch)
    shape = (robot.dof, count_parameters(robot._assembly, friction))
    entries = len(batch.q) * shape[0] * shape[1]
    with guard_memory("q", f"an array of {len(batch.q)} rows", entries, "pass fewer"):
        Y = fill_regressor(robot, batch, check_gravity(gravity), friction)
    return Y.reshape((*batch.shape, *shape))


def parameters(robot: KinematicModel, *, friction: bool = True) -> Array:
    """The dynamic parameters π of a robot, with inverse_dynamics = regressor · π.

    Per moving body ten: its mass, its first moments m c and its inertia, row by row, about the origin and in
    the axes of the frame of the link that its joint moves; links fixed to this one count with it. Of a
    floating robot the base comes first. Then follow the armatures of all joints, mimicking ones included,
    their damping and their dry friction, the latter two only with friction.

    Returns π (n_parameters,).
    Raises InputTypeError for what is not a robot.
    """
    check_robot(robot)
    assembly = robot._assembly
    rows = [np.zeros(0)]
    for body in moving_bodies(assembly):
        k = body.joint + 1
        m, c = assembly.mass[k], body.R.T @ (assembly.center[k] - body.p)
        inertia = body.R.T @ assembly.inertia[k] @ body.R + m * (c @ c * np.eye(3) - np.outer(c, c))
        rows.append(np.concatenate([[m], m * c, inertia[np.triu_indices(3)]]))
    kinds = RESISTANCES if friction else RESISTANCES[:1]
    return np.concatenate([*rows, *(getattr(assembly, kind) for kind in kinds)])


def parameter_names(robot: KinematicModel, *, friction: bool = True) -> tuple[str, ...]:
    """The names of parameters(robot), such as m_forearm, Ixx_forearm and damping_elbow."""
    check_robot(robot)
    joints = moving_joints(robot)
    bodies = [body.name or joints[body.joint] for body in moving_bodies(robot._assembly)]
    names = [f"{symbol}_{body}" for body in bodies for symbol in BODY]
    kinds = RESISTANCES if friction else RESISTANCES[:1]
    return (*names, *(f"{kind}_{joint}" for kind in kinds for joint in joints))


def moving_joints(robot: KinematicModel) -> tuple[str, ...]:
    """The names of all joints that move, mimicking ones included."""
    chain = robot._assembly.chain
    if chain is not None:
        return chain.joint_names
    return tree(cast("Described", robot).description).joint_names


def count_parameters(assembly: Assembly, friction: bool) -> int:
    """How many columns a regressor has."""
    n = assembly.n_joints
    return len(BODY) * (n + assembly.floating) + (3 if friction else 1) * n


def moving_bodies(assembly: Assembly) -> list[MovingBody]:
    """The bodies whose parameters count: a floating base, and what each joint carries."""
    first: dict[int, MovingBody] = {}
    for name, index in assembly.frame_index.items():
        joint, T = int(assembly.frame_joint[index]), assembly.T_joint_frame[index]
        first.setdefault(joint, MovingBody(joint, name, T[:3, :3], T[:3, 3]))
    bodies = range(-1 if assembly.floating else 0, assembly.n_joints)
    # A planar joint is three in a row, of which the first two carry no link.
    return [first.get(k) or MovingBody(k, "", np.eye(3), np.zeros(3)) for k in bodies]


def factor_columns(A: Array) -> Array:
    """R of the QR factorisation of A (m, n), (min(m, n), n)."""
    return np.asarray(np.linalg.qr(A, mode="r"))


def cut_rows(batch: Batch, width: int) -> Iterator[Batch]:
    """The batch in parts whose regressors, of so many entries per row, have no more than CHUNK."""
    step = max(1, CHUNK // max(1, width))
    for begin in range(0, len(batch.q), step):
        part = slice(begin, begin + step)
        rows = {name: getattr(batch, name) for name in ("q", "qd", "qdd", "tau", "T_world_base")}
        yield replace(batch, **{k: v if v is None or len(v) == 1 else v[part] for k, v in rows.items()})


def fill_regressor(robot: KinematicModel, batch: Batch, gravity: Array, friction: bool) -> Array:
    """The regressor (rows, dof, p) of a batch with qd and qdd."""
    assembly, first = robot._assembly, 6 if robot.floating else 0
    bodies = moving_bodies(assembly)
    n, width = assembly.n_joints, len(BODY)
    qd, qdd = rates_of(batch)
    Y = np.zeros((len(batch.q), robot.dof, count_parameters(assembly, friction)))
    motions = move_joints(assembly, batch, gravity)
    for i, body in enumerate(bodies):
        link = move_along(motions[body.joint + 1], body.p)
        R = link.R @ body.R
        forces = body_wrenches(R, link)
        columns = slice(width * i, width * (i + 1))
        if first:
            Y[:, :6, columns] = base_twists(R, link.p - motions[0].p) @ forces
        above = joints_to(assembly, body.joint)
        torques = joint_twists(assembly, above, motions, R, link.p) @ forces
        for row, j in enumerate(above):
            Y[:, first + assembly.coordinate[j], columns] += torques[:, row]
    start = width * len(bodies)
    for j, (c, ratio) in enumerate(zip(first + assembly.coordinate, assembly.ratio, strict=True)):
        Y[:, c, start + j] = ratio**2 * qdd[:, c]
        if friction:
            Y[:, c, start + n + j] = ratio**2 * qd[:, c]
            Y[:, c, start + 2 * n + j] = ratio * np.sign(ratio * qd[:, c])
    return Y


def rates_of(batch: Batch) -> tuple[Array, Array]:
    """The velocities and accelerations (rows, dof) of a batch that has both."""
    assert batch.qd is not None
    assert batch.qdd is not None
    return batch.qd, batch.qdd


def joints_to(assembly: Assembly, joint: int) -> list[int]:
    """The joints that move what a joint carries, that joint first."""
    found = []
    while joint >= 0:
        found.append(joint)
        joint = int(assembly.parent[joint])
    return found


def move_joints(assembly: Assembly, batch: Batch, gravity: Array) -> list[Motion]:
    """The motion of the base and of every joint frame."""
    qd, qdd = rates_of(batch)
    rows = len(batch.q)
    T = np.broadcast_to(np.eye(4) if batch.T_world_base is None else batch.T_world_base, (rows, 4, 4))
    none, first = np.zeros((rows, 3)), 0
    base = Motion(T[:, :3, :3], T[:, :3, 3], none, none, none - gravity)
    if assembly.floating:
        first = 6
        base = replace(base, w=qd[:, 3:6], alpha=qdd[:, 3:6], a=qdd[:, :3] - gravity)
    motions = [base]
    for k, (parent, c) in enumerate(zip(assembly.parent.tolist(), assembly.coordinate.tolist(), strict=True)):
        ratio, placement = assembly.ratio[k], assembly.T_parent_joint[k]
        value, rate, push = (ratio * x[:, None] for x in (batch.q[:, c], qd[:, first + c], qdd[:, first + c]))
        value = value + assembly.offset[k]
        R = motions[parent + 1].R @ placement[:3, :3]
        z = R[:, :, 2]
        moved = move_along(motions[parent + 1], placement[:3, 3])
        if assembly.prismatic[k]:
            far = move_by(moved, value * z)
            a = far.a + push * z + 2.0 * rate * cross(far.w, z)
            motions.append(replace(far, R=R, a=a))
        else:
            w, alpha = moved.w + rate * z, moved.alpha + push * z + rate * cross(moved.w, z)
            motions.append(replace(moved, R=R @ turns_about_z(value[:, 0]), w=w, alpha=alpha))
    return motions


def move_along(frame: Motion, p: Array) -> Motion:
    """The motion of a frame with the same axes at p (3,), in its axes [m]."""
    return move_by(frame, frame.R @ p) if p.any() else frame


def move_by(frame: Motion, d: Array) -> Motion:
    """The motion of a frame with the same axes, further by d (rows, 3) in the axes of the world [m]."""
    a = frame.a + cross(frame.alpha, d) + cross(frame.w, cross(frame.w, d))
    return replace(frame, p=frame.p + d, a=a)


def turns_about_z(angle: Array) -> Array:
    """Rotations (rows, 3, 3) by angles (rows,) [rad] about z."""
    c, s = np.cos(angle), np.sin(angle)
    R = np.zeros((len(angle), 3, 3))
    R[:, 0, 0], R[:, 0, 1], R[:, 1, 0], R[:, 1, 1], R[:, 2, 2] = c, -s, s, c, 1.0
    return R


def body_wrenches(R: Array, link: Motion) -> Array:
    """(rows, 6, 10): force and torque on a body per unit of its parameters, at its origin, in its axes R."""
    w, alpha, a = (np.squeeze(x[:, None] @ R, 1) for x in (link.w, link.alpha, link.a))
    W = np.zeros((len(R), 6, len(BODY)))
    turning = skew(w)
    W[:, :3, 0] = a
    W[:, :3, 1:4] = skew(alpha) + turning @ turning
    W[:, 3:, 1:4] = -skew(a)
    W[:, 3:, 4:] = tensor_times(alpha) + turning @ tensor_times(w)
    return W


def tensor_times(x: Array) -> Array:
    """(rows, 3, 6) with I x = L(x) (Ixx, Ixy, Ixz, Iyy, Iyz, Izz) for x (rows, 3)."""
    L = np.zeros((len(x), 3, 6))
    for i, row in enumerate(TENSOR):
        L[:, i, row] = x
    return L


def joint_twists(assembly: Assembly, joints: list[int], motions: list[Motion], R: Array, p: Array) -> Array:
    """(rows, joints, 6): velocity [v; ω] of the frame at p, in its axes R, per unit rate of each joint."""
    S = np.zeros((len(p), len(joints), 6))
    for row, j in enumerate(joints):
        frame, ratio = motions[j + 1], assembly.ratio[j]
        axis = ratio * frame.R[:, :, 2]
        if assembly.prismatic[j]:
            S[:, row, :3] = axis
        else:
            S[:, row, :3], S[:, row, 3:] = cross(axis, p - frame.p), axis
    return np.concatenate([S[:, :, :3] @ R, S[:, :, 3:] @ R], axis=-1)


def base_twists(R: Array, d: Array) -> Array:
    """(rows, 6, 6): as joint_twists, per unit velocity [v; ω] of the base, d (rows, 3) behind the frame."""
    S = np.zeros((len(d), 6, 6))
    S[:, :3, :3] = S[:, 3:, 3:] = R
    S[:, 3:, :3] = skew(d) @ R
    return S
