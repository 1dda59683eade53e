"""Dynamics of robots with closed loops: accelerations, driven torques, forces in the loops, and
projection."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, leading_axes
from cspace.dynamics.constrained_motion import AllowedMotions, find_allowed_motions, solve_least_energy
from cspace.dynamics.inverse import inverse_dynamics
from cspace.dynamics.mass_matrix import mass_matrix
from cspace.dynamics.rows import EARTH, Wrenches, dynamic_rows, refuse_missing, refuse_rows
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics import LoopConstraints
from cspace.kinematics.assembly import Numbers
from cspace.kinematics.batch import Batch, check_output
from cspace.kinematics.loop_closure import number_coordinates
from cspace.kinematics.loop_constraints import Placement
from cspace.spatial.checks import PoseLike
from cspace.tables import count_things, join_words
from cspace.tolerances import FARTHEST, LOOP_MOTION, LOOP_OPEN, LOOP_RANK, LOOP_SINGULAR


def constrained_forward_dynamics(
    constraints: LoopConstraints,
    q: ArrayLike,
    qd: ArrayLike,
    tau: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    wrenches: Wrenches | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The accelerations of a robot with closed loops under given torques.

    M q̈ + h = τ + Kᵀ λ with K q̈ + k = 0. The acceleration is unique also where rows of K depend on each
    other (Udwadia and Kalaba 1992).

    q (..., n) [rad or m]: with closed loops. qd (..., dof): velocities that keep them closed. tau (..., dof),
    gravity (3,), wrenches, expressed_in, friction, T_world_base (..., 4, 4), out (..., dof), threads: as in
    forward_dynamics. Returns qdd (..., dof). Raises InputError for a wrong shape or NaN, open loops,
    velocities that tear them apart, and where a motion that the loops allow moves no inertia;
    UnknownNameError for an unknown frame.
    """
    acts = pack_acts(gravity, wrenches, expressed_in, friction)
    batch = check_state(constraints, q, qd=qd, tau=tau, T_world_base=T_world_base, threads=threads)
    at = constraints.place(batch.q)
    assert batch.qd is not None
    assert batch.tau is not None
    check_motion(constraints, at, qd=batch.qd)
    allowed = find_allowed_motions(constraints, at)
    robot, T, none = constraints.robot, batch.T_world_base, np.zeros_like(batch.qd)
    h = inverse_dynamics(robot, batch.q, batch.qd, none, T_world_base=T, threads=threads, **acts)
    M = mass_matrix(robot, batch.q, T_world_base=T, threads=threads)
    k = constraints.find_bias(at, batch.qd)
    qdd = solve_least_energy(allowed, M, -k, batch.tau - h, robot.name)
    return fill_output(out, qdd, (*batch.shape, constraints.robot.dof))


def constrained_inverse_dynamics(
    constraints: LoopConstraints,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    driven: Sequence[str],
    *,
    gravity: ArrayLike = EARTH,
    wrenches: Wrenches | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The torques of driven joints behind a motion of a robot with closed loops.

    With a basis G of the motions that the loops allow the torques of the tree do the same work as those of
    the driven joints: G_dᵀ τ = Gᵀ τ_tree. More driven joints than degrees of freedom share the work with the
    least sum of squares.

    q (..., n) [rad or m]: with closed loops. qd, qdd (..., dof): a motion that keeps them closed, as
    loop_velocities and loop_accelerations return. driven: names of joints. gravity (3,), wrenches,
    expressed_in, friction, T_world_base (..., 4, 4), out (..., dof), threads: as in inverse_dynamics. Returns
    tau (..., dof), zero but for the driven joints. Raises InputError for a wrong shape or NaN, open loops, a
    motion that tears them apart, and where the driven joints do not determine the motion, as at a dead point;
    UnknownNameError for an unknown joint or frame.
    """
    robot = constraints.robot
    acts = pack_acts(gravity, wrenches, expressed_in, friction)
    batch = check_state(constraints, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    assert batch.qd is not None
    assert batch.qdd is not None
    numbers = number_driven(constraints, driven)
    at = constraints.place(batch.q)
    check_motion(constraints, at, qd=batch.qd, qdd=batch.qdd)
    tree = inverse_dynamics(
        robot, batch.q, batch.qd, batch.qdd, T_world_base=batch.T_world_base, threads=threads, **acts
    )
    allowed = find_allowed_motions(constraints, at)
    check_driving(constraints, allowed, numbers, driven, batch)
    G = allowed.find_basis()
    work = np.einsum("...ij,...i->...j", G, tree)
    unit = allowed.unit[numbers]
    shares = (G[..., numbers, :] / unit[:, None]).swapaxes(-1, -2)
    tau = np.zeros_like(tree)
    tau[..., numbers] = np.einsum("...ij,...j->...i", np.linalg.pinv(shares, rcond=LOOP_RANK), work) / unit
    return fill_output(out, tau, (*batch.shape, robot.dof))


def loop_wrenches(
    constraints: LoopConstraints,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    tau: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    wrenches: Wrenches | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The forces in closed loops during a motion under torques: what each loop exerts on its child link.

    Where rows of K depend on each other only a part of the forces is determined; the others are those of the
    least sum of squares, with lengths in units of the size of the mechanism.

    q (..., n), qd, qdd, tau (..., dof): a motion and its torques, from constrained_forward_dynamics or
    constrained_inverse_dynamics; gravity (3,), out (..., loops, 6) and all else as there. Returns (...,
    loops, 6): force and torque [N, N·m] at the origin of the loop's frame in the child, in axes of the base.
    Raises InputError for a wrong shape or NaN, and open loops.
    """
    robot = constraints.robot
    acts = pack_acts(gravity, wrenches, expressed_in, friction)
    batch = check_state(constraints, q, qd=qd, qdd=qdd, tau=tau, T_world_base=T_world_base, threads=threads)
    assert batch.qd is not None
    assert batch.qdd is not None
    assert batch.tau is not None
    tree = inverse_dynamics(
        robot, batch.q, batch.qd, batch.qdd, T_world_base=batch.T_world_base, threads=threads, **acts
    )
    allowed = find_allowed_motions(constraints, constraints.place(batch.q))
    forces = constraints.wrenches(batch.q, allowed.solve_multipliers(tree - batch.tau))
    return fill_output(out, forces, (*batch.shape, *forces.shape[-2:]))


def loop_velocities(
    constraints: LoopConstraints,
    q: ArrayLike,
    driven: Mapping[str, ArrayLike],
    *,
    out: Array | None = None,
) -> Array:
    """The velocities of all joints when the driven ones move at given rates.

    q (..., n) [rad or m]: with closed loops. driven: joint → velocity (...) [rad/s or m/s]. out (..., dof).
    Returns qd (..., dof). Raises InputError for a wrong shape or NaN, open loops, rates that the loops do not
    allow, and where the driven joints do not determine the motion; UnknownNameError for an unknown joint.
    """
    return find_rates(constraints, q, None, driven, out)


def loop_accelerations(
    constraints: LoopConstraints,
    q: ArrayLike,
    qd: ArrayLike,
    driven: Mapping[str, ArrayLike],
    *,
    out: Array | None = None,
) -> Array:
    """The accelerations of all joints when the driven ones accelerate at given rates.

    q (..., n) [rad or m], qd (..., dof): as from loop_velocities. driven: joint → acceleration (...).
    out (..., dof). Returns qdd (..., dof). Raises as loop_velocities.
    """
    refuse_missing(qd=qd)
    return find_rates(constraints, q, qd, driven, out)


def find_rates(
    constraints: LoopConstraints, q: ArrayLike, qd: ArrayLike | None, driven: Any, out: Array | None
) -> Array:
    """The rates x (..., dof) with K x + k = 0 and given values of driven joints; k = 0 without velocities."""
    if not isinstance(driven, Mapping):
        raise InputTypeError(f"driven is {name_type(driven)}, expected a dict of joint → rate")
    robot = constraints.robot
    if robot.floating:
        raise InputError(f"{robot.name} has a floating base, which the driven joints do not move")
    numbers = number_driven(constraints, list(driven))
    rates = [as_floats(value, f"driven {name!r}", largest=FARTHEST) for name, value in driven.items()]
    leading_axes(**{f"driven {name!r}": rate.shape for name, rate in zip(driven, rates, strict=True)})
    values = np.stack(np.broadcast_arrays(*rates), axis=-1)
    given = np.zeros((*values.shape[:-1], robot.dof))
    given[..., numbers] = values
    batch = check_state(constraints, q, qd=np.zeros(robot.dof) if qd is None else qd, qdd=given)
    assert batch.qd is not None
    assert batch.qdd is not None
    at = constraints.place(batch.q)
    allowed = find_allowed_motions(constraints, at)
    check_driving(constraints, allowed, numbers, list(driven), batch)
    x = allowed.solve_rates(-constraints.find_bias(at, batch.qd))
    G = allowed.find_basis()
    unit = allowed.unit[numbers]
    lacks = (batch.qdd - x)[..., numbers] / unit
    y = np.einsum(
        "...ij,...j->...i", np.linalg.pinv(G[..., numbers, :] / unit[:, None], rcond=LOOP_RANK), lacks
    )
    x = x + np.einsum("...ij,...j->...i", G, y)
    off = np.abs((x - batch.qdd)[..., numbers] / unit).max(axis=-1, initial=0.0)
    if (
        off > LOOP_MOTION * np.maximum(np.abs(x / allowed.unit).max(axis=-1, initial=0.0), LOOP_MOTION)
    ).any():
        raise InputError(
            f"the loops of {robot.name} do not allow these rates of {join_words(list(driven))} together;"
            " drive as many joints as there are degrees of freedom"
        )
    return fill_output(out, x, (*batch.shape, robot.dof))


def pack_acts(
    gravity: ArrayLike, wrenches: Wrenches | None, expressed_in: str, friction: bool
) -> dict[str, Any]:
    """What acts on a robot, as keywords of inverse_dynamics."""
    return {"gravity": gravity, "wrenches": wrenches, "expressed_in": expressed_in, "friction": friction}


def check_state(constraints: LoopConstraints, q: ArrayLike, **arguments: Any) -> Batch:
    """The arguments of a call as rows. Raises InputError as of dynamic_rows, and for open loops."""
    if not isinstance(constraints, LoopConstraints):
        raise InputTypeError(f"the first argument must be LoopConstraints, got {type(constraints).__name__}")
    batch = dynamic_rows(constraints.robot, q, **arguments)
    refuse_rows(batch)
    miss = constraints.find_miss(constraints.place(batch.q))
    open_rows = np.flatnonzero(~(miss <= LOOP_OPEN * constraints.length))
    if open_rows.size:
        row = int(open_rows[0])
        at = "" if not batch.shape else f" in row {row}"
        raise InputError(
            f"loop {constraints.name_open_loop(batch.q[row])!r} is open by {miss[row]:.3g} m"
            f" at q{at}; close_loops finds a configuration near it that is closed"
        )
    return batch


def fill_output(out: Array | None, values: Array, shape: tuple[int, ...]) -> Array:
    """The values of an answer, in out if it is given."""
    if out is None:
        return values.reshape(shape)
    check_output(out, shape)[...] = values.reshape(shape)
    return out


def check_motion(constraints: LoopConstraints, at: Placement, qd: Array, qdd: Array | None = None) -> None:
    """Raise InputError where velocities or accelerations (rows, dof) tear loops apart."""
    K, scale = constraints.find_jacobian(at), constraints.scale
    rates: list[tuple[str, Array, Any]] = [("qd", qd, 0.0)]
    if qdd is not None:
        rates.append(("qdd", qdd, constraints.find_bias(at, qd)))
    for word, x, k in rates:
        torn = np.abs((np.einsum("...ij,...j->...i", K, x) + k) * scale)
        size = np.einsum("...ij,...j->...i", np.abs(K) * scale[:, None], np.abs(x)) + np.abs(k * scale)
        bad = torn > LOOP_MOTION * np.maximum(size.max(axis=-1, initial=0.0)[..., None], LOOP_MOTION)
        if bad.any():
            row = constraints.rows[int(np.argwhere(bad)[0][-1])]
            rate = "velocities" if word == "qd" else "accelerations"
            raise InputError(
                f"{word} tears a loop apart (row {row!r}); loop_{rate} finds those that keep it closed"
            )


def number_driven(constraints: LoopConstraints, driven: Any) -> Numbers:
    """The numbers of driven joints among the velocities. Raises InputError for none, InputTypeError for
    text."""
    if isinstance(driven, str) or not isinstance(driven, Sequence):
        raise InputTypeError(f"driven is {driven!r}, expected a list of joint names")
    if not driven:
        raise InputError(f"no driven joints; name some of {', '.join(constraints.robot.joint_names)}")
    robot = constraints.robot
    numbers: Numbers = number_coordinates(constraints, list(driven)) + robot.dof - len(robot.joint_names)
    return numbers


def check_driving(
    constraints: LoopConstraints,
    allowed: AllowedMotions,
    numbers: Numbers,
    driven: Sequence[str],
    batch: Batch,
) -> None:
    """Raise InputError where driven joints do not determine the motion."""
    G = allowed.V * allowed.free[..., None, :]
    rank = np.sum(np.linalg.svd(G[..., numbers, :], compute_uv=False) > LOOP_SINGULAR, axis=-1)
    dof = allowed.free.sum(axis=-1)
    bad = np.flatnonzero(rank < dof)
    if bad.size:
        row = int(bad[0])
        where = f" in row {row}" if batch.shape else ""
        one = len(driven) == 1
        raise InputError(
            f"driven {'joint' if one else 'joints'} {join_words([repr(name) for name in driven])}"
            f" {'does' if one else 'do'} not determine the motion of {constraints.robot.name}{where}, which"
            f" has {count_things(int(dof[row]), 'degree')} of freedom there: a dead point, or too few driven"
            " joints"
        )
