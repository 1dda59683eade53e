"""Forward simulation: the motion of a robot under torques, gravity, friction and wrenches."""

from __future__ import annotations

import math
from dataclasses import replace
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import guard_memory, positive_number, whole_number
from cspace.dynamics.forward import forward_dynamics
from cspace.dynamics.mechanics import Mechanics, State, WrenchLaw, find_resistances
from cspace.dynamics.roll_out import (
    AT_LIMIT,
    BROKEN,
    ENDED,
    OUT_OF_TIME,
    Control,
    Record,
    Task,
    check_control,
    run_steps,
    spread_rows,
)
from cspace.dynamics.rows import EARTH, Wrenches, check_gravity, dynamic_rows, refuse_rows
from cspace.dynamics.simulation import Simulation
from cspace.dynamics.stiffness import name_stiff_friction, name_stiff_gain
from cspace.errors import InputError
from cspace.kinematics import LoopConstraints
from cspace.kinematics.batch import check_choice, check_flag, check_robot, thread_count
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tolerances import WHOLE_STEP

METHODS: Final = ("rk4", "variational", "adaptive")

FRICTION_SPEED: Final = 1e-2
"""Where dry friction has 76 % of its value [rad/s or m/s]: a hundredth of the speeds at which arms work."""

MOST_STEPS: Final = 10**12
"""Of a simulation: years of computation, and the times of neighbouring steps still differ."""


def simulate(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    *,
    control: Control | None = None,
    duration: float,
    dt: float,
    method: str | None = None,
    gravity: ArrayLike = EARTH,
    wrenches: Wrenches | WrenchLaw | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    friction_speed: float = FRICTION_SPEED,
    T_world_base: PoseLike | None = None,
    every: int = 1,
    stop_at_limits: bool = False,
    tolerance: float = 1e-9,
    dense: bool = True,
    time_limit: float | None = None,
    threads: int | None = None,
) -> Simulation:
    """The motion of a robot from a state on, under torques, gravity, friction and wrenches.

    q (..., n) [rad or m], qd (..., dof): the state at time zero; leading axes are motions that run side by
    side. control: torques tau (..., dof), None for zero; PD or ComputedTorque, which are compiled; or a
    function t, q, qd → tau. It is asked at the beginning of each step, and its torques are held over the
    step. duration [s]; dt [s]: the step. The last one ends with the duration.

    method: "rk4", the classical Runge–Kutta method, of order four, or, if the friction of a joint is too
    stiff for it, "variational", unless one is named. "variational": the variational midpoint
    rule of order two, whose energy does not drift and which conserves momenta. "adaptive": the method of
    Dormand and Prince with steps that keep the local error below `tolerance`, absolute and relative. Its
    states at multiples of dt are interpolated, and without control its steps may be longer.

    gravity (3,) [m/s²]. wrenches: frame → (..., 6), constant, or a function of t, q and qd that returns them,
    held over a step; expressed_in: as in forward_dynamics. friction: damping and dry friction of the joints;
    the latter is f tanh(q̇ / friction_speed), so joints creep instead of sticking. The variational method
    takes it implicitly; the others need steps shorter than the decay times of damped joints. T_world_base
    (..., 4, 4): where a floating base starts, or a fixed one stands.

    every: of so many states one is recorded, and the last. dense: the adaptive method also keeps its own
    steps, so that the answer is as accurate between records; they take memory.
    stop_at_limits: end where a joint passes one of its limits; otherwise limits do not count. time_limit [s]:
    of the computation, looked at between steps; rows are computed some at a time, others may not have begun.
    threads: as in fk.

    Returns a Simulation, which is falsy with a reason if it broke down.
    Raises InputError for a wrong shape or NaN, also of what control returns, for steps and durations that are
    not positive, a start outside of the limits that count, and where a joint moves no inertia;
    UnknownNameError for an unknown method or frame.

    Marsden and West 2001 (variational); Dormand and Prince 1980 (adaptive).
    """
    _refuse_loops(robot)
    mechanics = make_mechanics(robot, gravity, expressed_in, friction, friction_speed, threads)
    q = spread_rows(q, control, wrenches)
    start = check_start(robot, q, qd, T_world_base, threads, stop_at_limits)
    law = check_control(control, start.qd.shape)
    name = _choose_method(method, mechanics, start, dt)
    lengths, recorded = (duration, dt, tolerance), (every, dense)
    task = make_task(mechanics, name, start, law, wrenches, lengths, recorded, stop_at_limits, time_limit)
    rest = np.zeros_like(start.qd)
    forward_dynamics(robot, start.q, rest, rest, T_world_base=start.T_world_base)  # raises if M is singular
    with guard_memory("duration / dt", f"{task.steps} steps", task.size, "record fewer states (every=)"):
        return make_answer(task, run_steps(task))


def _refuse_loops(robot: KinematicModel) -> None:
    """Raise InputError for a robot whose description closes loops."""
    check_robot(robot)
    loops = robot.description.loops if hasattr(robot, "description") else ()
    if loops:
        raise InputError(
            f"{robot.name} has closed loops ({loops[0].name}), which simulate does not keep closed; use"
            " cspace.Mechanism(robot).simulate"
        )


def _check_step(dt: float) -> float:
    return positive_number(dt, "dt", "it must be one positive number [s]")


def _choose_method(method: str | None, mechanics: Mechanics, start: State, dt: float) -> str:
    """The named method; without a name that of Runge and Kutta unless friction is too stiff for it.

    InputError for RK4 where dry friction is: unlike damping, it would not break down, but creep.
    """
    if method is not None and check_choice(method, "method", METHODS) != "rk4":
        return method
    stiff = name_stiff_friction(mechanics, start, _check_step(dt))
    if method is None:
        return "rk4" if stiff is None else "variational"
    dry = replace(mechanics, damping=np.zeros_like(mechanics.damping))
    if stiff is not None and (reason := name_stiff_friction(dry, start, dt)) is not None:
        raise InputError(f'method "rk4" creeps: {reason}')
    return method


def make_mechanics(
    robot: KinematicModel,
    gravity: ArrayLike,
    expressed_in: str,
    friction: bool,
    friction_speed: float,
    threads: int | None,
) -> Mechanics:
    """What acts on a robot at every time, checked."""
    damping, dry = find_resistances(robot) if check_flag(friction, "friction") else np.zeros((2, robot.dof))
    return Mechanics(
        robot,
        check_gravity(gravity),
        check_choice(expressed_in, "expressed_in", ("base", "tip")),
        damping,
        dry,
        positive_number(friction_speed, "friction_speed", "it must be one positive number [rad/s or m/s]"),
        0 if threads is None else thread_count(threads, ()),
    )


def make_task(
    mechanics: Mechanics,
    method: str,
    start: State,
    control: Any,
    wrenches: Wrenches | WrenchLaw | None,
    lengths: tuple[float, float, float],
    recorded: tuple[int, bool],
    stop_at_limits: bool,
    time_limit: float | None,
    loops: LoopConstraints | None = None,
) -> Task:
    """The arguments of a simulation, checked. lengths: duration, dt, tolerance. recorded: every, dense.
    loops: that stay closed."""
    duration, dt, tolerance = lengths
    every, dense = recorded
    length = positive_number(duration, "duration", "it must be one positive number [s]")
    step = _check_step(dt)
    if length / step > MOST_STEPS:
        raise InputError(
            f"dt is {step:g} s; {length:g} s then take {length / step:.3g} steps, of {MOST_STEPS:g} at most"
        )
    late = math.inf if time_limit is None else perf_counter() + positive_number(time_limit, "time_limit")
    return Task(
        mechanics,
        method,
        start,
        control,
        wrenches,
        length,
        step,
        max(1, math.ceil(length / step - WHOLE_STEP)),
        whole_number(every, "every", 1, MOST_STEPS),
        stop_at_limits,
        positive_number(tolerance, "tolerance"),
        check_flag(dense, "dense"),
        late,
        loops,
    )


def check_start(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    T_world_base: PoseLike | None,
    threads: int | None,
    stop_at_limits: bool,
) -> State:
    """The state at time zero; leading axes are broadcast."""
    check_flag(stop_at_limits, "stop_at_limits")
    batch = dynamic_rows(robot, q, qd=qd, T_world_base=T_world_base, threads=threads)
    refuse_rows(batch)
    assert batch.qd is not None
    n, T = len(robot.joint_names), batch.T_world_base
    if robot.floating and T is None:
        T = np.eye(4)[None]
    if T is not None and robot.floating:
        T = np.broadcast_to(T, (len(batch.q), 4, 4)).reshape((*batch.shape, 4, 4)).copy()
    elif T is not None:
        T = T.reshape((*(batch.shape if len(T) > 1 else ()), 4, 4))
    start = State(batch.q.reshape((*batch.shape, n)), batch.qd.reshape((*batch.shape, robot.dof)), T)
    beyond = (start.q < robot.limits.lower) | (start.q > robot.limits.upper)
    if stop_at_limits and beyond.any():
        joint = int(np.argwhere(beyond)[0][-1])
        low, high = robot.limits.lower[joint], robot.limits.upper[joint]
        raise InputError(
            f"q starts with joint {robot.joint_names[joint]!r} outside of its limits, {low:g} to {high:g};"
            " start inside, or leave out stop_at_limits"
        )
    return start


def make_answer(task: Task, record: Record) -> Simulation:
    """The answer of what was recorded."""
    shape, count, states = task.shape, len(record.times), record.states
    q, qd, tau = (states[name].reshape(*shape, *states[name].shape[1:]) for name in ("q", "qd", "tau"))
    T = states["T_world_base"].reshape(*shape, count, 4, 4) if "T_world_base" in states else None
    good = (record.status == ENDED) | (record.status == AT_LIMIT)
    return Simulation(
        task.mechanics.robot.name,
        tuple(task.mechanics.robot.joint_names),
        task.method,
        record.times,
        q,
        qd,
        tau,
        states["energy"].reshape(*shape, count),
        states["momentum"].reshape(*shape, count, 6),
        T,
        record.stopped.reshape(shape),
        (record.status == ENDED).reshape(shape),
        _name_reason(task, record),
        bool(good.all()),
        record.pieces,
    )


def _name_reason(task: Task, record: Record) -> str:
    """How the simulation ended: its first row that did not come to its end, those that broke down before
    others."""
    status, method = record.status, task.method
    order = [
        int(row) for code in (BROKEN, OUT_OF_TIME, AT_LIMIT) for row in np.flatnonzero(status == code)[:1]
    ]
    if not order:
        return "ended"
    row = order[0]
    t = f"t = {record.stopped[row]:g} s" + (f" in row {row}" if task.shape else "")
    if status[row] == OUT_OF_TIME:
        return f"time limit, at {t}"
    if status[row] == AT_LIMIT:
        return f"limit reached: joint {task.mechanics.robot.joint_names[record.joint[row]]!r} at {t}"
    word = "not solved: no step from" if method == "variational" else "not finite: after"
    return f"{word} {t}; {_advise(task)}"


def _advise(task: Task) -> str:
    """What helps a simulation that broke down."""
    robot = task.mechanics.robot
    gain = name_stiff_gain(robot, task.control, task.start, task.dt)
    if gain is not None:
        return gain
    friction = name_stiff_friction(task.mechanics, task.start, task.dt) if task.method == "rk4" else None
    if friction is not None:
        return friction
    if task.method == "adaptive":
        return "no step is short enough"
    half = "; a base may not rotate by half a turn in one step" if robot.floating else ""
    return f"use a shorter dt{half}"
