"""The answer of a simulation: states over time, their energy, and why it ended."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array, one_number
from cspace.dynamics.mechanics import Flags, State, advance_state
from cspace.errors import InputError
from cspace.spatial import left_jacobian_inv_so3, left_jacobian_so3, log_so3
from cspace.tables import count_things, html_table, one_line, shown


@dataclass(frozen=True, eq=False)
class DenseSteps:
    """The steps of the adaptive method as polynomials of θ = (t − begin) / h, from 0 to 1.

    values (k, m): of each step when it begins, h, q (n,), qd (dof,), of a floating base its pose (16,), and
    the coefficients (4, dof) of θ, θ², … of displacement and change of velocity. first (rows + 1,): where the
    steps of each row begin. n: coordinates. stopped (rows,) [s]: when each row ended.
    """

    values: Array
    first: NDArray[np.int64]
    n: int
    stopped: Array

    def find_state(self, t: float, start: State) -> State:
        """The state at a time, NaN in rows that ended before. start: that at time zero."""
        if t == 0.0:
            return start
        rows = [
            max(begin + int(np.searchsorted(self.values[begin:end, 0], t, side="right")) - 1, begin)
            for begin, end in zip(self.first[:-1], self.first[1:], strict=True)
        ]
        gone = (t > self.stopped) | (np.diff(self.first) == 0)
        taken = np.zeros((len(rows), self.values.shape[1]))
        taken[~gone] = self.values[np.array(rows, dtype=int)[~gone]]
        floating, lead = start.T_world_base is not None, start.qd.shape[:-1]
        sizes = (1, 1, self.n, start.qd.shape[-1], 16 if floating else 0)
        begin, h, q, qd, T, rates = np.split(taken, np.cumsum(sizes), axis=-1)
        theta = np.where(gone[:, None], 0.0, (t - begin) / np.where(gone[:, None], 1.0, h))
        powers = theta ** np.arange(1, 5)
        dx, dv = np.einsum("rp,rcpj->crj", powers, rates.reshape(len(taken), 2, 4, qd.shape[-1]))
        before = State(
            q.reshape(start.q.shape), qd.reshape(start.qd.shape), T.reshape(*lead, 4, 4) if floating else None
        )
        dx[gone] = dv[gone] = np.nan
        return advance_state(before, dx.reshape(start.qd.shape), dv.reshape(start.qd.shape), floating)


@dataclass(frozen=True, eq=False)
class Simulation:
    """The motion of a robot under forces; falsy if it broke down before its end.

    robot, method: names. joints: those of the coordinates. times (k,) [s]: 0 first, the end last.
    q (..., k, n) [rad or m], qd (..., k, dof): the states. tau (..., k, dof) [N·m or N]: the torques of the
    control, held from each time on. energy (..., k) [J]: kinetic and potential energy of the links.
    momentum (..., k, 6) [kg·m/s, kg·m²/s]: linear, and angular about the centre of mass, as of
    centroidal_momentum.
    T_world_base (..., k, 4, 4): the poses of a floating base, None for a fixed one. A row of a batch that
    ended early is NaN from then on.

    stopped (...) [s]: how far each row came. reason: "ended", "limit reached: …" with the joint, "not finite:
    …", "not solved: …" or "time limit", of the first row that did not end. ended (...): which rows came to
    their end.
    """

    robot: str
    joints: tuple[str, ...]
    method: str
    times: Array
    q: Array
    qd: Array
    tau: Array
    energy: Array
    momentum: Array
    T_world_base: Array | None
    stopped: Array
    ended: Flags
    reason: str
    _truth: bool = True
    _dense: DenseSteps | None = field(default=None, repr=False)

    def __bool__(self) -> bool:
        return self._truth

    def __len__(self) -> int:
        return len(self.times)

    def __call__(self, t: float) -> tuple[Array, ...]:
        """The state at any time within the simulation.

        Of the adaptive method with dense steps it is that of its own interpolation, with errors of the size
        of its tolerance. Otherwise it is the cubic through the recorded positions and velocities before and
        after t.

        t [s]. Returns q (..., n) and qd (..., dof), and T_world_base (..., 4, 4) of a floating base.
        Raises InputError for a time outside of the simulation.
        """
        time = one_number(t, "t")
        if not self.times[0] <= time <= self.times[-1]:
            raise InputError(f"t is {time:g} s; the simulation is from 0 to {self.times[-1]:g} s")
        if self._dense is not None:
            state = self._dense.find_state(time, self._state(0))
        else:
            k = min(max(int(np.searchsorted(self.times, time, side="right")) - 1, 0), max(len(self) - 2, 0))
            state = self._find_between(k, time)
        both = state.q, state.qd
        return both if state.T_world_base is None else (*both, state.T_world_base)

    def _find_between(self, k: int, t: float) -> State:
        """The state at a time by the cubic of Hermite from record k to the next."""
        state, floating = self._state(k), self.T_world_base is not None
        if len(self) == 1:
            return state
        after, h = self._state(k + 1), float(self.times[k + 1] - self.times[k])
        slope, slope_after = h * state.qd, h * after.qd
        step = np.zeros_like(state.qd)
        step[..., step.shape[-1] - state.q.shape[-1] :] = after.q - state.q
        if state.T_world_base is not None and after.T_world_base is not None:
            T, T_after = state.T_world_base, after.T_world_base
            step[..., :3] = T_after[..., :3, 3] - T[..., :3, 3]
            step[..., 3:6] = log_so3(T_after[..., :3, :3] @ np.swapaxes(T[..., :3, :3], -1, -2))
            J = left_jacobian_inv_so3(step[..., 3:6])
            slope_after[..., 3:6] = np.einsum("...ij,...j", J, slope_after[..., 3:6])
        a, b, c = slope, 3.0 * step - 2.0 * slope - slope_after, slope + slope_after - 2.0 * step
        theta = (t - float(self.times[k])) / h
        dx = theta * (a + theta * (b + theta * c))
        rate = (a + theta * (2.0 * b + 3.0 * theta * c)) / h
        between = advance_state(state, dx, np.zeros_like(dx), floating)
        if floating:
            J = left_jacobian_so3(dx[..., 3:6])
            rate[..., 3:6] = np.einsum("...ij,...j", J, rate[..., 3:6])
        return State(between.q, rate, between.T_world_base)

    def _state(self, k: int) -> State:
        T = None if self.T_world_base is None else self.T_world_base[..., k, :, :]
        return State(self.q[..., k, :], self.qd[..., k, :], T)

    @property
    def summary(self) -> str:
        """What was simulated and how it ended, in one line."""
        rows = self.stopped.size
        many = f", {count_things(rows, 'row')}" if self.stopped.ndim else ""
        records = f"{count_things(len(self), 'state')} to {shown(self.times[-1])} s"
        return f"{self.robot} by {self.method}: {records}{many}, {self.reason}"

    def __repr__(self) -> str:
        return one_line("Simulation", self.summary)

    def _repr_html_(self) -> str:
        titles = ["row", "until [s]", "energy at first [J]", "energy at last [J]"]
        energy, stopped = self.energy.reshape(-1, len(self)), self.stopped.ravel()
        lasts = np.searchsorted(self.times, stopped, side="right") - 1
        rows = [
            [str(i), shown(until), shown(row[0]), shown(row[last])]
            for i, (until, row, last) in enumerate(zip(stopped, energy, lasts, strict=True))
        ]
        return html_table(self.summary, titles, rows)
