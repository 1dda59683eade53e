"""Mass, centre and inertia of many bodies in the plainest way: one matrix per link, then Steiner."""

import numpy as np

from oracles.forward import link_poses, motion


def join_bodies(bodies):
    """Mass, centre (3,) and inertia about it (3, 3) of bodies (mass, centre, inertia, pose (4, 4))."""
    mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for m, c, inertia, T in bodies:
        R, p = T[:3, :3], T[:3, :3] @ c + T[:3, 3]
        mass, first = mass + m, first + m * p
        second = second + R @ inertia @ R.T + m * (p @ p * np.eye(3) - np.outer(p, p))
    if mass == 0.0:
        return 0.0, np.zeros(3), second
    center = first / mass
    return mass, center, second - mass * (center @ center * np.eye(3) - np.outer(center, center))


def described_body(description, q, base=None):
    """All links as one body in the frame of a link; q: joint name → value, others at zero."""
    poses = link_poses(description, q)
    T_base_root = np.linalg.inv(poses[description.root if base is None else base])
    links = [(link.inertial, T_base_root @ poses[link.name]) for link in description.links if link.inertial]
    return join_bodies([(one.mass, one.com, one.inertia, T) for one, T in links])


def joint_poses(assembly, q):
    """The pose (4, 4) of the base and of every joint, axes turned to z, in the base."""
    values = assembly.ratio * np.asarray(q)[assembly.coordinate] + assembly.offset
    poses = [np.eye(4)]
    for k, parent in enumerate(assembly.parent):
        kind = "P" if assembly.prismatic[k] else "R"
        poses.append(poses[parent + 1] @ assembly.T_parent_joint[k] @ motion(kind, (0, 0, 1), values[k]))
    return poses


def assembled_body(robot, q):
    """All that a robot moves, and its base, as one body in the base: from the arrays that the core gets."""
    a = robot._assembly
    return join_bodies(list(zip(a.mass, a.center, a.inertia, joint_poses(a, q), strict=True)))


def same_body(a, b, rtol=1e-12):
    """Raise unless two bodies agree, relative to their size."""
    np.testing.assert_allclose(a[0], b[0], rtol=rtol)
    size = max(1.0, float(np.abs(b[1]).max()))
    np.testing.assert_allclose(a[1], b[1], rtol=0, atol=rtol * size)
    np.testing.assert_allclose(a[2], b[2], rtol=0, atol=rtol * max(np.abs(b[2]).max(), b[0] * size**2))
