"""The loops of a simulation: what acts, a step, and what is recorded, until all rows have ended."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, leading_axes
from cspace.dynamics.controllers import PD, ComputedTorque
from cspace.dynamics.explicit_steps import (
    DORMAND_PRINCE,
    DORMAND_PRINCE_DENSE,
    DORMAND_PRINCE_END,
    DORMAND_PRINCE_ERROR,
    Stages,
    find_stages,
    step_rk4,
)
from cspace.dynamics.mechanics import Drive, Flags, Mechanics, State, WrenchLaw, advance_state
from cspace.dynamics.rows import Wrenches
from cspace.dynamics.simulation import Piece
from cspace.dynamics.variational_step import step_variational
from cspace.errors import InputError, InputTypeError
from cspace.tolerances import FARTHEST, SHORTEST_STEP

Control = Callable[[float, Array, Array], ArrayLike] | PD | ComputedTorque

STEPS: Final = {"rk4": step_rk4, "variational": step_variational}

STEP_SAFETY, SLOWEST, FASTEST = 0.9, 0.2, 5.0
"""The next step of the adaptive method, relative to the one that would just do, and the bounds of its change
(Hairer, Nørsett and Wanner 1993, section II.4)."""

ERROR_ORDER: Final = 5
"""The power of the step with which the error of one step falls."""

RUNNING, ENDED, AT_LIMIT, BROKEN, OUT_OF_TIME = range(5)
"""How a row stands: before its end, after its duration, at a limit of a joint, without a next state, or cut
off by the time limit."""


@dataclass(frozen=True, eq=False)
class Task:
    """The arguments of a simulation, checked; steps is how many of length dt, the last one up to the
    duration."""

    mechanics: Mechanics
    start: State
    control: Control | None
    wrenches: Wrenches | WrenchLaw | None
    duration: float
    dt: float
    steps: int
    every: int
    stop_at_limits: bool
    tolerance: float
    deadline: float

    @property
    def held(self) -> bool:
        """Whether something is held over each step or looked at after it, so that no step may be longer."""
        return self.control is not None or callable(self.wrenches) or self.stop_at_limits

    @property
    def late(self) -> bool:
        """Whether the time limit has passed."""
        return perf_counter() > self.deadline

    def find_time(self, k: int) -> float:
        """When step k begins [s]."""
        return self.duration if k == self.steps else k * self.dt

    def find_record(self, k: int) -> int | None:
        """The number of the record at the beginning of step k, if there is one."""
        if k == self.steps:
            return -(-k // self.every)
        return None if k % self.every else k // self.every

    def find_drive(self, k: int, state: State) -> Drive:
        """What is held from the beginning of step k on."""
        wrenches = self.wrenches
        if callable(wrenches):
            wrenches = wrenches(self.find_time(k), state.q.copy(), state.qd.copy())
        check_wrenches(wrenches, state.qd.shape[:-1])
        return Drive(self.find_torques(k, state), wrenches)

    def find_torques(self, k: int, state: State) -> Array:
        """The torques (..., dof) of the control at the beginning of step k."""
        t, q, qd = self.find_time(k), state.q.copy(), state.qd.copy()
        if self.control is None:
            return np.zeros_like(qd)
        if isinstance(self.control, PD | ComputedTorque):
            gravity, T = self.mechanics.gravity, state.T_world_base
            tau: Any = self.control(self.mechanics.robot, t, q, qd, gravity=gravity, T_world_base=T)
        else:
            tau = self.control(t, q, qd)
        return check_torques(tau, qd.shape, f"the torque of control at step {k} (t = {t:g} s)")


def check_torques(tau: Any, shape: tuple[int, ...], subject: str) -> Array:
    """What a control returned as (..., dof); InputError for another shape or NaN."""
    if tau is None:
        raise InputTypeError(f"{subject} is None; a control returns the torques")
    array = as_floats(tau, subject, largest=FARTHEST)
    fits = array.shape[-1:] == shape[-1:] and array.ndim <= len(shape)
    fits = fits and all(n in (1, m) for n, m in zip(array.shape[::-1], shape[::-1], strict=False))
    if not fits:
        raise InputError(
            f"{subject} has shape {array.shape}, expected {shape}: one torque or force per joint,"
            " of a floating base its wrench [f; n] first"
        )
    return np.broadcast_to(array, shape)


def check_wrenches(wrenches: Wrenches | None, lead: tuple[int, ...]) -> None:
    """InputError for wrenches that are for more rows than there are; see also torques_of_wrenches."""
    for frame, wrench in wrenches.items() if isinstance(wrenches, Mapping) else ():
        shape = as_floats(wrench, f"wrench at {frame!r}", last=(6,)).shape
        if leading_axes(wrenches=shape[:-1], q=lead) != lead:
            raise InputError(
                f"wrench at {frame!r} has shape {shape}, expected {(*lead, 6)} as there are rows of q"
            )


class Record:
    """The states of a simulation as they come: times (k,), arrays (..., k, …), and how each row (...)
    stands."""

    def __init__(self, task: Task) -> None:
        start, count = task.start, -(-task.steps // task.every) + 1
        lead = start.qd.shape[:-1]
        self.task, self.count = task, 0
        self.times = np.empty(count)
        self.q = np.full((*lead, count, start.q.shape[-1]), np.nan)
        self.qd, self.tau = (np.full((*lead, count, start.qd.shape[-1]), np.nan) for _ in range(2))
        floating = task.mechanics.robot.floating
        self.T_world_base = np.full((*lead, count, 4, 4), np.nan) if floating else None
        self.stopped = np.full(lead, np.inf)
        self.status = np.full(lead, RUNNING)
        self.joint = np.zeros(lead, dtype=int)
        self.pieces: list[Piece] = []

    @property
    def running(self) -> Flags:
        """Which rows (...) go on."""
        result: Flags = np.asarray(self.status == RUNNING)
        return result

    def write(self, t: float, state: State, tau: Array) -> None:
        """Record a state; rows that stopped before stay NaN."""
        k, valid = self.count, (self.stopped >= t)[..., None]
        self.times[k] = t
        self.q[..., k, :] = np.where(valid, state.q, np.nan)
        self.qd[..., k, :] = np.where(valid, state.qd, np.nan)
        self.tau[..., k, :] = np.where(valid, tau, np.nan)
        if self.T_world_base is not None and state.T_world_base is not None:
            self.T_world_base[..., k, :, :] = np.where(valid[..., None], state.T_world_base, np.nan)
        self.count += 1

    def end_rows(self, before: State, after: State, t: float, t_after: float, failed: Flags) -> State:
        """The state from which to go on: rows that broke down or passed a limit have ended and stay."""
        running = self.running
        broken = running & (after.wild() | failed)
        if broken.any():
            self._stop(broken, BROKEN, t)
        if self.task.stop_at_limits:
            self._stop_at_limits(after, running & ~broken, t_after)
        halted = broken | ~running
        return after.with_rows(halted, before) if halted.any() else after

    def _stop_at_limits(self, state: State, rows: Flags, t: float) -> None:
        limits = self.task.mechanics.robot.limits
        beyond = (state.q < limits.lower) | (state.q > limits.upper)
        hits = rows & beyond.any(axis=-1)
        if hits.any():
            self.joint = np.where(hits, beyond.argmax(axis=-1), self.joint)
            self._stop(hits, AT_LIMIT, t)

    def _stop(self, rows: Flags, status: int, t: float) -> None:
        self.status = np.where(rows, status, self.status)
        self.stopped = np.where(rows, t, self.stopped)

    def finish(self, t: float, state: State, tau: Array, status: int) -> None:
        """The rows that still run end at a time; the last state is recorded if it has not been."""
        self._stop(self.running, status, t)
        last = float(self.stopped.max(initial=0.0))
        if not self.count or self.times[self.count - 1] < last:
            self.write(last, state, tau)


def run_fixed_steps(task: Task, method: str) -> Record:
    """The record of a simulation with steps of one length."""
    record, state, step = Record(task), task.start, STEPS[method]
    for k in range(task.steps):
        t, t_after = task.find_time(k), task.find_time(k + 1)
        drive = task.find_drive(k, state)
        if task.find_record(k) is not None:
            record.write(t, state, drive.tau)
        if task.late:
            record.finish(t, state, drive.tau, OUT_OF_TIME)
            return record
        after = step(task.mechanics, state, drive, t_after - t)
        state = record.end_rows(state, after, t, t_after, np.zeros_like(record.running))
        if not record.running.any():
            record.finish(t_after, state, drive.tau, ENDED)
            return record
    record.finish(task.duration, state, task.find_torques(task.steps, state), ENDED)
    return record


def run_adaptive_steps(task: Task) -> Record:
    """The record of a simulation with steps as long as the tolerance allows; see run_fixed_steps."""
    record, state, h, late = Record(task), task.start, task.dt, False
    for k, k_end in list_intervals(task):
        t, t_end = task.find_time(k), task.find_time(k_end)
        drive = task.find_drive(k, state)
        if task.find_record(k) is not None:
            record.write(t, state, drive.tau)
        while t < t_end and record.running.any() and not late:
            step, t_after = (h, t + h) if t + h * (1.0 + SHORTEST_STEP) < t_end else (t_end - t, t_end)
            stages = find_stages(task.mechanics, state, drive, step, DORMAND_PRINCE)
            after = advance_state(state, *stages.changes(DORMAND_PRINCE_END), task.mechanics.robot.floating)
            errors = find_errors(task, state, after, stages)
            worst = float(np.max(errors, where=record.running, initial=0.0))
            factor = find_step_factor(worst)
            late = task.late
            if worst > 1.0 and step > SHORTEST_STEP * (t + task.dt):
                h = step * factor
                continue
            piece = make_piece(t, state, stages)
            kept = record.end_rows(state, after, t, t_after, errors > 1.0)
            record.pieces.append(piece)
            write_between(task, record, piece, t, t_after, (k, k_end), drive.tau)
            t, state = t_after, kept
            h = step * factor if step == h else max(h, step * factor)
        if late or not record.running.any():
            record.finish(t, state, drive.tau, OUT_OF_TIME)
            return record
    record.finish(task.duration, state, task.find_torques(task.steps, state), ENDED)
    return record


def list_intervals(task: Task) -> Iterator[tuple[int, int]]:
    """The steps over which what acts is smooth, each from one number to another."""
    if not task.held:
        yield 0, task.steps
    else:
        for k in range(task.steps):
            yield k, k + 1


def find_errors(task: Task, before: State, after: State, stages: Stages) -> Array:
    """The estimated error of each row (...), relative to the tolerance; infinite for rows without a state."""
    dx, dv = stages.changes(DORMAND_PRINCE_ERROR)
    size_x, size_v = np.ones_like(dx), 1.0 + np.maximum(np.abs(before.qd), np.abs(after.qd))
    first = dx.shape[-1] - before.q.shape[-1]
    size_x[..., first:] += np.maximum(np.abs(before.q), np.abs(after.q))
    if before.T_world_base is not None and first:
        size_x[..., :3] += np.abs(before.T_world_base[..., :3, 3])
    with np.errstate(over="ignore", invalid="ignore"):
        both = np.concatenate([dx / size_x, dv / size_v], axis=-1) / task.tolerance
        errors = np.sqrt(np.sum(both**2, axis=-1) / max(both.shape[-1], 1))
    return np.where(np.isfinite(errors) & ~after.wild(), errors, np.inf)


def find_step_factor(error: float) -> float:
    """The length of the next step relative to this one, whose error is given relative to the tolerance."""
    if error == 0.0:
        return FASTEST
    return float(np.clip(STEP_SAFETY * error ** (-1.0 / ERROR_ORDER), SLOWEST, FASTEST))


def make_piece(t: float, state: State, stages: Stages) -> Piece:
    """The motion within a step of Dormand and Prince."""
    changes = [stages.changes(weights) for weights in DORMAND_PRINCE_DENSE]
    return Piece(t, stages.h, state, tuple(dx for dx, _ in changes), tuple(dv for _, dv in changes))


def write_between(
    task: Task, record: Record, piece: Piece, t: float, t_after: float, ends: tuple[int, int], tau: Array
) -> None:
    """Record the states after t, up to the end of a step, that lie strictly within an interval of smooth
    motion."""
    begin, end = ends
    k = max(begin + 1, int(t / task.dt))
    k += -k % task.every
    while k < end and task.find_time(k) <= t_after:
        time = task.find_time(k)
        if time > t and task.find_record(k) == record.count:
            record.write(time, piece.find_state(time, task.mechanics.robot.floating), tau)
        k += task.every
