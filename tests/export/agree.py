"""Goals of every kind for an arm, and whether an export answers them as the library does."""

from __future__ import annotations

import numpy as np

SPECIAL = 5  # poses per kind of configuration


def goals(robot, count, seed):
    """Poses (n, 4, 4) at random configurations, at singular ones, out of reach; and how many are random."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (count, robot.dof))
    singular = rng.uniform(-np.pi, np.pi, (SPECIAL * 2, robot.dof))
    singular[:SPECIAL] *= rng.integers(0, 2, (SPECIAL, robot.dof))  # many joints at zero
    singular[SPECIAL:] = np.round(singular[SPECIAL:] / (np.pi / 2)) * (np.pi / 2)
    reached = robot.fk(np.vstack([q, singular, np.zeros((1, robot.dof))]))
    far = robot.fk(rng.uniform(-np.pi, np.pi, (SPECIAL, robot.dof)))
    far[:, :3, 3] += 50.0
    return np.concatenate([reached, far]), count


def nonsense(robot):
    """Matrices that are no pose."""
    T = robot.fk(np.zeros(robot.dof))
    bad = np.array([T] * 4)
    bad[0, 0, 3], bad[1, 3, 0], bad[2, :3, 0], bad[3, 1, 1] = np.nan, 0.1, -bad[2, :3, 0], np.inf
    return bad


def apart(q, others, joint_types):
    """The distance of q from the nearest of others, revolute joints the short way round."""
    if len(others) == 0:
        return np.inf
    away = np.abs(others - q)
    turns = np.array([kind == "R" for kind in joint_types])
    away[:, turns] = np.abs((away[:, turns] + np.pi) % (2 * np.pi) - np.pi)
    return away.max(axis=1).min()


def check_regular(robot, answer, goal, **asked):
    """The same verdict and the same set of solutions, each of which reaches the goal; is the certificate the
    same too?
    """
    found = robot.ik(goal, **asked)
    assert answer.status == found.status, goal
    assert len(answer.q) == len(found.q), goal
    for q in answer.q:
        assert apart(q, found.q, robot.joint_types) < 1e-7, (q, found.q)
    check_rows(robot, answer, goal)
    return answer.complete == found.complete


def check_special(robot, answer, goal, **asked):
    """Reached or not alike, every row reaches the goal, and isolated solutions are the same.

    At a singular pose rounding, and so the instruction set, decides whether two solutions are one.
    """
    found = robot.ik(goal, **asked)
    assert bool(len(answer.q)) == bool(found), goal
    assert (answer.status == "unreachable") == (found.status == "unreachable"), goal
    check_rows(robot, answer, goal)
    if found.status == answer.status == "exact" and found.complete:
        for q in found.q:
            assert apart(q, answer.q, robot.joint_types) < 1e-4, (q, answer.q)


def check_rows(robot, answer, goal):
    length = max(1.0, np.abs(goal[:3, 3]).max())
    for q, T, J in zip(answer.q, answer.T, answer.J, strict=True):
        np.testing.assert_allclose(robot.fk(q), goal, atol=1e-8 * length)
        np.testing.assert_allclose(T, robot.fk(q), atol=1e-12 * length)
        np.testing.assert_allclose(J, robot.jacobian(q), atol=1e-11 * length)
        assert np.all(np.abs(q[[kind == "R" for kind in robot.joint_types]]) <= np.pi)
