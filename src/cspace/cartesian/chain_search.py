"""The cheapest chain of configurations along a Cartesian path that leaves one dimension free."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final, Protocol

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.kinematics import KinematicModel
from cspace.kinematics.manipulability import generic_rank
from cspace.math.wrapping import TURN, turns_within, wrap_near
from cspace.model import Limits
from cspace.tolerances import CHAIN_AT_LIMIT, CHAIN_LEAST_VOLUME
from cspace.trajectory.cartesian_path import CartesianPath, Indices

STATION_SPACING: Final = 0.04
"""[m or rad] Of the poses at which the redundant joint is chosen."""

STATIONS: Final = (16, 96)
"""Fewest and most of them on a path of some metres or a turn."""

LONGEST_SPACING: Final = 0.1
"""[m or rad] Of them on a longer path: joints move less than LONGEST_STEP between neighbours."""

HALVINGS: Final = 8
"""Of the interval between two stations in which a chain ends."""

MOST_STATIONS: Final = 1000
"""On any path: the configurations there take a third of a gigabyte."""

FINER: Final = 8
"""Parts of the distance of two values that are tried around the chain that was found first."""

REACH: Final = 3
"""Values that the redundant joint may move between neighbouring stations."""

LONGEST_STEP: Final = 0.7
"""[rad] That a joint may turn between neighbouring stations; more is another branch."""

LIMIT_WEIGHT: Final = 0.3
"""Of x²/(1 − x²), x the distance from the middle of the limits in half ranges, against joints that move by 1
rad per unit of the path: a few degrees of detour keep a joint away from its limits."""

SINGULAR_WEIGHT: Final = 0.02
"""Of the inverse of det(J Jᵀ), relative to the best one on the path."""

FULL_RANK: Final = 6
"""Of the Jacobian of an arm that moves in all directions."""

ROOMY: Final = TURN + 2.0
"""[rad] Range of a joint of which multiples of 2π count as one configuration; its limits are looked at
afterwards."""


class Freedom(Protocol):
    """The one dimension of configurations that a pose of the path leaves free, as values [rad or m].

    is_ring: the values are angles, the last of them a neighbour of the first.
    """

    @property
    def is_ring(self) -> bool: ...

    def spread_values(self) -> Array:
        """Values (m,) over the whole range, evenly spaced."""

    def solve(self, T: Array, values: Array) -> tuple[Array, Any]:
        """Configurations (k, room, dof) of poses T (k, 4, 4) at values (k,), and how many each has (k,)."""

    def value_of(self, q: Array, T: Array) -> float:
        """The value of a configuration (dof,) that reaches a pose T (4, 4)."""

    def carry(self, T: Array) -> Array:
        """Values (n,), from 0 on, that change as little as they can along poses (n, 4, 4)."""


class MovableFreedom(Freedom, Protocol):
    """A freedom whose configurations can be moved a little, so that a chain can be searched around."""

    def move(self, T: Array, q: Array, values: Array) -> Array:
        """The configurations near q (k, dof) of poses T (k, 4, 4) at values (k,); NaN where there is none."""


@dataclass(frozen=True, eq=False)
class Stations:
    """Parameters (n,) along a path, evenly spaced, and the poses (n, 4, 4) there."""

    s: Array
    T: Array

    @property
    def spacing(self) -> float:
        return float(self.s[1])

    @classmethod
    def of(cls, path: CartesianPath) -> Stations:
        few = np.clip(np.ceil(path.length / STATION_SPACING), *STATIONS)
        count = int(min(max(few, np.ceil(path.length / LONGEST_SPACING)), MOST_STATIONS))
        s = np.linspace(0.0, path.length, count + 1)
        return cls(s, path(s))


@dataclass(frozen=True, eq=False)
class ConfigurationChain:
    """Configurations q (n, dof) and values (n,) at the first stations; all of them unless `reason` says why
    not, with the cause. s_end: the first station that it does not reach, inf for none."""

    q: Array
    values: Array
    reason: str = ""
    cause: str = "end"
    s_end: float = np.inf


def find_chain(
    robot: KinematicModel, freedom: MovableFreedom, path: CartesianPath, bounds: Limits, start: Array | None
) -> tuple[Stations, ConfigurationChain]:
    """The chain along a path, and the stations; else how far it goes.

    Its end is placed by bisection along parts of the path. A long path is first searched as far as its
    stations lie close: between others the joints move too far.
    """
    low, tried = 0.0, min(path.length, MOST_STATIONS * LONGEST_SPACING)
    high, ended = path.length, None
    for _ in range(HALVINGS + 1):
        stations = Stations.of(path if tried == path.length else path.part(tried))
        chain = ChainSearch(robot, freedom, stations, bounds, start).run(freedom)
        if not chain.reason and tried == path.length:
            return stations, chain
        if not chain.reason:
            low = tried
        else:
            ended, high = (stations, chain), chain.s_end if chain.s_end > low else tried
            low = max(low, min(high, chain.s_end) - stations.spacing)
        if high <= 0.0:
            break
        tried = path.length if ended is None else 0.5 * (low + high)
    assert ended is not None
    if ended[1].s_end < low:
        text = f"at s = {low:.6g}: joints move too far between the {MOST_STATIONS} stations of a path so long"
        return ended[0], replace(ended[1], reason=f"{text}; divide it", s_end=low)
    return ended


class ChainSearch:
    """Finds the cheapest chain of configurations, one of each station: first among values that are
    spread over the whole range, then among those beside the chain."""

    def __init__(
        self,
        robot: KinematicModel,
        freedom: Freedom,
        stations: Stations,
        bounds: Limits,
        start: Array | None,
    ) -> None:
        self.robot, self.freedom, self.stations, self.bounds = robot, freedom, stations, bounds
        self.start = start
        self.revolute = np.array([kind != "P" for kind in robot.joint_types])
        self.wide = self.revolute & ~(bounds.upper - bounds.lower < ROOMY)
        self.narrow = np.isfinite(bounds.lower) & np.isfinite(bounds.upper) & ~self.wide
        self.half = np.where(self.narrow, 0.5 * (bounds.upper - bounds.lower), 1.0)
        self.middle = np.where(self.narrow, bounds.lower + self.half, 0.0)
        self.moves_freely = generic_rank(robot) == FULL_RANK

    def run(self, movable: MovableFreedom | None = None) -> ConfigurationChain:
        """The chain with continuous angles, or how far it goes; movable: the freedom, to search around it."""
        values = self.freedom.spread_values()
        step = values[1] - values[0]
        if self.start is not None:  # one of the values is that of the start
            own = self.freedom.value_of(self.start, self.stations.T[0])
            values = values + (own - values[int(np.argmin(np.abs(values - own)))])
        every = self.freedom.carry(self.stations.T)[:, None] + values
        chain = self._search(every)
        if chain.reason:
            return chain
        if movable is not None:
            finer = self._search_around(chain, movable, step)
            chain = chain if finer.reason else finer
        return ConfigurationChain(self._unwrap(chain.q), chain.values)

    def _search(self, values: Array) -> ConfigurationChain:
        """The cheapest chain among all configurations at values (n, m)."""
        n, m = values.shape
        rows, count = self.freedom.solve(np.repeat(self.stations.T, m, axis=0), values.ravel())
        kept = np.arange(rows.shape[1]) < count[:, None]
        cell = np.repeat(np.arange(n * m), count)
        return self._choose(values, rows[kept], cell, self.freedom.is_ring, REACH)

    def _search_around(
        self, chain: ConfigurationChain, movable: MovableFreedom, step: float
    ) -> ConfigurationChain:
        """The cheapest chain among the configurations beside a chain, up to a step of its values away."""
        offsets = step / FINER * np.arange(-FINER, FINER + 1)
        values = chain.values[:, None] + offsets
        q = np.empty((*values.shape, self.robot.dof))
        q[:, FINER] = chain.q
        T, both = np.repeat(self.stations.T, 2, axis=0), np.array([-1, 1])
        for k in range(1, FINER + 1):
            near, at = q[:, FINER + (k - 1) * both], FINER + k * both
            guess = near if k == 1 else 2.0 * near - q[:, FINER + (k - 2) * both]
            moved = movable.move(T, guess.reshape(len(T), -1), values[:, at].ravel())
            q[:, at] = moved.reshape(guess.shape)
        cell = np.flatnonzero(np.isfinite(q[..., 0]))
        return self._choose(values, q.reshape(-1, self.robot.dof)[cell], cell, False, 2 * FINER)

    def _choose(
        self, values: Array, q: Array, cell: Indices, is_ring: bool, reach: int
    ) -> ConfigurationChain:
        """The cheapest chain among configurations q (k, dof) of cells (k,), numbers of values (n, m)."""
        n, m = values.shape
        q = self._into_limits(q)
        inside = ((q >= self.bounds.lower) & (q <= self.bounds.upper) | self.wide).all(axis=1)
        q, cell = q[inside], cell[inside]
        if self.start is not None:
            own = int(np.argmin(np.abs(values[0] - self.freedom.value_of(self.start, self.stations.T[0]))))
            later = cell >= m
            q, cell = np.concatenate([self.start[None], q[later]]), np.concatenate([[own], cell[later]])
        begin = np.searchsorted(cell, np.arange(n * m + 1)).astype(np.uint64)
        stride = np.where(self.revolute, LONGEST_STEP, np.inf)
        q = np.ascontiguousarray(q)
        states, _ = _core._ik_cheapest_chain(
            q, self._measure_cost(q), begin, m, stride, self.wide, reach, is_ring
        )
        chain = ConfigurationChain(q[states], values.ravel()[cell[states]])
        if len(states) == n:
            return chain
        return self._explain_end(chain, bool((cell // m == len(states)).any()))

    def _into_limits(self, q: Array) -> Array:
        """Angles of joints that cannot make a full turn, moved by the multiple of 2π that is nearest to the
        middle of their limits."""
        return np.asarray(np.where(self.revolute & self.narrow, wrap_near(q, self.middle), q))

    def _measure_cost(self, q: Array) -> Array:
        """Of the distance from the middle of the limits and, for arms that move in all six directions, from
        singularities: the determinant of others is rounding."""
        off = np.where(self.narrow, (q - self.middle) / self.half, 0.0) ** 2
        cost = LIMIT_WEIGHT * np.sum(off / (1.0 + CHAIN_AT_LIMIT - np.minimum(off, 1.0)), axis=1)
        if not self.moves_freely:
            return np.asarray(cost * self.stations.spacing**2)
        J = self.robot.jacobian(q)
        volume = np.empty(len(q))
        _core._square_volumes(J, volume)
        best = volume.max(initial=0.0)
        if best > 0.0:
            cost += SINGULAR_WEIGHT * best / np.maximum(volume, CHAIN_LEAST_VOLUME * best)
        return np.asarray(cost * self.stations.spacing**2)

    def _unwrap(self, q: Array) -> Array:
        """The chain with continuous angles; without a start, each joint is moved by the multiple of 2π that
        keeps it within its limits, if there is one."""
        step = np.diff(q, axis=0)
        step = np.where(self.wide, wrap_near(step, 0.0), step)
        out: Array = q[0] + np.concatenate([np.zeros((1, q.shape[1])), np.cumsum(step, axis=0)])
        if self.start is not None:
            return out
        low, high = out.min(axis=0), out.max(axis=0)
        lower, upper = self.bounds.lower, self.bounds.upper
        limited = self.wide & np.isfinite(lower) & np.isfinite(upper)
        fewest, most = turns_within(low, high, lower, upper)
        moved = limited & ((low < lower) | (high > upper)) & (fewest <= most)
        return np.asarray(out + np.where(moved, TURN * fewest, 0.0))

    def _explain_end(self, chain: ConfigurationChain, has_next: bool) -> ConfigurationChain:
        s = float(self.stations.s[len(chain.q)])
        whence = "" if self.start is None else " from this start"
        if has_next:
            text = f"at s = {s:.6g}: no chain of configurations that move little leads on{whence}"
            return ConfigurationChain(chain.q, chain.values, text, "jump", s)
        text = f"at s = {s:.6g}: no configuration within the limits reaches the path"
        return ConfigurationChain(chain.q, chain.values, text, "unreachable", s)
