"""Random robots for the tests: trees and chains with joints of all kinds."""

from dataclasses import replace

import numpy as np

from cspace.model import Description, Inertial, Joint, Link, Mimic
from cspace.model.joint import RESISTANCES


def random_pose(rng, reach=0.5):
    """A pose with a uniform random rotation."""
    Q, R = np.linalg.qr(rng.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    if np.linalg.det(Q) < 0:
        Q[:, 0] = -Q[:, 0]
    T = np.eye(4)
    T[:3, :3] = Q
    T[:3, 3] = rng.uniform(-reach, reach, 3)
    return T


def random_inertial(rng):
    A = rng.normal(size=(3, 3))
    return Inertial(rng.uniform(0.1, 5.0), rng.uniform(-0.2, 0.2, 3), A @ A.T * 0.01)


def random_tree(rng, n=12, kinds=("revolute", "continuous", "prismatic", "fixed"), mimics=True, branch=0.3):
    """A tree of n joints; some mimic an earlier one."""
    links = [Link(f"link_{i}", random_inertial(rng) if rng.random() < 0.8 else None) for i in range(n + 1)]
    joints = []
    for i in range(n):
        kind = str(rng.choice(kinds))
        parent = int(rng.integers(0, i + 1)) if rng.random() < branch else i
        leaders = [j.name for j in joints if j.type in ("revolute", "continuous", "prismatic")]
        mimic = None
        if mimics and leaders and kind in ("revolute", "prismatic") and rng.random() < 0.2:
            mimic = Mimic(str(rng.choice(leaders)), rng.uniform(-2, 2), rng.uniform(-1, 1))
        limits = {"lower": -rng.uniform(0, 3), "upper": rng.uniform(0, 3)} if kind != "continuous" else {}
        if kind not in ("revolute", "prismatic"):
            limits = {}
        if kind != "fixed" and rng.random() < 0.5:
            limits |= {"velocity": rng.uniform(0, 5), "effort": rng.uniform(0, 50)}
        axis = rng.normal(size=3)
        joints.append(
            Joint(
                f"joint_{i}",
                kind,
                f"link_{parent}",
                f"link_{i + 1}",
                random_pose(rng),
                axis,
                mimic=mimic,
                **limits,
            )
        )
    order = rng.permutation(n)
    return Description("random", tuple(links), tuple(joints[i] for i in order))


def random_values(rng, description):
    """A value for every moving joint."""
    return {joint.name: rng.uniform(-3, 3) for joint in description.moving_joints}


def with_resistances(rng, description):
    """The robot with a damping, a friction and an armature at half of its joints."""
    joints = []
    for joint in description.joints:
        values = dict(zip(RESISTANCES, rng.uniform(0, 2, 3).tolist(), strict=True))
        joints.append(replace(joint, **values) if rng.random() < 0.5 else joint)
    return replace(description, joints=tuple(joints))
