"""One-parameter self-motions: the joints move, the tip stays."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats, whole_number
from cspace.errors import InputError
from cspace.ik.redundancy.result import MOST_SAMPLES
from cspace.ik.self_motion.continuation import Arc, arc_through, nearest_member
from cspace.ik.solver import Solver
from cspace.ik.wrapping import wrap_joints
from cspace.model import Limits
from cspace.tables import one_line, tabulate
from cspace.tolerances import MOVING_JOINT


@tabulate()
@dataclass(frozen=True, eq=False)
class SelfMotion:
    """A one-parameter set of configurations: the joints move, the tip stays.

    row: the solution that stands for it. q: that configuration (dof,). direction: the unit joint velocity
    (dof,) along the self-motion at q. joints: the names of the joints that move at q. bounds: how far each
    of them goes; sample(n): configurations along the way.
    """

    row: int
    q: Array
    direction: Array
    joints: tuple[str, ...]
    _solver: Solver = field(repr=False)
    _whole_pose: bool = field(repr=False)
    _moving: npt.NDArray[np.intp] = field(repr=False)

    def __repr__(self) -> str:
        return one_line("SelfMotion", f"of row {self.row}: {', '.join(self.joints)} move")

    @cached_property
    def _arc(self) -> Arc | None:
        own = self._moving
        return arc_through(self._solver, self.q[own], self.direction[own], self._whole_pose)

    def _with_locked(self, q: Array) -> Array:
        """Configurations (..., dof) of the arm from those of the joints that are not locked."""
        whole = np.broadcast_to(self.q, (*q.shape[:-1], len(self.q))).copy()
        whole[..., self._moving] = q
        return whole

    @property
    def bounds(self) -> Array:
        """The least and the largest value of each joint along the self-motion, (dof, 2) [rad, m].

        The self-motion is the curve of configurations through q that keep the tip where it is (for a position
        goal: keep its position), followed from q both ways until a joint of the robot meets a limit or the
        curve closes. A joint that goes all the way round a curve without limits has bounds −π and π; one
        that is stopped on one side only, or a prismatic joint that nothing stops, has an infinite bound on
        the other. A joint that rests has twice its value. Angles are those of q, after multiples of 2π into
        the limits, counted on without a jump, so that bounds may lie beyond ±π.

        NaN where q breaks the limits whatever turn is taken: ik(..., near=q) picks another representative.
        Where more freedom is left than one, the curve is the one that goes on straight from `direction`; it
        need not close, and is then followed for 4000 steps of 0.05 rad at most, and no further than to where
        self-motions cross within rounding.
        Computed when first read, by steps along the tangent and back onto the curve (Allgower and Georg
        1990); extremes and limits are met to rounding.
        """
        if self._arc is None:
            return np.full((len(self.q), 2), np.nan)
        return self._with_locked(self._arc.bounds().T).T

    def sample(self, n: int) -> Array:
        """n configurations along the self-motion, (n, dof) [rad, m], evenly spread, each keeping the tip.

        From one end of the part within limits to the other, both included; of a closed curve without limits
        from q once around, joints that go all the way round in (−π, π]. No rows where q breaks the limits
        (see bounds). Raises InputError where the self-motion has no end, naming the joint, and for n below 1.
        """
        count = whole_number(n, "n", 1, MOST_SAMPLES)
        if self._arc is None:
            return np.empty((0, len(self.q)))
        endless = np.flatnonzero(np.isinf(self.bounds).any(axis=1))
        if len(endless):
            name = self._solver.joint_names[int(np.searchsorted(self._moving, endless[0]))]
            raise InputError(f"the self-motion is unbounded: {name} has no limits; give the robot limits")
        q = self._arc.sample(count)
        goes_round = self._arc.is_loop & (np.ptp(self._arc.bounds(), axis=1) >= 2 * np.pi)
        return self._with_locked(np.where(goes_round, wrap_joints(q, self._solver.joint_types), q))

    def nearest(self, q: Array) -> Array:
        """The configuration of the self-motion that is nearest to q (dof,), (dof,) [rad, m].

        Limits aside; each revolute joint by the turn that brings it closest.
        """
        return self._nearest_within(q, None)

    def _nearest_within(self, q: Array, limits: Limits | None) -> Array:
        """The same within limits, if any; self.q where none of the self-motion is."""
        own = self._moving
        seed = as_floats(q, "q", last=self.q.shape)
        bounds = None if limits is None else Limits(limits.lower[own], limits.upper[own])
        here, along = self.q[own], self.direction[own]
        return self._with_locked(
            nearest_member(self._solver, here, along, self._whole_pose, seed[own], bounds)
        )


def self_motion_at(
    solver: Solver, row: int, q: Array, whole_pose: bool, locked: Mapping[int, float]
) -> SelfMotion:
    """The self-motion through q: the joint velocity that keeps the tip's twist, or its velocity, zero.

    locked: values of joints, by number, that stay where they are.
    """
    own = np.array([k for k in range(len(q)) if k not in locked])
    solver = solver.lock(locked)
    found = _core._ik_direction(solver, np.ascontiguousarray(q[own]), whole_pose)
    rows = 6 if whole_pose else 3
    along = np.linalg.svd(solver.jacobian(q[own])[:rows])[2][-1] if found is None else found
    along = along * np.sign(along[np.argmax(np.abs(along))])
    direction = np.zeros(len(q))
    direction[own] = np.where(np.abs(along) > MOVING_JOINT, along, 0.0)
    names = tuple(itertools.compress(solver.joint_names, direction[own] != 0))
    return SelfMotion(row, q, direction, names, solver, whole_pose, own)
