"""The regressor of inverse dynamics: the torques are linear in the masses of the robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, Protocol, cast

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, guard_memory
from cspace.dynamics.rows import EARTH, check_gravity, refuse_missing, refuse_rows, run_rows
from cspace.kinematics import Assembly
from cspace.kinematics.batch import Batch, check_flag, check_output, check_robot, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.model import Description, tree
from cspace.spatial.checks import PoseLike

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


def regressor(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The matrix Y with tau = Y(q, q̇, q̈) π; see parameters for π.

    The columns do not depend on the masses of the robot, which may have none.

    q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,) [m/s²]. friction: with columns for damping and dry
    friction. T_world_base (..., 4, 4): where the base is. out (..., dof, p): float64 array to write into.
    threads: as in fk.

    Returns Y (..., dof, p).
    Raises InputError for a wrong shape or NaN.

    Atkeson, An and Hollerbach 1986.
    """
    refuse_missing(qd=qd, qdd=qdd)
    batch = rows_of(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    shape = (robot.dof, count_parameters(robot._assembly, friction))
    entries = len(batch.q) * shape[0] * shape[1]
    with guard_memory("q", f"an array of {len(batch.q)} rows", entries, "pass fewer"):
        Y = check_output(out, (*batch.shape, *shape))
    if not run_rows(robot, "regressor", batch, batch.qdd, Y, check_gravity(gravity), friction):
        refuse_rows(batch)
    return Y


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
    return np.concatenate([*rows, *(getattr(assembly, kind) for kind in list_resistances(friction))])


def parameter_names(robot: KinematicModel, *, friction: bool = True) -> tuple[str, ...]:
    """The names of parameters(robot), such as m_forearm, Ixx_forearm and damping_elbow."""
    check_robot(robot)
    joints = moving_joints(robot)
    bodies = [body.name or joints[body.joint] for body in moving_bodies(robot._assembly)]
    names = [f"{symbol}_{body}" for body in bodies for symbol in BODY]
    return (*names, *(f"{kind}_{joint}" for kind in list_resistances(friction) for joint in joints))


def moving_joints(robot: KinematicModel) -> tuple[str, ...]:
    """The names of all joints that move, mimicking ones included."""
    chain = robot._assembly.chain
    if chain is not None:
        return chain.joint_names
    return tree(cast("Described", robot).description).joint_names


def count_parameters(assembly: Assembly, friction: bool) -> int:
    """How many columns a regressor has."""
    n = assembly.n_joints
    return len(BODY) * (n + assembly.floating) + len(list_resistances(friction)) * n


def list_resistances(friction: bool) -> tuple[str, ...]:
    """The parameters of a joint; InputTypeError for a flag that is neither True nor False."""
    return RESISTANCES if check_flag(friction, "friction") else RESISTANCES[:1]


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
    Y = np.empty((len(batch.q), robot.dof, count_parameters(robot._assembly, friction)))
    run_rows(robot, "regressor", batch, batch.qdd, Y, gravity, friction)
    return Y
