"""Self-motions of arms whose wrist is on the first axis, so that the first joint is free."""

import numpy as np
import pytest

import cspace as cs

AXES = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]]
"""A base, three parallel axes, and two axes of a wrist that meet in the plane of the arm."""


def arm_of_random_lengths(rng):
    """Its links are in the plane y = 0, so that the first axis may pass through the wrist."""
    steps = rng.uniform(0.1, 0.5, (5, 3)) * [1, 0, 1] * rng.choice([-1, 1], (5, 3))
    points = np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
    points[4] = points[5] - [0, 0, rng.uniform(0.1, 0.3)]
    T_zero = np.eye(4)
    T_zero[:3, 3] = points[5] + [rng.uniform(0.05, 0.2), 0, 0]
    return cs.Robot.from_screws(AXES, points, T_zero)


def wrist_on_first_axis(robot, rng):
    """A configuration whose wrist is on the first axis, or None: the second joint by the sign of the gap."""

    def gap(value):
        T = cs.model.chain(robot.description)
        moved = robot.fk([0, value, *q[2:4], 0, 0]) @ np.linalg.inv(T.T_zero)
        return float((moved @ [*T.points[5], 1])[0])

    q = rng.uniform(-3, 3, 6)
    grid = np.linspace(-np.pi, np.pi, 41)
    values = np.array([gap(value) for value in grid])
    changes = np.flatnonzero(values[:-1] * values[1:] < 0)
    if not len(changes):
        return None
    low, high = grid[changes[0]], grid[changes[0] + 1]
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if gap(middle) * values[changes[0]] > 0 else (low, middle)
    q[1] = low
    return q


def largest_gap(rows, q):
    return np.abs(np.angle(np.exp(1j * (rows - q)))).max(axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_every_configuration_of_the_goal_is_on_a_listed_curve(seed):
    """The first joint may have values on several arcs, of which only one contains zero."""
    rng = np.random.default_rng([31, seed])
    robot, tried = arm_of_random_lengths(rng), 0
    while tried < 4:
        q = wrist_on_first_axis(robot, rng)
        if q is None:
            robot = arm_of_random_lengths(rng)
            continue
        tried += 1
        T = robot.fk(q)
        s = robot.ik(T)
        assert s.residual.max() < 1e-9
        curves = [motion.sample(400) for motion in s.self_motions if motion is not None]
        members = np.vstack([s.q, *curves])
        np.testing.assert_allclose(robot.fk(members), np.broadcast_to(T, (len(members), 4, 4)), atol=1e-9)
        found = robot.ik(T, near=q)
        assert largest_gap(found.q, q).max() < 1e-6
        assert not s.complete or largest_gap(members, q).min() < 0.2
