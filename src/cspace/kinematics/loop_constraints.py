"""The equations of closed loops: residual, Jacobian, and the accelerations that velocities alone cause."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.kinematics.batch import check_robot, refuse_infinite, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.kinematics.loop_rows import Flags, find_frames, make_rows
from cspace.model import Loop
from cspace.tables import tabulate


@dataclass(frozen=True, eq=False)
class Placement:
    """Rows of configurations q (rows, n) and how far their loops are open: φ (rows, r), and over (rows,
    loops), whether a loop is nearer to a place upside down."""

    q: Array
    phi: Array
    over: Flags


@tabulate("loops", "rows", "length")
class LoopConstraints:
    """The constraints φ(q) = 0 of the closed loops of a robot, with φ̇ = K q̇ and φ̈ = K q̈ + k.

    robot: whose joints move the loops; they are those of a tree. loops: joints that close loops between links
    of it, on both sides of which the tree goes on. rows: the name of each row of φ, "loop.x" and the like, in
    the axes of the frame of the loop in its parent; where the loop has an axis it is z. length [m]: the size
    of the mechanism, by which lengths are compared with angles.

    Raises InputError for a robot without loops, doubled names, a helical loop, a universal one without second
    axis and one between parts that do not move against each other; UnknownNameError for an unknown link.
    Source: Featherstone 2008, chapter 8.
    """

    def __init__(self, robot: KinematicModel, loops: Iterable[Loop]) -> None:
        check_robot(robot)
        self.robot, self.loops = robot, tuple(loops)
        self._check_loops()
        self._layout = make_rows(self.loops)
        self.rows = self._layout.names
        index = robot._assembly.frame_index
        ends = [[index[end] for end in (each.parent, each.child)] for each in self.loops]
        self._frames = np.array(ends, dtype=np.intp).reshape(-1, 2)
        self._ends = np.array([find_frames(each) for each in self.loops]).reshape(-1, 2, 4, 4)
        self.length = self._find_length()
        self.scale = np.where(self._layout.angular, 1.0, 1.0 / self.length)
        """(r,): what makes a row of φ a number without unit."""
        self.unit = np.ones(robot.dof)
        """(dof,): the unit of each velocity, the size of the mechanism for one of a prismatic joint."""
        slides = np.array([kind == "P" for kind in robot.joint_types], dtype=bool)
        self.unit[robot.dof - len(slides) :][slides] = self.length
        self.table = self._make_table()
        """The numbers of the loops in the compiled core."""

    def _check_loops(self) -> None:
        robot, names = self.robot, set()
        for loop in self.loops:
            if not isinstance(loop, Loop):
                raise InputTypeError(f"loops are model.Loop objects, got {name_type(loop)}")
            if loop.name in names:
                raise InputError(f"two loops of {robot.name} are named {loop.name!r}")
            names.add(loop.name)
            for end in (loop.parent, loop.child):
                if end not in robot.frames:
                    raise suggest(
                        "link", end, robot.frames, owner=f"{robot.name}, which loop {loop.name!r} ties"
                    )
        if not self.loops:
            raise InputError(
                f"{robot.name} has no closed loops; give loops=, or describe them in its file ([[loops]] of"
                " TOML, <connect> and <weld> of MJCF)"
            )

    def _make_table(self) -> _core.LoopTable:
        """The loops as the compiled core takes them. Raises InputError for a loop that does not move."""
        robot, assembly, rows = self.robot, self.robot._assembly, self._layout
        n, first = assembly.n_joints, robot.dof - assembly.n_coordinates
        carries = np.zeros((n + 1, n))  # which joints carry a body, the base first
        for k in range(n):
            carries[k + 1] = carries[assembly.parent[k] + 1]
            carries[k + 1, k] = 1.0
        bodies = assembly.frame_joint[self._frames]
        sides = carries[bodies[:, 1] + 1] - carries[bodies[:, 0] + 1]
        still = [each.name for each, row in zip(self.loops, sides, strict=True) if not row.any()]
        if still:
            raise InputError(
                f"loop {still[0]!r} is between parts of {robot.name} that do not move against each other"
            )
        joints = np.column_stack(
            [
                assembly.parent,
                assembly.coordinate,
                assembly.coordinate + first,
                assembly.prismatic == 0.0,
                assembly.ratio,
                assembly.offset,
                assembly.T_parent_joint.reshape(n, 16),
            ]
        )
        places = (assembly.T_joint_frame[self._frames] @ self._ends).reshape(-1, 2, 16)
        ends = np.concatenate([bodies[..., None], places], axis=-1).reshape(-1, 34)
        loops = np.column_stack([ends, rows.signed, rows.upright.reshape(-1, 9)])
        rods = np.zeros(len(rows.loop))
        rods[rows.rods] = rows.lengths
        tied = np.column_stack([rows.loop, rows.P, rows.C.reshape(-1, 9), rods, self.scale])
        return _core.LoopTable(
            np.ascontiguousarray(joints, dtype=np.float64),
            np.ascontiguousarray(loops, dtype=np.float64),
            np.ascontiguousarray(tied, dtype=np.float64),
            np.ascontiguousarray(sides),
            self.unit,
            assembly.n_coordinates,
            float(self.length),
        )

    def _find_length(self) -> float:
        """The largest distance between consecutive axes, ends of loops, and the lengths of rods [m]."""
        assembly = self.robot._assembly
        sizes = [
            *np.linalg.norm(assembly.T_parent_joint[:, :3, 3], axis=1).tolist(),
            *np.linalg.norm((assembly.T_joint_frame[self._frames] @ self._ends)[..., :3, 3], axis=-1)
            .ravel()
            .tolist(),
            *self._layout.lengths.tolist(),
        ]
        return max(sizes) or 1.0

    def residual(self, q: ArrayLike) -> Array:
        """φ(q): how far the loops are open, zero where they are closed.

        q (..., n) [rad or m]. Returns φ (..., rows) [m, and sines of angles].
        Raises InputError for a wrong shape or NaN.
        """
        lead, at = self._place_checked(q)
        return at.phi.reshape((*lead, len(self.rows)))

    def jacobian(self, q: ArrayLike) -> Array:
        """K, the derivative of φ: φ̇ = K q̇.

        q (..., n) [rad or m]. Returns K (..., rows, dof); the columns of a floating base are zero.
        Raises InputError for a wrong shape or NaN.
        """
        lead, at = self._place_checked(q)
        return self.find_jacobian(at).reshape((*lead, len(self.rows), self.robot.dof))

    def bias(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """k = K̇ q̇, the part of φ̈ = K q̈ + k that velocities cause.

        q (..., n) [rad or m], qd (..., dof). Returns k (..., rows). Raises InputError for a wrong shape or
        NaN.
        """
        batch = rows_of(self.robot, q, qd=qd)
        refuse_infinite(batch)
        assert batch.qd is not None
        k = self.find_bias(self.place(batch.q), batch.qd)
        return k.reshape((*batch.shape, len(self.rows)))

    def miss(self, q: ArrayLike) -> Array:
        """The size of φ with angles in the unit of lengths, infinite where a loop is closed upside down.

        q (..., n) [rad or m]. Returns (...) [m]. Raises InputError for a wrong shape or NaN.
        """
        lead, at = self._place_checked(q)
        return self.find_miss(at).reshape(lead)

    def _place_checked(self, q: ArrayLike) -> tuple[tuple[int, ...], Placement]:
        """The leading axes of q (..., n) and its placement, as rows. Raises InputError for a wrong shape or
        NaN."""
        batch = rows_of(self.robot, q)
        refuse_infinite(batch)
        return batch.shape, self.place(batch.q)

    def name_open_loop(self, q: Array) -> str:
        """The name of the loop that is open farthest at one configuration q (n,)."""
        at = self.place(q[None])
        worst = np.zeros(len(self.loops))
        np.maximum.at(worst, self._layout.loop, np.abs(at.phi[0] * self.scale))
        worst[at.over[0]] = np.inf
        return self.loops[int(np.argmax(worst))].name

    def place(self, q: Array) -> Placement:
        """How far the loops are open at rows q (m, n), which are not checked."""
        q = np.ascontiguousarray(q)
        phi = np.empty((len(q), len(self.rows)))
        over = np.empty((len(q), len(self.loops)), dtype=bool)
        self.table.evaluate(q, None, phi, over, None, None, None, 1)
        return Placement(q, phi, over)

    def find_miss(self, at: Placement) -> Array:
        """The size of φ (rows,) [m] at a placement; see miss."""
        size = np.linalg.norm(at.phi * self.scale, axis=-1) * self.length
        result: Array = np.where(at.over.any(axis=-1), np.inf, size)
        return result

    def find_jacobian(self, at: Placement) -> Array:
        """K (rows, r, dof) at a placement."""
        K = np.empty((len(at.q), len(self.rows), self.robot.dof))
        self.table.evaluate(at.q, None, None, None, K, None, None, 1)
        return K

    def find_bias(self, at: Placement, qd: Array) -> Array:
        """k (rows, r) at a placement, with velocities qd (rows or 1, dof)."""
        qd = np.ascontiguousarray(np.broadcast_to(qd, (len(at.q), self.robot.dof)))
        k = np.empty((len(at.q), len(self.rows)))
        self.table.evaluate(at.q, qd, None, None, None, None, k, 1)
        return k

    def wrenches(self, q: ArrayLike, multipliers: ArrayLike) -> Array:
        """What each loop exerts on its child link under multipliers of the rows.

        q (..., n) [rad or m], multipliers (..., rows). Returns (..., loops, 6): force and torque [N, N·m] at
        the origin of the loop's frame in the child, in axes of the base; the parent feels the opposite wrench
        at this point. Raises InputError for a wrong shape or NaN.
        """
        lead, at = self._place_checked(q)
        f = as_floats(multipliers, "multipliers", last=(len(self.rows),))
        f = np.broadcast_to(f, (*lead, len(self.rows))).reshape(-1, len(self.rows), 1)
        wrench = np.empty((len(at.q), len(self.rows), 6))
        self.table.evaluate(at.q, None, None, None, None, wrench, None, 1)
        wrench *= f
        by_loop = np.zeros((len(at.q), len(self.loops), 6))
        for r, loop in enumerate(self._layout.loop):
            by_loop[:, loop] += wrench[:, r]
        return by_loop.reshape((*lead, len(self.loops), 6))

    def __repr__(self) -> str:
        return f"<LoopConstraints of {self.robot.name}: {len(self.loops)} loops, {len(self.rows)} rows>"
