"""The equations of closed loops: residual, Jacobian, and the accelerations that velocities alone cause."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, suggest
from cspace.kinematics.batch import check_robot, refuse_infinite, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.kinematics.loop_rows import Flags, find_frames, make_rows
from cspace.model import Loop
from cspace.spatial.poses import invert_pose
from cspace.spatial.rotations import skew
from cspace.spatial.vectors import cross


@dataclass(frozen=True, eq=False)
class Placement:
    """Where the frames of loops and the axes of joints are at configurations, in axes of the base.

    R_A, R_B (..., loops, 3, 3), p_A, p_B (..., loops, 3): the frames of each loop in its parent and its
    child. axes, points (..., joints, 3).
    """

    R_A: Array
    p_A: Array
    R_B: Array
    p_B: Array
    axes: Array
    points: Array

    @property
    def d(self) -> Array:
        """The child frame as seen from the parent frame (..., loops, 3)."""
        result: Array = ((self.p_B - self.p_A)[..., None, :] @ self.R_A)[..., 0, :]
        return result

    @property
    def D(self) -> Array:
        """The relative rotation (..., loops, 3, 3)."""
        result: Array = self.R_A.swapaxes(-1, -2) @ self.R_B
        return result


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
        assembly = robot._assembly
        index = [[assembly.frame_index[end] for end in (each.parent, each.child)] for each in self.loops]
        self._frames = np.array(index, dtype=np.intp).reshape(-1, 2)
        self._ends = np.array([find_frames(each) for each in self.loops]).reshape(-1, 2, 4, 4)
        self._find_joints()
        joints = np.arange(assembly.n_joints)
        self._to_coordinates = np.zeros((assembly.n_joints, robot.dof))
        self._to_coordinates[joints, assembly.coordinate + robot.dof - assembly.n_coordinates] = (
            assembly.ratio
        )
        bodies = assembly.frame_joint[self._frames] + 1
        sides = self._carries[bodies]  # (loops, 2, joints)
        self._signs = sides[:, 1] - sides[:, 0]
        self._bodies = bodies
        still = [each.name for each, row in zip(self.loops, self._signs, strict=True) if not row.any()]
        if still:
            raise InputError(
                f"loop {still[0]!r} is between parts of {robot.name} that do not move against each other"
            )
        self.length = self._find_length()
        self.scale = np.where(self._layout.angular, 1.0, 1.0 / self.length)
        """(r,): what makes a row of φ a number without unit."""

    def _check_loops(self) -> None:
        robot, names = self.robot, set()
        for loop in self.loops:
            if not isinstance(loop, Loop):
                raise InputTypeError(f"loops are model.Loop objects, got a {type(loop).__name__}")
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

    def _find_joints(self) -> None:
        """Which joints carry which bodies, and where their axes are in the frames that they carry."""
        assembly = self.robot._assembly
        n = assembly.n_joints
        self._revolute = assembly.prismatic == 0.0
        self._carries = np.zeros((n + 1, n))  # the base first
        for k in range(n):
            self._carries[k + 1] = self._carries[assembly.parent[k] + 1]
            self._carries[k + 1, k] = 1.0
        carried = {int(joint): f for f, joint in enumerate(assembly.frame_joint) if joint >= 0}
        self._joint_frames: Array | None = None
        if len(carried) == n:  # only parts of planar joints carry no frame
            self._joint_frames = np.array([carried[k] for k in range(n)], dtype=np.intp)
            back = invert_pose(assembly.T_joint_frame[self._joint_frames])
            self._joint_axes, self._joint_points = back[:, :3, 2], back[:, :3, 3]

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
        return self.find_residual(at).reshape((*lead, len(self.rows)))

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
        np.maximum.at(worst, self._layout.loop, np.abs(self.find_residual(at)[0] * self.scale))
        worst[self._find_turned_over(at)[0]] = np.inf
        return self.loops[int(np.argmax(worst))].name

    def place(self, q: Array) -> Placement:
        """Where the frames of the loops and the axes of the joints are at rows q (m, n), which are not
        checked."""
        T = np.empty((len(q), len(self.robot.frames), 4, 4))
        base = np.eye(4)[None] if self.robot.floating else None
        if not _core._tree_rows(
            self.robot, np.ascontiguousarray(q), base, T, None, None, 1 if len(q) == 1 else 0
        ):
            T.fill(np.nan)
        ends = T[..., self._frames, :, :] @ self._ends
        R, p = ends[..., :3, :3], ends[..., :3, 3]
        if self._joint_frames is None:
            axes, points = self._walk_joints(q)
        else:
            carried = T[..., self._joint_frames, :3, :]
            axes = (carried[..., :3] @ self._joint_axes[..., None])[..., 0]
            points = (carried[..., :3] @ self._joint_points[..., None])[..., 0] + carried[..., 3]
        return Placement(R[..., 0, :, :], p[..., 0, :], R[..., 1, :, :], p[..., 1, :], axes, points)

    def _walk_joints(self, q: Array) -> tuple[Array, Array]:
        """Axes and points of all joints, one after the other."""
        assembly = self.robot._assembly
        values = assembly.ratio * q[..., assembly.coordinate] + assembly.offset
        poses = [np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))]
        for k in range(assembly.n_joints):
            move = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4)).copy()
            if self._revolute[k]:
                c, s = np.cos(values[..., k]), np.sin(values[..., k])
                move[..., 0, 0], move[..., 0, 1], move[..., 1, 0], move[..., 1, 1] = c, -s, s, c
            else:
                move[..., 2, 3] = values[..., k]
            poses.append(poses[assembly.parent[k] + 1] @ assembly.T_parent_joint[k] @ move)
        joints = np.stack(poses[1:], axis=-3)
        return joints[..., :3, 2], joints[..., :3, 3]

    def find_residual(self, at: Placement) -> Array:
        """φ (..., r) at a placement."""
        rows = self._layout
        d, D = at.d[..., rows.loop, :], at.D[..., rows.loop, :, :]
        phi: Array = np.einsum("ri,...ri->...r", rows.P, d) + np.einsum("rij,...rij->...r", rows.C, D)
        if rows.rods.size:
            rods = d[..., rows.rods, :]
            phi[..., rows.rods] = ((rods * rods).sum(axis=-1) - rows.lengths**2) / (2.0 * rows.lengths)
        return phi

    def _find_turned_over(self, at: Placement) -> Flags:
        """Which loops (..., loops) are nearer to a place upside down."""
        upright = np.einsum("lij,...lij->...l", self._layout.upright, at.D)
        result: Flags = self._layout.signed & (upright <= 0.0)
        return result

    def find_miss(self, at: Placement) -> Array:
        """The size of φ (...) [m] at a placement; see miss."""
        size = np.linalg.norm(self.find_residual(at) * self.scale, axis=-1) * self.length
        result: Array = np.where(self._find_turned_over(at).any(axis=-1), np.inf, size)
        return result

    def find_jacobian(self, at: Placement) -> Array:
        """K (..., r, dof) at a placement."""
        arm = at.p_B[..., :, None, :] - at.points[..., None, :, :]
        axes = at.axes[..., None, :, :]
        rows, turns = self._layout, self._revolute[:, None]
        linear = np.where(turns, cross(axes, arm), axes) * self._signs[..., None]
        angular = np.where(turns, axes, 0.0) * self._signs[..., None]
        P, g = self._find_row_vectors(at)
        loop = rows.loop
        by_joint = np.einsum("...ri,...rki->...rk", P, (linear @ at.R_A)[..., loop, :, :])
        by_joint = by_joint + np.einsum("...ri,...rki->...rk", g, (angular @ at.R_A)[..., loop, :, :])
        result: Array = by_joint @ self._to_coordinates
        return result

    def _find_row_vectors(self, at: Placement) -> tuple[Array, Array]:
        """The wrench [f; n] of each row, (..., r, 3) both, in the axes of A at the origin of B."""
        rows = self._layout
        G = at.D[..., rows.loop, :, :] @ rows.C.swapaxes(-1, -2)
        turned = G.swapaxes(-1, -2) - G  # of its axis vector
        g = np.stack([turned[..., 2, 1], turned[..., 0, 2], turned[..., 1, 0]], axis=-1)
        P = np.broadcast_to(rows.P, g.shape)
        if rows.rods.size:
            P = P.copy()
            P[..., rows.rods, :] = at.d[..., rows.loop[rows.rods], :] / rows.lengths[:, None]
        return P, g

    def find_bias(self, at: Placement, qd: Array) -> Array:
        """k (..., r) at a placement, with velocities qd (..., dof)."""
        v, w, a, alpha = (each[..., self._bodies.T, :] for each in self._find_body_motions(at, qd))
        p = np.stack([at.p_A, at.p_B], axis=-3)  # (..., 2, loops, 3) as all of these
        turns = skew(w)
        K = skew(alpha) + turns @ turns
        (turn_A, turn_B), (K_A, K_B) = (np.moveaxis(each, -4, 0) for each in (turns, K))
        velocity = v + cross(w, p)
        rate = a + cross(alpha, p) + cross(w, velocity)
        dp, dv, da = (each[..., 1, :, :] - each[..., 0, :, :] for each in (p, velocity, rate))
        back, to_A = turn_A.swapaxes(-1, -2), at.R_A.swapaxes(-1, -2)
        d_rate = (to_A @ (back @ dp[..., None] + dv[..., None]))[..., 0]
        d_bend = K_A.swapaxes(-1, -2) @ dp[..., None] + 2.0 * back @ dv[..., None] + da[..., None]
        d_bend = (to_A @ d_bend)[..., 0]
        D_bend = to_A @ (K_A.swapaxes(-1, -2) + 2.0 * back @ turn_B + K_B) @ at.R_B
        rows = self._layout
        k: Array = np.einsum("ri,...ri->...r", rows.P, d_bend[..., rows.loop, :])
        k = k + np.einsum("rij,...rij->...r", rows.C, D_bend[..., rows.loop, :, :])
        if rows.rods.size:
            loop = rows.loop[rows.rods]
            d, speed, bend = at.d[..., loop, :], d_rate[..., loop, :], d_bend[..., loop, :]
            k[..., rows.rods] = ((speed * speed).sum(axis=-1) + (d * bend).sum(axis=-1)) / rows.lengths
        return k

    def _find_body_motions(self, at: Placement, qd: Array) -> tuple[Array, Array, Array, Array]:
        """Velocity and acceleration of all bodies against the base, the joints not accelerating.

        v, a (..., bodies, 3): of the point of the body that passes the origin of the base, a as a spatial
        acceleration; w, alpha (..., bodies, 3): angular.
        """
        rates = (qd @ self._to_coordinates.T)[..., None]
        turns = self._revolute[:, None]
        s_w = np.where(turns, at.axes, 0.0) * rates
        s_v = np.where(turns, cross(at.points, at.axes), at.axes) * rates
        w, v = self._carries @ s_w, self._carries @ s_v
        w_joint, v_joint = w[..., 1:, :], v[..., 1:, :]
        bends = cross(np.stack([w_joint, w_joint, v_joint]), np.stack([s_w, s_v, s_w]))
        alpha, a = self._carries @ bends[0], self._carries @ (bends[1] + bends[2])
        # The classical acceleration of a point p is a + alpha × p + w × (velocity of p).
        return v, w, a, alpha

    def wrenches(self, q: ArrayLike, multipliers: ArrayLike) -> Array:
        """What each loop exerts on its child link under multipliers of the rows.

        q (..., n) [rad or m], multipliers (..., rows). Returns (..., loops, 6): force and torque [N, N·m] at
        the origin of the loop's frame in the child, in axes of the base; the parent feels the opposite wrench
        at this point. Raises InputError for a wrong shape or NaN.
        """
        lead, at = self._place_checked(q)
        P, g = self._find_row_vectors(at)
        f = as_floats(multipliers, "multipliers", last=(len(self.rows),))
        f = np.broadcast_to(f, (*lead, len(self.rows))).reshape(-1, len(self.rows), 1)
        wrench = np.concatenate([P * f, g * f], axis=-1)
        by_loop = np.zeros((*wrench.shape[:-2], len(self.loops), 6))
        for r, loop in enumerate(self._layout.loop):
            by_loop[..., loop, :] += wrench[..., r, :]
        parts = by_loop.reshape((*by_loop.shape[:-1], 2, 3)) @ at.R_A.swapaxes(-1, -2)
        return parts.reshape((*lead, len(self.loops), 6))

    def __repr__(self) -> str:
        return f"<LoopConstraints of {self.robot.name}: {len(self.loops)} loops, {len(self.rows)} rows>"
