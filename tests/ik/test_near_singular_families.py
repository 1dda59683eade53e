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
