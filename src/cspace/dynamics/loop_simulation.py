"""Forward simulation of robots with closed loops: Runge–Kutta steps, each projected back to closed loops."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import guard_memory
from cspace.dynamics.loop_dynamics import check_state, constrained_forward_dynamics
from cspace.dynamics.mechanics import WrenchLaw
from cspace.dynamics.roll_out import Control, check_control, run_steps, spread_rows
from cspace.dynamics.rows import EARTH, Wrenches
from cspace.dynamics.simulate import FRICTION_SPEED, check_start, make_answer, make_mechanics, make_task
from cspace.dynamics.simulation import Simulation
from cspace.kinematics import LoopConstraints
from cspace.kinematics.batch import check_choice
from cspace.spatial.checks import PoseLike


def simulate_loops(
    constraints: LoopConstraints,
    q: ArrayLike,
    qd: ArrayLike,
    *,
    control: Control | None = None,
    duration: float,
    dt: float,
    method: str = "rk4",
    gravity: ArrayLike = EARTH,
    wrenches: Wrenches | WrenchLaw | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    friction_speed: float = FRICTION_SPEED,
    T_world_base: PoseLike | None = None,
    every: int = 1,
    stop_at_limits: bool = False,
    time_limit: float | None = None,
    threads: int | None = None,
) -> Simulation:
    """The motion of a robot with closed loops from a state on, under torques, gravity, friction and wrenches.

    The classical Runge–Kutta method; after each step q and q̇ are projected to closed loops, along motions of
    least kinetic energy, so that the loops stay closed to rounding however long the motion is.

    q (..., n) [rad or m]: with closed loops. qd (..., dof): of which the part that keeps them closed counts.
    control, duration, dt, gravity (3,), wrenches, expressed_in, friction, friction_speed, T_world_base
    (..., 4, 4), every, stop_at_limits, time_limit, threads: as in simulate. method: "rk4".

    Returns a Simulation, which is falsy with a reason if it broke down.
    Raises InputError as simulate, for open loops, and where a motion that the loops allow moves no inertia.
    """
    name = check_choice(method, "method", ("rk4",))
    robot, q = constraints.robot, spread_rows(q, control, wrenches)
    closed = check_state(constraints, q, qd=qd, T_world_base=T_world_base, threads=threads)
    rest = np.zeros(robot.dof)
    constrained_forward_dynamics(constraints, closed.q, rest, rest, T_world_base=closed.T_world_base)
    mechanics = make_mechanics(robot, gravity, expressed_in, friction, friction_speed, threads)
    start = check_start(robot, q, qd, T_world_base, threads, stop_at_limits)
    task = make_task(
        mechanics,
        name,
        start,
        check_control(control, start.qd.shape),
        wrenches,
        (duration, dt, 1.0),
        (every, False),
        stop_at_limits,
        time_limit,
        constraints,
    )
    with guard_memory("duration / dt", f"{task.steps} steps", task.size, "record fewer states (every=)"):
        return make_answer(task, run_steps(task))
