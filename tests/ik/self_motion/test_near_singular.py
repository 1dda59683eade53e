"""Near every singular set of one arm of each class: what made the pose is found, at any small distance.

The singular configurations are met by turning one joint of random ones until det J changes its sign. Turning
each of the inner joints in turn meets every set: elbow, wrist and shoulder of the arms with a closed form.
"""

import numpy as np
import pytest

from ik.arms import load
from ik.likenesses import gap, random_configurations, size_of, slides_of

CLASSES = {
    "puma560": "spherical wrist, first axes meet",
    "kr6_r900": "spherical wrist, offset shoulder",
    "irb1600": "spherical wrist, offset elbow",
    "j2s6s300": "wrist of slanted axes",
    "romeo_left_leg": "spherical shoulder",
    "ur5e": "three parallel axes, last axes meet",
    "z1": "three parallel axes, square",
    "jaco2": "general",
    "crx10ia": "general, sixteen solutions",
    "xarm6": "general, many formulations",
    "gen3_lite": "general",
    "m1013": "general, parallel axes",
    "irb140": "general",
    "stanford": "slide before a wrist",
}
RECOVERED = {1e-2: 1.0, 1e-4: 0.999, 1e-6: 0.995}
POSES = 60


def singular_by(robot, joint, rng, n):
    """Up to n configurations with det J = 0, reached by moving this joint alone."""
    slides = slides_of(robot)
    t = np.linspace(-1, 1, 60) * (2 if slides[joint] else np.pi)  # zero, itself singular, is not among them
    q = random_configurations(robot, rng, 4 * n)
    lines = np.repeat(q[:, None], len(t), axis=1)
    lines[:, :, joint] = t
    det = np.linalg.det(robot.jacobian(lines))
    det[np.abs(det) < 1e-14 * np.abs(det).max()] = 0
    rows = np.flatnonzero((det[:, :-1] * det[:, 1:] < 0).any(axis=1))[:n]
    first = np.argmax(det[rows, :-1] * det[rows, 1:] < 0, axis=1)
    q, low, high, below = q[rows], t[first], t[first + 1], det[rows, first]
    for _ in range(55):
        q[:, joint] = 0.5 * (low + high)
        same = np.linalg.det(robot.jacobian(q)) * below > 0
        low, high = np.where(same, q[:, joint], low), np.where(same, high, q[:, joint])
    return q


def missed(robot, q):
    """Whether each configuration is not among its answers; and the batch."""
    batch = robot.ik(robot.fk(q), threads=1)
    assert np.nanmax(batch.residual, initial=0) <= 1e-9
    J = np.array(robot.jacobian(q))
    J[:, :3] /= size_of(robot)
    allowed = np.maximum(1e-5, 1e-13 / np.linalg.svd(J, compute_uv=False)[:, -1])
    gaps = np.nan_to_num(gap(robot, batch.q, q[:, None]), nan=np.inf).min(axis=1)
    return gaps > allowed, batch


@pytest.mark.parametrize("name", CLASSES)
def test_what_made_the_pose_is_found_near_every_singular_set(name):
    robot = load(name)
    rng = np.random.default_rng([1, *map(ord, name)])
    sets = [singular_by(robot, joint, rng, POSES) for joint in range(1, robot.dof - 1)]
    sets = [(joint, q) for joint, q in enumerate(sets, start=1) if len(q)]
    assert len(sets) >= 2
    for off, share in RECOVERED.items():
        lost = asked = 0
        for joint, singular in sets:
            q = singular.copy()
            q[:, joint] += off * rng.choice([-1, 1], len(q))
            away, batch = missed(robot, q)
            # A list that lacks it is never certified.
            assert not (away & batch.complete).any(), q[away & batch.complete].tolist()
            lost, asked = lost + away.sum(), asked + len(q)
        assert lost <= (1 - share) * asked


@pytest.mark.parametrize("name", ["crx10ia", "crx3ia"])
def test_a_self_motion_of_a_general_arm_is_found_from_every_pose_of_it(name):
    """With the elbow of these two at a right angle all six joints move and the tip does not."""
    robot, rng = load(name), np.random.default_rng(3)
    for q in random_configurations(robot, rng, 25):
        q[2] = -np.pi / 2
        assert np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] < 1e-12
        found = robot.ik(robot.fk(q))
        assert found.status == "singular"
        assert len(found.self_motions) >= 1


def test_pairs_that_share_a_hidden_angle_are_told_apart():
    """Two elbows turn joint 1 alike, and beside a wrist in line each of them has its pair."""
    robot = load("m1013")
    q = [
        -2.3147617650012298,
        -0.698540835764716,
        0.7188404731626012,
        2.9920728318058414,
        -5.771863182465889e-06,
        0.7325498962034991,
    ]
    away, batch = missed(robot, np.array([q]))
    assert not away.any()
    assert batch.count[0] == 10
