"""Wrists that are straight to 1e-12 … 1e-7 rad: the tip hardly moves while the wrist rolls, and yet the
solutions are isolated. All of them are listed, and the list is certified."""

import numpy as np
import pytest

import cspace as cs
from ik.geometries import angle_gap

ARMS = ["irb120", "lrmate200id", "kr6_r900", "puma560"]


def wrist_flipped(q):
    """The configuration of a spherical wrist with the same orientation of the hand."""
    return q + np.array([0, 0, 0, np.pi, -2 * q[4], np.pi])


@pytest.mark.parametrize("bend", [1e-11, 1e-10, 1e-9, 3e-9, 1e-8, 1e-7, 1e-6])
@pytest.mark.parametrize("name", ARMS)
def test_an_almost_straight_wrist_has_both_its_solutions(name, bend):
    robot = cs.load_robot(name)
    for q in robot.random_configuration(20, rng=6):
        q[4] = 0.5
        if np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] < 0.02:
            continue  # the elbow or the shoulder is singular too
        q[4] = bend
        s = robot.ik(robot.fk(q))
        assert np.max(s.residual) <= 1e-12
        assert len(s.q) % 2 == 0
        if s.self_motions:  # as far as the tip can tell, the wrist rolls freely
            assert bend < 2e-9
            continue
        assert s.complete
        digits = 1e-14 / bend  # what rounding of the goal leaves of the roll
        assert angle_gap(s.q, q).min() < 10 * digits + 1e-8
        assert angle_gap(s.q, wrist_flipped(q)).min() < 10 * digits + 1e-8


@pytest.mark.parametrize("name", ARMS[:3])
def test_lists_near_right_angles_are_certified(name):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(8)
    q = np.pi / 2 * rng.integers(-2, 3, (150, 6)) + 1e-8 * rng.uniform(-1, 1, (150, 6))
    complete = np.mean([robot.ik(T).complete for T in robot.fk(q)])
    assert complete >= 0.95  # not where the shoulder is singular as well, and the roll hardly leaves the goal


@pytest.mark.parametrize("pairs", [((4, 0.0),), ((2, 0.0),), ((2, 0.0), (4, 0.0))])
def test_counts_do_not_depend_on_how_a_curve_is_followed(pairs):
    """The same goals moved at the base: another run of the same curves."""
    robot = cs.load_robot("ur5e")
    q = robot.random_configuration(15, rng=9)
    for joint, value in pairs:
        q[:, joint] = value
    turned = q + np.array([1.1, 0, 0, 0, 0, 0])
    for T, other in zip(robot.fk(q), robot.fk(turned), strict=True):
        s, t = robot.ik(T), robot.ik(other)
        assert (len(s.q), len(s.self_motions), s.complete) == (len(t.q), len(t.self_motions), t.complete)


@pytest.mark.parametrize("off", [1e-9, 1e-8, 1e-7, 1e-6])
@pytest.mark.parametrize("name", ["ur3e", "ur5e", "ur10"])
def test_a_certified_list_near_two_folds_has_what_made_the_pose(name, off):
    """Elbow and wrist are folded to `off`: rounding of the wrist moves the elbow past its fold."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(12)
    for q in robot.random_configuration(25, rng=rng):
        q[[2, 4]] = np.pi * rng.integers(0, 2, 2) + off * rng.choice([-1, 1], 2)
        s = robot.ik(robot.fk(q))
        if s.complete and not s.self_motions:
            assert angle_gap(s.q, q).min() < 1e-3
