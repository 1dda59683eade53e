"""Arms of up to three joints of every kind: complete against many Newton starts, honest about misses."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from cspace.model import from_screws
from cspace.robot import Robot
from cspace.spatial import pose
from oracles import many_starts

WORDS = ["".join(w) for n in (1, 2, 3) for w in itertools.product("RP", repeat=n)]


def random_arm(rng, word, wild):
    """Axes, points and tip; wild: parallel, square or meeting axes."""
    n = len(word)
    axes, points = rng.normal(size=(n, 3)), rng.uniform(-1, 1, (n, 3))
    for i in range(1, n if wild else 1):
        kind = rng.integers(4)
        if kind == 0:
            axes[i] = axes[i - 1]
        elif kind == 1:
            axes[i] = np.cross(axes[i - 1], axes[i])
        if rng.integers(2):
            points[i] = points[i - 1]
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    T_zero = pose(rng.uniform(-1, 1, 3), rpy=rng.uniform(-3, 3, 3))
    return axes, points, T_zero


def reached(arm, word, q):
    axes, points, T_zero = arm
    slides = [c == "P" for c in word]
    return many_starts.tip_and_jacobian(axes, points, slides, T_zero[:3, 3], np.atleast_2d(q))[0]


@pytest.mark.slow
@pytest.mark.parametrize("word", WORDS)
def test_every_solution_is_listed(word):
    rng = np.random.default_rng(WORDS.index(word))
    turns = np.array([c == "R" for c in word])
    compared = 0
    for case in range(16):
        arm = random_arm(rng, word, case % 2)
        axes, points, T_zero = arm
        goal = reached(arm, word, rng.uniform(-1.5, 1.5, len(word)))[0]
        s = Robot(from_screws(axes, points, T_zero, joint_types=word)).ik(position=goal)
        assert s
        assert np.abs(reached(arm, word, s.q) - goal).max() < 1e-11
        if s.status == "singular":
            continue
        truth = many_starts.position_roots(axes, points, ~turns, T_zero[:3, 3], goal, rng)
        for q in truth:
            assert np.abs(many_starts.wrapped(s.q - q, turns)).max(axis=1).min() < 1e-6
        assert len(truth) <= len(s)
        compared += 1
    assert compared >= 4


@pytest.mark.parametrize("word", WORDS)
def test_poses_come_back(word):
    rng = np.random.default_rng(100 + WORDS.index(word))
    for case in range(20):
        robot = Robot(from_screws(*random_arm(rng, word, case % 2), joint_types=word))
        made = rng.uniform(-1.5, 1.5, robot.dof)
        s = robot.ik(robot.fk(made))
        assert s
        assert s.status == "singular" or np.abs(s.q - made).max(axis=1).min() < 1e-6


def test_a_point_out_of_reach_is_missed_by_as_little_as_possible():
    rng = np.random.default_rng(5)
    robot = Robot(from_screws(*random_arm(rng, "RRR", False)))
    spread = robot.fk(rng.uniform(-np.pi, np.pi, (4000, 3)))[:, :3, 3]
    missed = 0
    for p in rng.uniform(-2.5, 2.5, (40, 3)):
        s = robot.ik(position=p)
        least = np.linalg.norm(spread - p, axis=1).min()
        if not s:
            missed += 1
            assert least - 0.2 < s.out_of_reach <= least
    assert 5 < missed < 40


def arm_in_a_plane(rng, word):
    """An arm that keeps its tip in a plane: turns about z, slides across it. One joint is to spare."""
    a = rng.uniform(0, np.pi, 3)
    across = np.stack([np.cos(a), np.sin(a), np.zeros(3)], axis=1)
    axes = np.where([[kind == "R"] for kind in word], [0, 0, 1.0], across)
    points = np.append(rng.uniform(-1, 1, (3, 2)), np.zeros((3, 1)), axis=1)
    T_zero = pose((*rng.uniform(-1, 1, 2), 0.3))
    return Robot(from_screws(axes, points, T_zero, joint_types=word))


def arm_on_a_sphere(rng, word):
    """Three turns about lines that meet: the tip stays on a sphere, one joint is to spare."""
    axes = rng.normal(size=(3, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    T_zero = pose(rng.uniform(-1, 1, 3))
    return Robot(from_screws(axes, np.zeros((3, 3)), T_zero, joint_types=word))


@pytest.mark.slow
@pytest.mark.parametrize("word", ["".join(w) for w in itertools.product("RP", repeat=3)] + ["sphere"])
def test_each_curve_of_a_family_is_listed_once(word):
    rng = np.random.default_rng(len(word) + WORDS.index(word) if word in WORDS else 0)
    numbers = set()
    for _ in range(40):
        robot = arm_on_a_sphere(rng, "RRR") if word == "sphere" else arm_in_a_plane(rng, word)
        q = rng.uniform(-2, 2, 3)
        p = robot.fk(q)[:3, 3]
        found = robot.ik(position=p)
        assert np.abs(robot.fk(found.q)[:, :3, 3] - p).max() < 1e-9
        self_motions = found.self_motions
        assert len(self_motions) == len(found)
        gap = [np.abs(self_motion.nearest(q) - q).max() for self_motion in self_motions]
        assert min(gap) < 1e-6
        assert distance(robot, robot.ik(position=p, near=q).q[0], q) < 1e-6
        for a, b in itertools.permutations(self_motions, 2):
            assert distance(robot, a.nearest(b.q), b.q) > 1e-6
        numbers.add(len(found))
    assert numbers == ({2} if word == "PRP" else {1} if word.count("P") > 1 else {1, 2})


def distance(robot, a, b):
    turns = np.array([kind == "R" for kind in robot.joint_types])
    return np.abs(many_starts.wrapped((a - b)[None], turns)).max()
