"""Joints near multiples of 45° or 90°, where several singularities meet: lists stay certified, and a
certified list holds the configuration that made the goal."""

import numpy as np
import pytest

import cspace as cs
from ik.geometries import angle_gap
from ik.likenesses import LIKENESSES, size_of

ARMS = ["ur5", "ur3", "puma560", "kr6_r900", "irb1600", "gp7", "j2s6s300", "puma_style", "elbow", "z1"]
ROUNDING = 1e-13
"""Error [arm's lengths, rad] that rounding of a goal leaves at a configuration near a singularity."""
FOLDED = 2e-3
"""Distance [rad] by which rounding moves an elbow where it is straight and the wrist is straight to 1e-9."""

NEAR_MISS = 1e-12
"""Error [arm's lengths, rad] of what lies beyond a fold by next to nothing, and may be listed or not."""


def near_multiples(step, off, n, seed, exactly=0.0):
    """(n, 6): multiples of step [deg], off by up to off [rad]; a share of the joints is not off."""
    rng = np.random.default_rng([seed, step])
    turns = np.radians(step) * rng.integers(-180 // step, 180 // step + 1, (n, 6))
    return turns + off * rng.uniform(-1, 1, (n, 6)) * (rng.random((n, 6)) >= exactly)


def error_of(robot, goal, q):
    """(6,): the error of q over the size of the arm, its rotation to first order."""
    at = robot.fk(q)
    sine = at[:3, :3].T @ goal[:3, :3]
    turn = [sine[2, 1] - sine[1, 2], sine[0, 2] - sine[2, 0], sine[1, 0] - sine[0, 1]]
    return np.r_[(goal[:3, 3] - at[:3, 3]) / size_of(robot), at[:3, :3] @ np.array(turn) / 2]


def barrier(robot, goal, start, end, weak):
    """The largest error on the way between two configurations, along the directions weaker than `weak`."""
    way = (end - start + np.pi) % (2 * np.pi) - np.pi
    largest = 0.0
    for part in np.linspace(0, 1, 6)[1:-1]:
        q = start + part * way
        for _ in range(4):
            J = robot.jacobian(q) / np.repeat([size_of(robot), 1], 3)[:, None]
            u, sigma, v = np.linalg.svd(J)
            firm = sigma > weak
            q = q + v[firm].T @ (u[:, firm].T @ error_of(robot, goal, q) / sigma[firm])
        largest = max(largest, np.abs(error_of(robot, goal, q)).max())
    return largest


def is_listed(robot, s, q):
    """q is listed, or rounding does not tell it from a listed solution, or there are self-motions."""
    gaps = angle_gap(s.q, q)
    nearest = s.q[gaps.argmin()]
    if s.self_motions or gaps.min() < 1e-6:
        return True
    ways = (barrier(robot, s.goal, nearest, q, weak) for weak in (1e-3, 1e-5, 1e-7))
    return gaps.min() < FOLDED and min(ways) < ROUNDING


def lists_without(name, off, n, seed):
    """The configurations near multiples of 45° and of 90° that a certified list of their pose lacks."""
    robot = cs.load_robot(name)
    rows = [q for step in (45, 90) for q in near_multiples(step, off, n, seed, 0.5)]
    answers = ((robot.ik(robot.fk(q)), q) for q in rows)
    return [q for s, q in answers if s.complete and not is_listed(robot, s, q)]


@pytest.mark.parametrize("name", ARMS)
def test_certificates_are_rarely_withheld(name):
    robot = cs.load_robot(name)
    q = near_multiples(90, 1e-8, 3000, 4)
    assert np.mean([robot.ik(T).complete for T in robot.fk(q)]) >= 0.99


@pytest.mark.parametrize("off", [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3])
@pytest.mark.parametrize("name", ARMS)
def test_a_certified_list_holds_the_configuration_that_made_the_goal(name, off):
    assert not lists_without(name, off, 30, 5)


@pytest.mark.slow
@pytest.mark.parametrize("off", [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3])
@pytest.mark.parametrize("name", ARMS)
def test_many_configurations(name, off):
    assert not lists_without(name, off, 1000, 6)


@pytest.mark.parametrize("likeness", LIKENESSES)
@pytest.mark.parametrize("name", ARMS)
def test_certified_lists_of_likenesses_are_the_same(name, likeness):
    """Turned, scaled, mirrored and reversed arms, and other zeros of the joints."""
    robot, rng = cs.load_robot(name), np.random.default_rng([7, *map(ord, name)])
    like = LIKENESSES[likeness](robot, rng)
    for q in near_multiples(90, 1e-8, 12, 8):
        s = robot.ik(robot.fk(q))
        t = like.robot.ik(like.to_goal(s.goal))
        if not (s.complete and t.complete):
            continue
        for one, other, rows in ((robot, s, like.from_q(t.q)), (like.robot, t, like.to_q(s.q))):
            for row in rows:
                missed = np.abs(error_of(one, other.goal, row)).max() > NEAR_MISS
                assert missed or is_listed(one, other, row)
