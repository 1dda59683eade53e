"""The drawing of an arm from its joint axes and a configuration: paths of links, poses of joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.ik.joint_axes import place_axes
from cspace.ik.wrapping import revolute_joints
from cspace.kinematics import KinematicModel
from cspace.model import Chain
from cspace.tolerances import DRAWN_LENGTH, DRAWN_PLANE

CENTER: Final = np.zeros(3)
"""Where the base is, unless it is mounted elsewhere [m]."""
PARALLEL: Final = 0.08
"""Sine of the angle below which two axes are routed as parallel: their common normal would lie far away."""
DETOUR: Final = 1.9
"""A route along axes and common normal longer than this many straight distances is drawn straight."""
SHORT: Final = 0.012
"""Pieces of a route below this share of the arm's length are left out."""
TURNING: Final = 1.4
SLIDING: Final = 2.2
"""Half the length of the body of a revolute and of a prismatic joint, in radii of its link."""
WIDTH: Final = 1.2
"""The radius of a joint's body, in radii of its link."""


@dataclass(frozen=True)
class Skeleton:
    """What is drawn of one configuration, in the base frame.

    paths: one polyline (m, 3) [m] per link, base link first, each from its joint to the next (or to the tip).
    radii: (n + 2,) [m], the thickness at the base, at each joint and at the tip.
    joints: (n, 3) [m], where the joint bodies are drawn, on their axes. axes: (n, 3), unit.
    types: "R" and "P". T_tip, T_base: (4, 4). length [m]: of the arm, see size_of. rails: for prismatic
    joints the piece (2, 3) they have travelled.
    """

    paths: list[Array]
    radii: Array
    joints: Array
    axes: Array
    types: str
    T_tip: Array
    T_base: Array
    length: float
    rails: list[Array]

    @property
    def points(self) -> Array:
        """Every corner of every path, (m, 3)."""
        return np.concatenate([*self.paths, *self.rails])

    def body_half(self, i: int) -> float:
        """Half the length of the body of joint i [m]."""
        return float((TURNING if self.types[i] == "R" else SLIDING) * self.radii[i + 1])


def make_skeleton(robot: KinematicModel, q: Array) -> Skeleton:
    """The skeleton of a robot at the configuration `q` (dof,)."""
    chain = robot.chain
    types = str(chain.joint_types)
    at = place_axes(chain, q)
    before, axes, T_tip = at.points, at.axes, np.asarray(robot.fk(q))
    after = before + np.where(revolute_joints(types), 0.0, q)[:, None] * axes  # behind their own motion
    T_base = np.asarray(robot.fk(q, robot.base))
    foot, up = T_base[:3, 3], T_base[:3, 2]
    length = size_of(chain.points, chain.T_zero, foot)
    n = len(types)
    paths = [route_link(foot, up, before[0], axes[0], length)]
    for i in range(n - 1):
        paths.append(route_link(after[i], axes[i], before[i + 1], axes[i + 1], length))
    paths.append(route_link(after[-1], axes[-1], T_tip[:3, 3], axes[-1], length))
    radii = length * np.linspace(0.046, 0.019, n + 2)
    joints = np.array([body_place(i, before, axes, paths, radii) for i in range(n)])
    leaving = paths[1][1] - paths[1][0]
    half = TURNING * radii[1]
    if types[0] == "R" and abs(axes[0] @ up) > 0.98 and leaving @ up > 2.0 * half:
        height = float((joints[0] - foot) @ up)
        if abs(height) < half:  # the first joint stands on the ground and does not hang below it
            joints[0] += (half - height) * up
    rails = [np.array([before[i], after[i]]) for i in range(n) if types[i] == "P"]
    return Skeleton(paths, radii, joints, axes, types, T_tip, T_base, length, rails)


def size_of(points: Array, T_zero: Array, foot: Array = CENTER) -> float:
    """The length [m] of the path from the base over the joints to the tip at zero: the drawing's scale."""
    way = np.concatenate([foot[None], points, T_zero[None, :3, 3]])
    length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    return length if length > DRAWN_LENGTH else 1.0


def route_link(p: Array, a: Array, r: Array, b: Array, length: float) -> Array:
    """The way of a link from point p on axis a to point r on axis b, as a builder would make it: along the
    first axis, across by the common normal, along the second; straight where that would be a detour.
    """
    d = r - p
    straight = float(np.linalg.norm(d))
    if straight < SHORT * length:
        return np.array([p, r])
    normal = np.cross(a, b)
    sine = float(np.linalg.norm(normal))
    if sine < PARALLEL:
        corners = [p, p + (d @ a) * a, r]
    else:
        t = np.linalg.det([d, b, normal]) / sine**2
        u = np.linalg.det([d, a, normal]) / sine**2
        corners = [p, p + t * a, r + u * b, r]
    if np.linalg.norm(np.diff(corners, axis=0), axis=1).sum() > DETOUR * straight:
        return np.array([p, r])
    return without_short_pieces(corners, SHORT * length)


def without_short_pieces(corners: list[Array], shortest: float) -> Array:
    """The corners without those that follow another too closely; both ends stay."""
    kept = [corners[0]]
    for corner in corners[1:-1]:
        if np.linalg.norm(corner - kept[-1]) > shortest and np.linalg.norm(corner - corners[-1]) > shortest:
            kept.append(corner)
    return np.array([*kept, corners[-1]])


def body_place(i: int, before: Array, axes: Array, paths: list[Array], radii: Array) -> Array:
    """Where the body of joint i is drawn: at its point, or slid along its axis where joints share a point.

    In a spherical wrist the first joint sits back in the forearm, the last one forward in the flange.
    """
    place, room = before[i], 2.6 * radii[i + 1]
    crowded_ahead = i + 1 < len(before) and np.linalg.norm(before[i + 1] - place) < room
    crowded_behind = i > 0 and np.linalg.norm(before[i - 1] - place) < room
    arriving, leaving = paths[i][-2] - paths[i][-1], paths[i + 1][1] - paths[i + 1][0]
    for crowded, way in ((crowded_ahead, arriving), (crowded_behind, leaving)):
        long = float(np.linalg.norm(way))
        if crowded and long > radii[i + 1] and abs(way @ axes[i]) > 0.98 * long:
            return np.asarray(place + way / long * min(0.5 * long, 1.3 * room))
    return np.asarray(place)


def planar_basis(chain: Chain) -> Array | None:
    """The plane of a planar arm as rows x, y of a (2, 3) array, or None if the arm leaves every plane.

    Planar: revolute axes all parallel, prismatic axes across them, all in the base frame at zero.
    """
    axes, types = np.asarray(chain.axes), str(chain.joint_types)
    turning = [axes[i] for i, kind in enumerate(types) if kind == "R"]
    if not turning:
        return None
    normal = turning[0]
    for axis, kind in zip(axes, types, strict=True):
        off = np.linalg.norm(np.cross(axis, normal)) if kind == "R" else abs(axis @ normal)
        if off > DRAWN_PLANE:
            return None
    x = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[2]
    x = x - (x @ normal) * normal
    x = x / np.linalg.norm(x)
    y = np.cross(normal, x)
    if normal.sum() < 0:  # seen from the side where the base's own axes point up and right
        y = -y
    return np.array([x, y])
