"""Motions of a robot without kinetic energy: where there are any, its mass matrix is singular."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.kinematics import Assembly, random_configurations
from cspace.model.values import rotation_about, translation_by
from cspace.spatial.rotations import skew
from cspace.tolerances import MASSLESS_MOTION

BASE: Final = "the base"
"""What the first six velocities of a floating robot move."""

TAKES_PART: Final = 0.01
"""Share of a unit motion from which on a joint counts as one of those that move."""

ROUNDING: Final = 64.0 * np.finfo(float).eps
"""Of a product of a dozen poses, relative to the reach of the robot."""

REACH: Final = 1.0
"""Range of prismatic joints without limits [m], of which one value is drawn."""

Z_AXIS: Final = np.array([0.0, 0.0, 1.0])


def massless_motions(assembly: Assembly) -> tuple[str, ...]:
    """The coordinates, by name, that take part in motions without kinetic energy; none for a sound robot.

    A null vector of M = AᵀA at one random configuration is one at all of them, but for a set of measure zero.
    """
    names = (BASE,) * (6 if assembly.floating else 0) + assembly.coordinates
    if not names:
        return ()
    q = random_configurations(assembly.limits, assembly.coordinate_types, rng=0, reach=REACH)
    A = energy_factor(assembly, q)
    sizes = np.linalg.norm(A, axis=0)
    still = sizes <= column_rounding(assembly, q)
    _, sigma, Vt = np.linalg.svd(A / np.where(still, np.inf, sizes), full_matrices=False)
    null = Vt[sigma <= MASSLESS_MOTION * max(float(sigma[0]), np.finfo(float).tiny)]
    moving = (np.abs(null) > TAKES_PART).any(axis=0)
    return tuple(dict.fromkeys(name for name, moves in zip(names, moving, strict=True) if moves))


def column_rounding(assembly: Assembly, q: Array) -> float:
    """Rounding of the columns of the energy factor: that of velocities of centres far from the base."""
    steps = np.linalg.norm(assembly.T_parent_joint[:, :3, 3], axis=1).sum()
    slides = np.abs(assembly.prismatic * (assembly.ratio * q[assembly.coordinate] + assembly.offset)).sum()
    reach = steps + slides + np.linalg.norm(assembly.center, axis=1).max()
    return float(ROUNDING * np.sqrt(assembly.mass.sum()) * reach)


def energy_factor(assembly: Assembly, q: Array) -> Array:
    """A (rows, dof) with the kinetic energy ½ |A q̇|², so that the mass matrix is AᵀA.

    Six rows per body, √m times the velocity of its centre and √I times its turning, and one per joint with an
    armature. q (n,) [rad or m].
    """
    n, first = assembly.n_joints, 6 if assembly.floating else 0
    velocities = np.zeros((n + 1, 6, first + n))  # of the origin of the world as part of each body, [v; ω]
    velocities[0, :, :first] = np.eye(6)[:, :first]
    T_base_joint = [np.eye(4)]
    values = assembly.ratio * q[assembly.coordinate] + assembly.offset
    for k, (parent, slides) in enumerate(zip(assembly.parent.tolist(), assembly.prismatic, strict=True)):
        T = T_base_joint[parent + 1] @ assembly.T_parent_joint[k]
        axis, point = T[:3, 2], T[:3, 3]
        velocities[k + 1] = velocities[parent + 1]
        column = [axis, np.zeros(3)] if slides else [np.cross(point, axis), axis]
        velocities[k + 1, :, first + k] = np.concatenate(column)
        move = translation_by(values[k] * Z_AXIS) if slides else rotation_about(Z_AXIS, values[k])
        T_base_joint.append(T @ move)
    rows = []
    for T, V, m, c, inertia in zip(
        T_base_joint, velocities, assembly.mass, assembly.center, assembly.inertia, strict=True
    ):
        moments, axes = np.linalg.eigh(inertia)
        root = np.sqrt(np.maximum(moments, 0.0))[:, None] * (T[:3, :3] @ axes).T
        rows += [np.sqrt(m) * (V[:3] - skew(T[:3, :3] @ c + T[:3, 3]) @ V[3:]), root @ V[3:]]
    rotors = np.zeros((n, first + n))
    rotors[:, first:] = np.diag(np.sqrt(assembly.armature))
    by_joint = np.concatenate([*rows, rotors])
    to_joints = np.zeros((first + n, first + assembly.n_coordinates))  # velocities of all joints from q̇
    to_joints[:first, :first] = np.eye(first)
    to_joints[first + np.arange(n), first + assembly.coordinate] = assembly.ratio
    result: Array = by_joint @ to_joints
    return result
