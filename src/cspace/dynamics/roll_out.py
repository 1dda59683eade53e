"""The run of a simulation: arrays for its states, the compiled loop over its steps, and how it ended."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.dynamics.controllers import PD, ComputedTorque, find_motion
from cspace.dynamics.mechanics import Mechanics, State, WrenchLaw, find_resistances
from cspace.dynamics.momentum import centroidal_momentum, kinetic_energy, potential_energy
from cspace.dynamics.rows import Wrenches, check_mapping, check_wrench
from cspace.dynamics.simulation import DenseSteps
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics import LoopConstraints
from cspace.kinematics.batch import frame_number
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.tolerances import FARTHEST

Control = Callable[[float, Array, Array], ArrayLike] | PD | ComputedTorque | ArrayLike

ENDED, AT_LIMIT, BROKEN, OUT_OF_TIME = range(1, 5)
"""How a row ended: after its duration, at a limit of a joint, without a next state, or cut off by the time
limit. Zero while it runs."""

MOTION_SAMPLES: Final = 2**14
"""Numbers of a motion that are sampled at once for computed torque: a thousand
steps of an arm, some milliseconds."""


@dataclass(frozen=True, eq=False)
class Task:
    """The arguments of a simulation, checked; steps is how many of length dt, the last one up to the
    duration. control: a function, PD, ComputedTorque, torques (..., dof), or None. loops: that stay
    closed."""

    mechanics: Mechanics
    method: str
    start: State
    control: Any
    wrenches: Wrenches | WrenchLaw | None
    duration: float
    dt: float
    steps: int
    every: int
    stop_at_limits: bool
    tolerance: float
    dense: bool
    deadline: float
    loops: LoopConstraints | None = None

    @property
    def is_held(self) -> bool:
        """Whether something is held over each step or looked at after it, so that no step may be longer."""
        held = self.control is not None and not isinstance(self.control, np.ndarray)
        return held or callable(self.wrenches) or self.stop_at_limits

    @property
    def is_compiled(self) -> bool:
        """Whether no function of Python is called at each step."""
        known = self.control is None or type(self.control) in (PD, ComputedTorque, np.ndarray)
        return known and not callable(self.wrenches)

    @property
    def shape(self) -> tuple[int, ...]:
        """The leading axes."""
        return self.start.qd.shape[:-1]

    @property
    def size(self) -> float:
        """Of the records, in numbers."""
        width = self.start.qd.shape[-1] * (16.0 if self.mechanics.robot.floating else 4.0) + 7.0
        return float(self.steps / self.every * math.prod(self.shape) * width)

    @property
    def seconds_left(self) -> float:
        """Of the time limit; infinite without one."""
        return math.inf if math.isinf(self.deadline) else self.deadline - perf_counter()

    def find_time(self, k: int) -> float:
        """When step k begins [s]."""
        return self.duration if k == self.steps else k * self.dt

    def list_records(self) -> Array:
        """The times (k,) of the states that are recorded [s]."""
        times = np.arange(0, self.steps, self.every) * self.dt
        return np.append(times, self.duration)


class Record:
    """The states of a simulation: times (k,), and arrays (rows, k, …) that the compiled loop fills.

    q, qd, T_world_base, tau: the states (rows, …) as they are now; T_world_base is (1, 16) where one base
    serves all rows. status, joint, stopped (rows,): how each row ended, at which joint, and when.
    rank (rows,): of K at closed loops, the largest so far.
    """

    def __init__(self, task: Task) -> None:
        start, self.task = task.start, task
        rows, n, dof = math.prod(task.shape), start.q.shape[-1], start.qd.shape[-1]
        self.times = task.list_records()
        self.q, self.qd = start.q.reshape(rows, n).copy(), start.qd.reshape(rows, dof).copy()
        T = np.eye(4) if start.T_world_base is None else start.T_world_base
        self.T_world_base = T.reshape(-1, 16).copy()
        self.tau = np.zeros((rows, dof))
        self.status, self.joint = np.zeros((2, rows), dtype=np.int32)
        self.stopped = np.zeros(rows)
        self.rank = np.full(rows, -1, dtype=np.int32)
        self.pieces: DenseSteps | None = None
        sizes = {"energy": (), "momentum": (6,), "q": (n,), "qd": (dof,), "tau": (dof,)}
        self.states: dict[str, Array] = {
            name: np.empty((rows, len(self.times), *size)) for name, size in sizes.items()
        }
        if task.mechanics.robot.floating:
            self.states["T_world_base"] = np.empty((rows, len(self.times), 16))

    def finish(self) -> None:
        """Make NaN of what lies after the end of each row, and cut off what lies after all ends."""
        early = np.flatnonzero(self.status != ENDED)
        firsts = np.searchsorted(self.times, self.stopped[early], side="right")
        for row, first in zip(early, firsts, strict=True):
            for array in self.states.values():
                array[row, first:] = np.nan
        last = self.stopped.max(initial=0.0)
        if len(early) and len(early) == len(self.status):
            count = int(np.searchsorted(self.times, last, side="right"))
            if self.times[count - 1] < last:
                self.times[count] = last
                count += 1
            self.times = self.times[:count]
            self.states = {name: array[:, :count] for name, array in self.states.items()}
        at = np.searchsorted(self.times, self.stopped[early])
        shown = at < len(self.times)
        shown[shown] = self.times[at[shown]] == self.stopped[early][shown]
        self._write_ends(early[shown], at[shown])

    def _write_ends(self, rows: Any, at: Any) -> None:
        """The last states of rows, as the records at these places."""
        if not len(rows):
            return
        mechanics = self.task.mechanics
        q, qd, poses = self.q[rows], self.qd[rows], self.T_world_base
        T = (poses if len(poses) == 1 else poses[rows]).reshape(-1, 4, 4)
        energy = kinetic_energy(mechanics.robot, q, qd, T_world_base=T)
        energy = energy + potential_energy(mechanics.robot, q, gravity=mechanics.gravity, T_world_base=T)
        ends = {"q": q, "qd": qd, "tau": self.tau[rows], "energy": energy, "T_world_base": T.reshape(-1, 16)}
        ends["momentum"] = centroidal_momentum(mechanics.robot, q, qd, T_world_base=T)
        for name, array in self.states.items():
            array[rows, at] = ends[name]


def run_steps(task: Task) -> Record:
    """The record of a simulation."""
    record = Record(task)
    simulator = make_simulator(task, record)
    if not task.is_compiled:
        call_each_step(task, record, simulator)
    elif isinstance(task.control, ComputedTorque):
        follow_motion(task, task.control, record, simulator)
    else:
        simulator.run(0, task.steps + 1, task.seconds_left)
    if task.method == "adaptive" and task.dense:
        values, first = simulator.take_pieces()
        record.pieces = DenseSteps(values, first, task.start.q.shape[-1], record.stopped)
    record.finish()
    return record


def make_simulator(task: Task, record: Record) -> _core.Simulator:
    """The compiled half of a simulation."""
    mechanics = task.mechanics
    rubs = mechanics.damping.any() or mechanics.dry.any()
    limits = mechanics.robot.limits
    simulator = _core.Simulator(
        mechanics.robot,
        task.method,
        mechanics.gravity,
        mechanics.damping if rubs else None,
        mechanics.dry if rubs else None,
        mechanics.friction_speed,
        (task.duration, task.dt),
        (task.steps, task.every),
        task.is_held,
        task.dense,
        task.tolerance,
        np.ascontiguousarray(limits.lower) if task.stop_at_limits else None,
        np.ascontiguousarray(limits.upper) if task.stop_at_limits else None,
        mechanics.threads,
    )
    simulator.hold_state(
        record.q, record.qd, record.T_world_base, record.tau, record.status, record.joint, record.stopped
    )
    if task.loops is not None:
        simulator.close_loops(task.loops.table, record.rank)
    states = record.states
    simulator.hold_records(
        states["q"],
        states["qd"],
        states["tau"],
        states["energy"],
        states["momentum"],
        states.get("T_world_base"),
    )
    if not callable(task.wrenches):
        set_wrenches(task, simulator, task.wrenches)
    set_control(task, simulator)
    return simulator


def set_control(task: Task, simulator: _core.Simulator) -> None:
    """The control of a simulation, as far as it is known before."""
    control, robot = task.control, task.mechanics.robot
    if isinstance(control, np.ndarray):
        simulator.set_torques(share_rows(control, task.shape))
    elif type(control) is PD:
        goal = control.find_goal(robot)
        kp, kd = (share_rows(each, task.shape, "a gain") for each in control.find_gains(robot))
        simulator.set_pd(kp, kd, share_rows(goal, task.shape, "q_goal"), control.gravity_compensation)
    elif type(control) is ComputedTorque:
        control.refuse_floating(robot)
        kp, kd = (share_rows(each, task.shape, "a gain") for each in control.find_gains(robot))
        damping, dry = find_resistances(robot)
        simulator.set_computed_torque(kp, kd, damping, dry)


def share_rows(values: Array, shape: tuple[int, ...], subject: str = "") -> Array:
    """Values (..., m) as one row for all, or as a row for each of the leading axes."""
    m = values.shape[-1]
    if values.size == m:
        return np.ascontiguousarray(values.reshape(m))
    if leading_axes(**{subject or "tau": values.shape[:-1]}, q=shape) != shape:
        raise InputError(f"{subject} has shape {values.shape}, expected {(*shape, m)} as there are rows of q")
    return np.ascontiguousarray(np.broadcast_to(values, (*shape, m))).reshape(-1, m)


def follow_motion(task: Task, control: ComputedTorque, record: Record, simulator: _core.Simulator) -> None:
    """Run with computed torque: its motion is sampled at the steps, some at a time."""
    robot, k = task.mechanics.robot, 0
    while k <= task.steps and not record.status.all():
        first = sample_motion(control, task.find_time(k), robot)
        count = min(max(1, MOTION_SAMPLES // max(first.size, 1)), task.steps + 1 - k)
        later = [sample_motion(control, task.find_time(i), robot) for i in range(k + 1, k + count)]
        for i, sample in enumerate(later, k + 1):
            if sample.shape != first.shape:
                raise InputError(
                    f"the motion at t = {task.find_time(i):g} s has leading axes {sample.shape[:-2]}, at"
                    f" t = {task.find_time(k):g} s {first.shape[:-2]}; they must be the same at all times"
                )
        samples = np.stack([first, *later], axis=-3)
        rows = samples.reshape(*samples.shape[:-3], math.prod(samples.shape[-3:]))
        simulator.set_motion(share_rows(rows, task.shape, "the motion"), k, count)
        simulator.run(k, k + count, task.seconds_left)
        k += count


def sample_motion(control: ComputedTorque, t: float, robot: KinematicModel) -> Array:
    """q, qd and qdd (..., 3, n) of a motion at a time."""
    return np.stack(np.broadcast_arrays(*find_motion(control.motion, t, robot)), axis=-2)


def call_each_step(task: Task, record: Record, simulator: _core.Simulator) -> None:
    """Run with a control or wrenches that functions of Python find at the beginning of each step."""
    law = task.wrenches if callable(task.wrenches) else None
    calls = task.control is not None and type(task.control) not in (PD, np.ndarray)
    for k in range(task.steps + 1):
        if record.status.all():
            return
        t = task.find_time(k)
        if law is not None and k < task.steps:
            q, qd = record.q.reshape(task.start.q.shape), record.qd.reshape(task.start.qd.shape)
            set_wrenches(task, simulator, law(t, q.copy(), qd.copy()))
        if calls:
            simulator.set_torques(find_torques(task, record, k))
        simulator.run(k, k + 1, task.seconds_left)


def find_torques(task: Task, record: Record, k: int) -> Array:
    """The torques (dof,) or (rows, dof) of a control that is a function, at the beginning of step k."""
    t, shape, control = task.find_time(k), task.shape, task.control
    q, qd = record.q.reshape(task.start.q.shape).copy(), record.qd.reshape(task.start.qd.shape).copy()
    if isinstance(control, PD | ComputedTorque):
        floating = task.mechanics.robot.floating
        T = record.T_world_base.reshape(*shape, 4, 4).copy() if floating else task.start.T_world_base
        gravity = task.mechanics.gravity
        tau: Any = control(task.mechanics.robot, t, q, qd, gravity=gravity, T_world_base=T)
    else:
        tau = control(t, q, qd)
    return check_torques(tau, qd.shape, f"the torque of control at step {k} (t = {t:g} s)")


def check_control(control: Control | None, shape: tuple[int, ...]) -> Any:
    """A control as a function, constant torques (dof,) or rows of them, or None. shape: (..., dof)."""
    if control is None or callable(control):
        return control
    if isinstance(control, np.ndarray | list | tuple):
        return check_torques(control, shape, "control")
    raise InputTypeError(
        f"control is {name_type(control)}, expected torques, or a function of t, q and qd that returns"
        " them, or dynamics.PD or dynamics.ComputedTorque"
    )


def spread_rows(q: ArrayLike, control: Any, wrenches: Any) -> ArrayLike:
    """q (..., n) with as many rows as the torques, goals and wrenches that are given have."""
    leads: dict[str, tuple[int, ...]] = {}
    if isinstance(control, np.ndarray | list | tuple):
        leads["control"] = np.shape(control)[:-1]
    elif type(control) is PD:
        leads["q_goal"] = np.shape(control.q_goal)[:-1]
    if isinstance(wrenches, Mapping):
        leads |= {f"wrench at {frame!r}": np.shape(wrench)[:-1] for frame, wrench in wrenches.items()}
    if not any(leads.values()):
        return q
    joints = as_floats(q, "q", last=(None,), largest=FARTHEST)
    lead = leading_axes(q=joints.shape[:-1], **leads)
    return np.broadcast_to(joints, (*lead, joints.shape[-1]))


def check_torques(tau: Any, shape: tuple[int, ...], subject: str) -> Array:
    """Torques as (dof,) or as rows; InputError for another shape than (..., dof) or NaN."""
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
    return share_rows(array, shape[:-1])


def set_wrenches(task: Task, simulator: _core.Simulator, wrenches: Wrenches | None) -> None:
    """What the world does at frames from now on; see torques_of_wrenches for what is refused."""
    check_mapping(wrenches)
    given = []
    for frame, wrench in (wrenches or {}).items():
        number = frame_number(task.mechanics.robot, frame)
        array = check_wrench(wrench, frame)
        shape = array.shape
        if leading_axes(wrenches=shape[:-1], q=task.shape) != task.shape:
            raise InputError(
                f"wrench at {frame!r} has shape {shape}, expected {(*task.shape, 6)} as there are rows of q"
            )
        given.append((number, share_rows(array, task.shape)))
    simulator.set_wrenches(given, task.mechanics.expressed_in == "tip")
