"""Forward kinematics in the plainest way: one matrix per joint, multiplied from the root outward."""

import numpy as np


def motion(kind, axis, value):
    """exp of a unit twist at the origin: Rodrigues' formula by its matrix powers, or a translation."""
    T = np.eye(4)
    if kind in ("revolute", "continuous", "R"):
        x, y, z = axis
        K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        T[:3, :3] += np.sin(value) * K + (1 - np.cos(value)) * (K @ K)
    elif kind in ("prismatic", "P"):
        T[:3, 3] = value * np.asarray(axis)
    return T


def joint_values(description, q):
    """The value of each joint, mimics resolved; q: joint name → value, the others at zero."""

    def value(joint):
        if joint.mimic is None:
            return q.get(joint.name, 0.0)
        leader = description.joint_by_name[joint.mimic.joint]
        return joint.mimic.multiplier * value(leader) + joint.mimic.offset

    return {joint.name: value(joint) for joint in description.joints}


def link_poses(description, q):
    """The pose of every link in the root, by recursion to the root."""
    values = joint_values(description, q)

    def pose(link):
        joint = description.parent_joint.get(link)
        if joint is None:
            return np.eye(4)
        return pose(joint.parent) @ joint.origin @ motion(joint.type, joint.axis, values[joint.name])

    return {link.name: pose(link.name) for link in description.links}


def product_of_exponentials(axes, points, joint_types, T_zero, q):
    """exp(ξ₁ q₁) … exp(ξₙ qₙ) T_zero, each exponential as a motion about the axis through its point."""
    T = np.eye(4)
    for axis, point, kind, value in zip(axes, points, joint_types, q, strict=True):
        to, back = np.eye(4), np.eye(4)
        to[:3, 3], back[:3, 3] = point, -np.asarray(point)
        T = T @ to @ motion(kind, axis, value) @ back
    return T @ T_zero
