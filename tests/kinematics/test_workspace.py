"""Reachable workspaces: rings of planar arms, limits, area against counting, sampling."""

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError
from cspace.kinematics.planar_boundary import PlanarArm, is_reachable
from cspace.model import from_screws
from cspace.robot import Robot
from kinematics import robots
from model.random_robots import random_pose


def inside(curves, points):
    """Whether plane points lie within the curves: an odd number of crossings of a ray."""
    crossings = np.zeros(len(points), dtype=int)
    for curve in curves:
        a, b = curve[:-1, :2], curve[1:, :2]
        x, y = points[:, 0, None], points[:, 1, None]
        spans = (a[:, 1] > y) != (b[:, 1] > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        crossings += (spans & (x < at)).sum(axis=1)
    return crossings % 2 == 1


@pytest.mark.parametrize(
    "lengths", [(1.0, 0.4), (0.4, 1.0), (0.7, 0.7), (1.0, 0.3, 0.2), (0.5, 0.4, 0.3), (2, 0.3, 0.5, 0.1)]
)
def test_without_limits_a_planar_arm_reaches_a_ring(lengths):
    space = robots.planar(*lengths).workspace(2000, rng=1)
    outer, inner = sum(lengths), max(0.0, 2 * max(lengths) - sum(lengths))
    radii = sorted(np.hypot(*curve[0, :2]) for curve in space.boundary)
    np.testing.assert_allclose(radii, [inner, outer] if inner > 0 else [outer], atol=1e-12)
    for curve, radius in zip(sorted(space.boundary, key=lambda c: np.hypot(*c[0, :2])), radii, strict=True):
        np.testing.assert_allclose(np.hypot(curve[:, 0], curve[:, 1]), radius, atol=1e-12)
        np.testing.assert_array_equal(curve[0], curve[-1])
    assert space.area == pytest.approx(np.pi * (outer**2 - inner**2), rel=2e-4)  # of a 256-gon
    distance = np.linalg.norm(space.points[:, :2], axis=1)
    assert (distance <= outer + 1e-12).all()
    assert (distance >= inner - 1e-12).all()


@pytest.mark.parametrize(("lower", "upper"), [(-np.inf, np.inf), (-0.5, 2.0), (-9.0, 9.0), (1.0, 1.0)])
def test_one_joint_reaches_an_arc_with_nothing_inside(lower, upper):
    space = limited([0.7], [lower], [upper]).workspace(50, rng=1)
    (curve,) = space.boundary
    np.testing.assert_array_equal(curve[0], curve[-1])
    np.testing.assert_allclose(np.hypot(curve[:, 0], curve[:, 1]), 0.7, atol=1e-15)
    assert space.area == pytest.approx(0.0, abs=1e-14)
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    width = min(upper - lower, 2 * np.pi)
    assert steps.max() <= 0.7 * 2 * np.pi / 256
    assert steps.sum() == pytest.approx(2 * 0.7 * width, rel=1e-4)
    if width < 2 * np.pi:
        angles = np.arctan2(curve[:, 1], curve[:, 0])
        np.testing.assert_allclose([angles.min(), angles.max()], [lower, upper], atol=1e-12)


def limited(lengths, lower, upper):
    n = len(lengths)
    points = np.zeros((n, 3))
    points[1:, 0] = np.cumsum(lengths)[:-1]
    T_zero = np.eye(4)
    T_zero[0, 3] = sum(lengths)
    return Robot(from_screws([[0, 0, 1]] * n, points, T_zero, lower=lower, upper=upper))


def test_with_limits_the_boundary_of_a_2r_arm_is_made_of_the_four_arcs_everybody_draws():
    """Joint 1 in ±60°, joint 2 in 0 … 120°: two arcs about the base (elbow straight and at 120°), and
    the arcs of the second link with the first at either limit."""
    l1, l2, turn = 1.0, 0.6, np.pi / 3
    space = limited((l1, l2), [-turn, 0.0], [turn, 2 * turn]).workspace(4000, rng=2)
    assert len(space.boundary) == 1
    (curve,) = space.boundary
    x, y = curve[:, 0], curve[:, 1]
    elbows = [l1 * np.array([np.cos(a), np.sin(a)]) for a in (-turn, turn)]
    folded = np.sqrt(l1**2 + l2**2 + 2 * l1 * l2 * np.cos(2 * turn))
    off = np.min(
        [
            np.abs(np.hypot(x, y) - (l1 + l2)),
            np.abs(np.hypot(x, y) - folded),
            *(np.abs(np.hypot(x - ex, y - ey) - l2) for ex, ey in elbows),
        ],
        axis=0,
    )
    np.testing.assert_allclose(off, 0.0, atol=1e-9)
    # ∫ dA = ∫ |det J| over the box of the joints, where the elbow never changes side: l1 l2 ∫ sin θ2.
    assert space.area == pytest.approx(l1 * l2 * 2 * turn * (1 - np.cos(2 * turn)), rel=1e-4)
    assert inside([curve], space.points).mean() > 0.98  # the rest lies between the chords and the arcs


@pytest.mark.parametrize("seed", range(12))
def test_the_boundary_separates_what_is_reached_from_what_is_not(seed):
    """Random limits, two and three joints: the even-odd rule of the curves against the joints themselves."""
    rng = np.random.default_rng(seed)
    n = 2 + seed % 2
    lengths = rng.uniform(0.2, 1.0, n)
    lower, width = rng.uniform(-np.pi, 0, n), rng.uniform(0.3, 1.5 * np.pi, n)
    robot = limited(lengths, lower, lower + width)
    space = robot.workspace(3000, rng=seed)
    reach = lengths.sum()
    edge = np.concatenate(space.boundary)[:, :2]

    for curve in space.boundary:
        x, y = curve[:, 0], curve[:, 1]
        assert abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) > 1e-6 * reach**2, "a curve that encloses nothing"
        steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
        assert steps.max() <= 1.01 * reach * 2 * np.pi / 256, "a gap closed by a chord"

    def clear_of_edge(points):
        gaps = np.min(np.linalg.norm(points[:, None] - edge[None], axis=2), axis=1)
        return points[gaps > 0.02 * reach]

    reached = clear_of_edge(space.points[:400, :2])
    assert inside(space.boundary, reached).all()
    spread = clear_of_edge(rng.uniform(-reach, reach, (300, 2)))
    arm = PlanarArm(lengths, np.column_stack([lower, np.minimum(width, 2 * np.pi)]))
    np.testing.assert_array_equal(inside(space.boundary, spread), is_reachable(arm, spread @ (1, 1j)))


@pytest.mark.parametrize("n", [2, 3])
def test_reachable_agrees_with_a_grid_of_configurations(n):
    rng = np.random.default_rng(n)
    for _ in range(5):
        lengths, lower = rng.uniform(0.3, 1.0, n), rng.uniform(-np.pi, np.pi, n)
        width = rng.uniform(0.5, 2 * np.pi, n)
        robot = limited(lengths, lower, lower + width)
        some = robot.fk(rng.uniform(lower, lower + width, (300, n)))[:, :2, 3] @ (1, 1j)
        assert is_reachable(PlanarArm(lengths, np.column_stack([lower, width])), some).all()


def test_the_plane_may_lie_anywhere_and_axes_may_point_down():
    """The same arm turned in space, the second axis reversed: the same area, curves in its plane."""
    plain = limited((1.0, 0.6), [-1.0, 0.2], [1.0, 2.0])
    T = random_pose(np.random.default_rng(3))
    R, p = T[:3, :3], T[:3, 3]
    axes = np.array([R[:, 2], -R[:, 2]])
    points = np.array([[0, 0, 0.3], [1.0, 0, -0.1]]) @ R.T + p
    T_zero = np.eye(4)
    T_zero[0, 3], T_zero[2, 3] = 1.6, 0.2
    robot = Robot(from_screws(axes, points, T @ T_zero, lower=[-1.0, -2.0], upper=[1.0, -0.2]))
    space = robot.workspace(500, rng=0)
    assert space.area == pytest.approx(plain.workspace(1, rng=0).area, rel=1e-9)
    local = (np.concatenate(space.boundary) - p) @ R
    np.testing.assert_allclose(local[:, 2], 0.2, atol=1e-12)
    flat = [(curve - p) @ R for curve in space.boundary]
    assert inside(flat, (space.points - p) @ R * [1, 1, 0]).mean() > 0.99


def test_any_other_robot_is_sampled_within_its_limits():
    robot = robots.arm(3, "RPRRPR")
    space = robot.workspace(500, rng=7)
    assert space.points.shape == (500, 3)
    assert space.boundary == ()
    assert space.area is None
    np.testing.assert_allclose(robot.fk(space.q)[:, :3, 3], space.points, atol=1e-14)
    assert (space.q >= robot.limits.lower).all()
    assert (space.q <= robot.limits.upper).all()
    np.testing.assert_array_equal(robot.workspace(500, rng=7).points, space.points)
    elbow = robot.workspace(50, "link_3", rng=7)
    np.testing.assert_allclose(robot.fk(elbow.q, "link_3")[:, :3, 3], elbow.points, atol=1e-14)
    low, high = space.bounds
    assert (low <= space.points).all()
    assert (space.points <= high).all()


def test_random_configurations_stay_within_limits_and_turn_all_the_way_without():
    free = robots.planar(1.0, 1.0).random_configuration(20_000, rng=0)
    assert (free > -np.pi).all()
    assert (free <= np.pi).all()
    assert np.abs(free.mean()) < 0.05
    assert robots.planar(1.0).random_configuration(rng=0).shape == (1,)
    slide = Robot(from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), joint_types="P"))
    with pytest.raises(InputError, match="has the limits -inf and inf m; without a finite range give reach="):
        slide.random_configuration(3)
    assert np.abs(slide.random_configuration(100, rng=1, reach=0.5)).max() <= 0.5
    with pytest.raises(InputError, match="n is 0"):
        slide.workspace(0)
    with pytest.raises(InputTypeError, match="whole number"):
        robots.planar(1.0).workspace(2.5)


def test_arcs_that_overlap_are_drawn_once():
    """Equal limits on both sides make the inner arcs of both elbows parts of one circle."""
    third = np.pi / 3
    space = limited((0.4, 0.3, 0.25), [-third] * 3, [third] * 3).workspace(100, rng=1)
    (curve,) = space.boundary
    inner = np.hypot(curve[:, 0], curve[:, 1]).min()
    bent = 0.4 + 0.3 * np.exp(1j * third) + 0.25 * np.exp(2j * third)
    assert inner == pytest.approx(abs(bent), rel=1e-9)
    np.testing.assert_allclose(curve[:, 1].min(), -curve[:, 1].max(), atol=1e-4)
