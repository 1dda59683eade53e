"""Arms whose axes coincide, or nearly: an honest refusal or right answers, never a wrong one."""

import numpy as np
import pytest

from cspace.ik import geometry
from cspace.model import from_screws
from cspace.robot import Robot
from ik.geometries import angle_gap, random_arm, random_q

X, Y, Z = np.eye(3)

# Joints to spare: every configuration is singular, and no list of configurations could be complete.
ALWAYS_SINGULAR = {
    "axes 1 and 2 are one line": (
        [Z, Z, Y, X, Y, X],
        [[0, 0, 0], [0, 0, 0.3], [0.1, 0, 0.3], [0.5, 0, 0.4], [0.5, 0, 0.4], [0.5, 0, 0.4]],
    ),
    "axes 3 and 4 are one line": (
        [Z, Y, X, X, Y, X],
        [[0, 0, 0], [0.1, 0, 0.3], [0.1, 0.2, 0.6], [0.5, 0.2, 0.6], [0.5, 0.2, 0.6], [0.5, 0.2, 0.6]],
    ),
    "axes 5 and 6 are one line": (
        [Z, Y, Y, X, Y, Y],
        [[0, 0, 0], [0, 0, 0.3], [0.1, 0, 0.6], [0.5, 0, 0.4], [0.5, 0, 0.4], [0.5, 0, 0.4]],
    ),
    "upper arm of length zero": (
        [Z, Y, -Y, X, Y, X],
        [[0, 0, 0], [0.1, 0, 0.3], [0.1, 0, 0.3], [0.5, 0, 0.4], [0.5, 0, 0.4], [0.5, 0, 0.4]],
    ),
    "forearm of length zero": (
        [Z, Y, Y, X, Y, X],
        [[0, 0, 0], [0.1, 0, 0.3], [0.4, 0, 0.3], [0.4, 0, 0.3], [0.4, 0, 0.3], [0.4, 0, 0.3]],
    ),
    "wrist on axis 3": (
        [Z, Y, X, Y, X, Y],
        [[0, 0, 0], [0.1, 0, 0.3], [0, 0.1, 0.7], [0.5, 0.1, 0.7], [0.5, 0.1, 0.7], [0.5, 0.1, 0.7]],
    ),
    "three parallel axes and a wrist": (
        [Z, Z, Z, X, Y, X],
        [[0, 0, 0], [0.4, 0, 0], [0.8, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0]],
    ),
    "four parallel axes": (
        [Z, Y, Y, Y, Y, X],
        [[0, 0, 0], [0, 0, 0.3], [0.3, 0, 0.3], [0.6, 0, 0.3], [0.9, 0, 0.2], [1, 0, 0]],
    ),
    "six parallel axes": ([Z] * 6, [[0.1 * i, 0, 0] for i in range(6)]),
    "a shoulder and a wrist": ([Z, Y, Z, Y, Z, Y], [[0, 0, 0.3]] * 3 + [[0, 0.4, 1]] * 3),
    "all axes through one point": ([Z, Y, Z, Y, Z, Y], [[0, 0, 0.3]] * 6),
}

# Close to degenerate, or special in a way that is none: these are solved.
REGULAR = {
    "axes 1 and 4 are one line at zero": (
        [Z, Y, Y, Z, Y, Z],
        [[0, 0, 0], [0, 0, 0.3], [0.3, 0, 0.3], [0, 0, 0], [0, 0, 1], [0, 0, 2]],
    ),
    "axes 1 and 2 meet at an angle of 1e-4": (
        [Z, [1e-4, 0, 1], Y, X, Y, X],
        [[0, 0, 0], [0, 0, 0.1], [0.4, 0, 0.3], [0.8, 0, 0.3], [0.8, 0, 0.3], [0.8, 0, 0.3]],
    ),
    "axes 1 and 2 miss each other by a micrometre": (
        [Z, X, Y, X, Y, X],
        [[0, 0, 0], [0, 1e-6, 0.1], [0.4, 0, 0.3], [0.8, 0, 0.3], [0.8, 0, 0.3], [0.8, 0, 0.3]],
    ),
    "axes 4 and 5 meet at an angle of 1e-3": (
        [Z, Y, Y, X, [1, 1e-3, 0], X],
        [[0, 0, 0], [0.1, 0, 0.3], [0.4, 0, 0.3], [0.8, 0, 0.5], [0.8, 0, 0.5], [0.8, 0, 0.5]],
    ),
    "links of equal length": (
        [Z, Y, Y, X, Y, X],
        [[0, 0, 0], [0, 0, 0.3], [0, 0, 0.6], [0, 0, 0.9], [0, 0, 0.9], [0, 0, 0.9]],
    ),
    "parallel axes and a wrist without offsets": (
        [Z, Y, Y, Y, Z, Y],
        [[0, 0, 0], [0, 0, 0], [0.4, 0, 0], [0.8, 0, 0], [0.8, 0, 0], [0.8, 0, 0]],
    ),
}


def arm(axes, points):
    T_zero = np.eye(4)
    T_zero[:3, 3] = [0.1, 0.9, 1.3]
    return Robot(from_screws(np.array(axes), np.array(points, dtype=float), T_zero, name="odd"))


@pytest.mark.parametrize("name", ALWAYS_SINGULAR)
def test_an_arm_with_a_joint_to_spare_is_answered_with_the_freedom_named(name):
    robot = arm(*ALWAYS_SINGULAR[name])
    q = random_q(np.random.default_rng(1), 20, 6)
    assert np.linalg.svd(robot.jacobian(q), compute_uv=False)[:, -1].max() < 1e-12
    for row, T in zip(q, robot.fk(q), strict=True):
        found = robot.ik(T)
        assert found
        assert found.residual.max() < 1e-11
        assert len(found.freedom) >= 1
        near = robot.ik(T, near=row)
        assert angle_gap(near.q, row).max() < 1e-7
    assert geometry(robot).family == "redundant"


@pytest.mark.parametrize("name", REGULAR)
def test_an_arm_that_only_looks_odd_is_solved(name):
    robot = arm(*REGULAR[name])
    q = random_q(np.random.default_rng(2), 40, 6)
    for row, T in zip(q, robot.fk(q), strict=True):
        found = robot.ik(T)
        assert angle_gap(found.q, row).min() < 1e-6
        assert found.residual.max() < 1e-12


@pytest.mark.parametrize("seed", range(10))
def test_random_arms_with_two_wrists(seed):
    rng = np.random.default_rng(seed)
    robot = random_arm("MSXMS", rng)
    found = robot.ik(robot.fk(random_q(rng, 6)))
    assert found
    assert found.residual.max() < 1e-11
    assert len(found.freedom) == 1


@pytest.mark.parametrize("bend", [1e-7, 1e-6, 4e-6])
def test_a_joint_to_spare_hidden_by_rounding_is_never_answered_wrongly(bend):
    """Two wrists, one of them bent by what printing π/2 with few digits does to an axis."""
    axes, points = (np.array(v, dtype=float) for v in ALWAYS_SINGULAR["a shoulder and a wrist"])
    points[2, 0] += bend
    robot = arm(axes, points)
    q = random_q(np.random.default_rng(3), 10, 6)
    for row, T in zip(q, robot.fk(q), strict=True):
        found = robot.ik(T, near=row)
        assert found.residual.max() < 1e-9
        assert angle_gap(found.q, row).min() < 1e-4
