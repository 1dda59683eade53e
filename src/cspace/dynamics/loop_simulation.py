"""Forward simulation of robots with closed loops: Runge–Kutta steps, each projected back to closed loops."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, guard_memory, leading_axes, positive_number, whole_number
from cspace.dynamics.constrained_motion import find_allowed_motions
from cspace.dynamics.controllers import PD, ComputedTorque
from cspace.dynamics.loop_dynamics import check_state, project_state, solve_accelerations
from cspace.dynamics.mass_matrix import mass_matrix
from cspace.dynamics.mechanics import Flags, State, advance_state, find_resistances
from cspace.dynamics.momentum import centroidal_momentum, kinetic_energy, potential_energy
from cspace.dynamics.rollout import Control, check_control, check_torques
from cspace.dynamics.rows import EARTH, Wrenches, check_gravity, check_mapping, check_wrench
from cspace.dynamics.simulation import Simulation
from cspace.errors import InputError
from cspace.kinematics import LoopConstraints
from cspace.kinematics.assembly import Numbers
from cspace.kinematics.batch import check_choice, check_flag
from cspace.kinematics.loop_constraints import Placement
from cspace.spatial import left_jacobian_inv_so3
from cspace.spatial.checks import PoseLike
from cspace.tolerances import LOOP_CLOSED, WHOLE_STEP

FRICTION_SPEED: Final = 1e-2
"""Where dry friction has 76 % of its value [rad/s or m/s]: a hundredth of the speeds at which arms work."""

MOST_STEPS: Final = 10**9
"""Of a simulation: weeks of computation."""

STAGES: Final = ((0.0, 1 / 6), (0.5, 1 / 3), (0.5, 1 / 3), (1.0, 1 / 6))
"""Where the classical Runge–Kutta method looks at the motion, and with which weight."""


@dataclass(frozen=True, eq=False)
class LoopTask:
    """What acts on a mechanism, checked. rank (rows,): of K at closed loops, the largest so far, see
    settle."""

    loops: LoopConstraints
    acts: dict[str, Any]
    control: Any
    wrenches: Wrenches | Callable[..., Wrenches] | None
    damping: Array
    dry: Array
    friction_speed: float
    threads: int | None
    lead: tuple[int, ...]
    rank: Numbers

    def shape(self, rows: Array) -> Array:
        """Rows with the leading axes that the user gave."""
        return rows.reshape((*self.lead, *rows.shape[1:]))

    def find_torques(self, t: float, state: State) -> Array:
        """The torques (rows, dof) of the control."""
        if self.control is None:
            return np.zeros_like(state.qd)
        q, qd = self.shape(state.q).copy(), self.shape(state.qd).copy()
        if isinstance(self.control, np.ndarray):
            return np.asarray(np.broadcast_to(self.control, state.qd.shape))
        if isinstance(self.control, PD | ComputedTorque):
            T = self._find_poses(state)
            tau: Any = self.control(self.loops.robot, t, q, qd, gravity=self.acts["gravity"], T_world_base=T)
        else:
            tau = self.control(t, q, qd)
        subject = f"the torque of control at t = {t:g} s"
        return np.asarray(np.broadcast_to(check_torques(tau, qd.shape, subject), state.qd.shape))

    def _find_poses(self, state: State) -> Array | None:
        T = state.T_world_base
        return T if T is None or len(T) != len(state.q) else self.shape(T)

    def find_wrenches(self, t: float, state: State) -> Wrenches | None:
        """The wrenches of the world, as rows."""
        wrenches = self.wrenches
        if callable(wrenches):
            wrenches = wrenches(t, self.shape(state.q).copy(), self.shape(state.qd).copy())
        check_mapping(wrenches)
        if not wrenches:
            return None
        full = {frame: check_wrench(w, frame) for frame, w in wrenches.items()}
        for frame, w in full.items():
            if leading_axes(wrenches=w.shape[:-1], q=self.lead) != self.lead:
                raise InputError(
                    f"wrench at {frame!r} has shape {w.shape}, expected {(*self.lead, 6)} as there are rows"
                    " of q"
                )
        return {
            frame: w if w.ndim == 1 else np.broadcast_to(w, (*self.lead, 6)).reshape(-1, 6)
            for frame, w in full.items()
        }

    def accelerations(self, state: State, tau: Array, wrenches: Wrenches | None) -> Array:
        """The accelerations (rows, dof) at a state whose loops may be slightly open."""
        at = self.loops.place(state.q)
        allowed = find_allowed_motions(self.loops, at, self.rank)
        rubs = self.damping * state.qd + self.dry * np.tanh(state.qd / self.friction_speed)
        acts = {**self.acts, "wrenches": wrenches}
        pose = state.T_world_base
        return solve_accelerations(
            self.loops, at, allowed, state.q, state.qd, tau - rubs, acts, pose, self.threads
        )

    def settle(self, state: State) -> State:
        """The nearest state whose loops are closed and stay closed; NaN in rows that cannot be closed.

        Between steps dependent rows of K are not quite dependent, so no more rows count than at closed loops
        before. A motion that began at a singular configuration, with a lower rank, gets to its full rank
        here.
        """
        M = mass_matrix(self.loops.robot, state.q, T_world_base=state.T_world_base, threads=self.threads)
        q, qd, at = project_state(self.loops, state.q, state.qd, M, self.rank)
        limit = LOOP_CLOSED * self.loops.length
        miss = self.loops.find_miss(at)
        if not (miss <= limit).all():
            q, qd, at = project_state(self.loops, state.q, state.qd, M)
            miss = self.loops.find_miss(at)
        self.remember_rank(at)
        open_rows = ~(miss <= limit)[:, None]
        return State(np.where(open_rows, np.nan, q), np.where(open_rows, np.nan, qd), state.T_world_base)

    def remember_rank(self, at: Placement) -> None:
        """Count the independent rows at closed loops."""
        allowed = find_allowed_motions(self.loops, at)
        np.maximum(self.rank, (allowed.s > 0.0).sum(axis=-1), out=self.rank)

    def step(self, state: State, tau: Array, wrenches: Wrenches | None, h: float) -> State:
        """The state after one step of the classical Runge–Kutta method, before it is projected."""
        floating, inner = self.loops.robot.floating, state
        dx, dv = np.zeros_like(state.qd), np.zeros_like(state.qd)
        rate = acceleration = np.zeros_like(state.qd)
        for share, weight in STAGES:
            moved = h * share * rate
            inner = advance_state(state, moved, h * share * acceleration, floating) if share else state
            if inner.wild().any():
                return State(np.full_like(state.q, np.nan), state.qd, state.T_world_base)
            rate = find_displacement_rate(inner, moved, floating)
            acceleration = self.accelerations(inner, tau, wrenches)
            dx, dv = dx + h * weight * rate, dv + h * weight * acceleration
        return advance_state(state, dx, dv, floating)


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
    wrenches: Wrenches | Callable[..., Wrenches] | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    friction_speed: float = FRICTION_SPEED,
    T_world_base: PoseLike | None = None,
    every: int = 1,
    time_limit: float | None = None,
    threads: int | None = None,
) -> Simulation:
    """The motion of a robot with closed loops from a state on, under torques, gravity, friction and wrenches.

    The classical Runge–Kutta method; after each step q and q̇ are projected to closed loops, along motions of
    least kinetic energy, so that the loops stay closed to rounding however long the motion is.

    q (..., n) [rad or m]: with closed loops. qd (..., dof): of which the part that keeps them closed counts.
    control, duration, dt, gravity (3,), wrenches, expressed_in, friction, friction_speed, T_world_base
    (..., 4, 4), every, time_limit, threads: as in simulate. method: "rk4".

    Returns a Simulation, which is falsy with a reason if it broke down.
    Raises InputError as simulate, for open loops, and where a motion that the loops allow moves no inertia.
    """
    check_choice(method, "method", ("rk4",))
    length, step = (
        positive_number(value, name, "it must be one positive number [s]")
        for name, value in (("duration", duration), ("dt", dt))
    )
    if length / step > MOST_STEPS:
        raise InputError(
            f"dt is {step:g} s; {length:g} s then take {length / step:.3g} steps, of {MOST_STEPS:g}"
        )
    stride, steps = whole_number(every, "every", 1, MOST_STEPS), max(1, math.ceil(length / step - WHOLE_STEP))
    late = math.inf if time_limit is None else perf_counter() + positive_number(time_limit, "time_limit")
    batch = check_state(constraints, q, qd=qd, T_world_base=T_world_base, threads=threads)
    assert batch.qd is not None
    control = check_control(control, (*batch.shape, constraints.robot.dof))
    robot, pose = constraints.robot, batch.T_world_base
    if robot.floating:
        pose = np.broadcast_to(np.eye(4) if pose is None else pose, (len(batch.q), 4, 4)).copy()
    acts = {
        "gravity": check_gravity(gravity),
        "expressed_in": check_choice(expressed_in, "expressed_in", ("base", "tip")),
        "friction": False,
    }
    damping, dry = find_resistances(robot) if check_flag(friction, "friction") else np.zeros((2, robot.dof))
    speed = positive_number(friction_speed, "friction_speed", "it must be one positive number [rad/s or m/s]")
    rank = np.zeros(len(batch.q), dtype=np.intp)
    task = LoopTask(constraints, acts, control, wrenches, damping, dry, speed, threads, batch.shape, rank)
    task.remember_rank(constraints.place(batch.q))
    start = task.settle(State(batch.q, batch.qd, pose))
    numbers = (steps / stride + 2) * start.qd.size * (16.0 if robot.floating else 4.0)
    with guard_memory("duration / dt", f"{steps} steps", numbers, "record fewer states (every=)"):
        return run_steps(task, start, length, step, steps, stride, late)


def run_steps(
    task: LoopTask, state: State, duration: float, dt: float, steps: int, every: int, late: float
) -> Simulation:
    """The simulation of so many steps, of which every so many are recorded, and the last."""
    times, states, torques = [0.0], [state], [task.find_torques(0.0, state)]
    stopped = np.full(len(state.q), np.inf)
    reason, t, tau = "ended", 0.0, torques[0]
    for k in range(steps):
        if perf_counter() > late:
            stopped = np.minimum(stopped, t)
            reason = f"time limit, at t = {t:g} s"
            break
        t_after = duration if k == steps - 1 else (k + 1) * dt
        after = task.step(state, tau, task.find_wrenches(t, state), t_after - t)
        after = settle_rows(task, state, after)
        broken = after.wild() & ~np.isfinite(stopped)
        stopped[broken] = t
        state = after.with_rows(after.wild(), state)
        if np.isfinite(stopped).all():
            break
        t = t_after
        tau = task.find_torques(t, state)
        if (k + 1) % every == 0 or k == steps - 1:
            times.append(t)
            states.append(hide_rows(state, np.isfinite(stopped)))
            torques.append(np.where(np.isfinite(stopped)[:, None], np.nan, tau))
    if times[-1] < t:
        times.append(t)
        states.append(hide_rows(state, stopped < t))
        torques.append(np.where((stopped < t)[:, None], np.nan, tau))
    if reason == "ended" and np.isfinite(stopped).any():
        row = int(np.flatnonzero(np.isfinite(stopped))[0])
        where = f" in row {row}" if task.lead else ""
        reason = f"not finite: after t = {stopped[row]:g} s{where}; use a shorter dt"
    ended = ~np.isfinite(stopped)
    return make_answer(task, np.array(times), states, torques, np.minimum(stopped, t), ended, reason)


def settle_rows(task: LoopTask, before: State, after: State) -> State:
    """The state after a step, projected; rows that are not finite stay NaN."""
    wild = after.wild()
    if not wild.any():
        return task.settle(after)
    return hide_rows(task.settle(after.with_rows(wild, before)), wild)


def hide_rows(state: State, rows: Flags) -> State:
    """The state with NaN in some rows."""
    if not rows.any():
        return state
    q, qd = (np.where(rows[:, None], np.nan, each) for each in (state.q, state.qd))
    return State(q, qd, state.T_world_base)


def find_displacement_rate(state: State, dx: Array, floating: bool) -> Array:
    """The rate of the displacement dx (rows, dof) that led to a state: of a rotation vector u' = J⁻¹(u) ω."""
    if not floating:
        return state.qd
    rate = state.qd.copy()
    rate[:, 3:6] = np.einsum("rij,rj->ri", left_jacobian_inv_so3(dx[:, 3:6]), state.qd[:, 3:6])
    return rate


def make_answer(
    task: LoopTask,
    times: Array,
    states: list[State],
    torques: list[Array],
    stopped: Array,
    ended: Flags,
    reason: str,
) -> Simulation:
    """The answer of what was recorded."""
    robot = task.loops.robot
    q, qd, tau = (np.stack(each, axis=1) for each in ([s.q for s in states], [s.qd for s in states], torques))
    moves = [s.T_world_base for s in states if s.T_world_base is not None]
    T = np.stack(moves, axis=1) if robot.floating else None
    place = T if T is not None else (moves[0][:, None] if moves else None)
    lost = np.asarray(~np.isfinite(qd).all(axis=-1, keepdims=True))
    q_safe, qd_safe = (np.where(lost, 0.0, each) for each in (q, qd))
    energy = kinetic_energy(robot, q_safe, qd_safe, T_world_base=place, threads=task.threads)
    energy = energy + potential_energy(
        robot, q_safe, gravity=task.acts["gravity"], T_world_base=place, threads=task.threads
    )
    energy = np.where(lost[..., 0], np.nan, energy)
    momentum = centroidal_momentum(robot, q_safe, qd_safe, T_world_base=place, threads=task.threads)
    momentum = np.where(lost, np.nan, momentum)
    if T is not None:
        T = np.where(lost[..., None], np.nan, T)
    q, qd, tau, energy, momentum = (task.shape(each) for each in (q, qd, tau, energy, momentum))
    stopped = task.shape(stopped)
    ended = ended.reshape(task.lead)
    T = T if T is None else task.shape(T)
    truth, names = bool(ended.all()), tuple(robot.joint_names)
    return Simulation(
        robot.name, names, "rk4", times, q, qd, tau, energy, momentum, T, stopped, ended, reason, truth
    )
