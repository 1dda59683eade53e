"""Cartesian paths: their geometry, their derivatives against differences, and what is refused."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.trajectory import arc_path, line_path, pose_path, screw_path

SEEDS = range(6)
STEP = 1e-5
DIFFERENCES = 1e-8  # of second-order differences with this step, twists and rates of size 1


def random_poses(seed, count):
    rng = np.random.default_rng(seed)
    return np.array([cs.spatial.random_pose(rng=rng) for _ in range(count)])


def paths(seed):
    P = random_poses(seed, 5)
    return {
        "line": line_path(P[0], P[1]),
        "screw": screw_path(P[0], P[1]),
        "via": arc_path(P[0], P[2], via=P[1][:3, 3]),
        "kept": arc_path(P[0], P[2], via=P[1][:3, 3], rotation="keep"),
        "valve": arc_path(P[0], center=P[3][:3, 3], axis=P[4][:3, 0], angle=-7.0),
        "sharp": pose_path(P),
        "blended": pose_path(P, deviation=0.05),
        "round": pose_path(P, deviation=10.0),
    }


KINDS = tuple(paths(0))


def rotation_between(A, B):
    return cs.spatial.log_so3(B[..., :3, :3] @ np.swapaxes(A[..., :3, :3], -1, -2))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", KINDS)
def test_twists_are_the_derivatives_of_poses(kind, seed):
    path = paths(seed)[kind]
    inside = [b + f * h for b, h in zip(path.breaks, path.lengths, strict=False) for f in (0.1, 0.5, 0.83)]
    s = np.array(inside)
    ahead, behind = path(s + STEP), path(s - STEP)
    twist, rate = path.twists(s)
    moved = np.concatenate([ahead[:, :3, 3] - behind[:, :3, 3], rotation_between(behind, ahead)], axis=1)
    np.testing.assert_allclose(twist, moved / (2 * STEP), atol=DIFFERENCES)
    change = (path.twists(s + STEP)[0] - path.twists(s - STEP)[0]) / (2 * STEP)
    np.testing.assert_allclose(rate, change, atol=DIFFERENCES * max(1.0, np.abs(rate).max()))
    assert np.linalg.norm(twist.reshape(-1, 2, 3), axis=2).max() <= 1.4


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", ["blended", "round"])
def test_blends_join_with_continuous_second_derivatives(kind, seed):
    path = paths(seed)[kind]
    assert not path.stops.size
    inner = np.arange(1, len(path.lengths))
    for before, after in zip(
        (path.poses_on(inner - 1, path.lengths[:-1]), *path.twists_on(inner - 1, path.lengths[:-1])),
        (path.poses_on(inner, 0 * path.lengths[1:]), *path.twists_on(inner, 0 * path.lengths[1:])),
        strict=True,
    ):
        np.testing.assert_allclose(before, after, atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_blends_pass_corners_within_both_deviations_and_the_ends_exactly(seed):
    P = random_poses(seed, 6)
    for miss, turn_miss in ((0.01, 0.2), (0.2, 0.02), (0.03, 10.0)):
        path = pose_path(P, deviation=miss, turn_deviation=turn_miss)
        np.testing.assert_allclose(path([0, path.length]), P[[0, -1]], atol=1e-12)
        T = path(np.linspace(0, path.length, 20001))
        for corner in P[1:-1]:
            off = np.linalg.norm(T[:, :3, 3] - corner[:3, 3], axis=1)
            turned = np.linalg.norm(rotation_between(corner, T), axis=1)
            together = np.argmin(np.maximum(off / miss, turned / turn_miss))
            assert off[together] <= miss * (1 + 1e-3)
            assert turned[together] <= turn_miss * (1 + 1e-3)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_screw_has_a_constant_twist_and_a_line_a_straight_point(seed):
    P = random_poses(seed, 2)
    line, screw = paths(seed)["line"], screw_path(*P)
    np.testing.assert_allclose(screw([0, screw.length]), P, atol=1e-12)
    share = np.linspace(0, 1, 9)
    np.testing.assert_allclose(
        screw(share * screw.length), cs.spatial.interpolate(P[0], P[1], share), atol=1e-12
    )
    start, goal = line([0, line.length])
    np.testing.assert_allclose(
        line(share * line.length), cs.spatial.interpolate_decoupled(start, goal, share), atol=1e-12
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_an_arc_stays_on_its_circle_and_meets_its_via_point(seed):
    P = random_poses(seed, 3)
    path = arc_path(P[0], P[2], via=P[1][:3, 3])
    points = path(np.linspace(0, path.length, 20001))[:, :3, 3]
    np.testing.assert_allclose(points[[0, -1]], P[[0, 2], :3, 3], atol=1e-12)
    assert np.linalg.norm(points - P[1][:3, 3], axis=1).min() < 1e-3
    speed = np.linalg.norm(path.twists(np.linspace(0, path.length, 9))[0][:, :3], axis=1)
    np.testing.assert_allclose(speed, speed[0], rtol=1e-12)


def test_a_valve_carries_the_rotation_along():
    T = cs.pose((0.5, 0.1, 0.2), rpy=(0.1, 0.2, 0.3))
    center, axis = np.array([0.4, 0.0, 0.2]), np.array([0.0, 0.0, 2.0])
    path = arc_path(T, center=center, axis=axis, angle=3 * np.pi)
    turn = cs.pose(center) @ cs.pose((0, 0, 0), rpy=(0, 0, 1.1)) @ cs.inverse_pose(cs.pose(center))
    np.testing.assert_allclose(path(path.length * 1.1 / (3 * np.pi)), turn @ T, atol=1e-12)
    kept = arc_path(T, center=center, axis=axis, angle=1.0, rotation="keep")
    np.testing.assert_allclose(kept(kept.length)[:3, :3], T[:3, :3], atol=1e-15)


def test_where_the_path_turns_back_it_stops_and_repeated_poses_count_once():
    there, back = cs.pose((1, 0, 0)), cs.pose((0.2, 0, 0))
    path = pose_path([cs.pose((0, 0, 0)), there, there, back], deviation=0.1)
    np.testing.assert_allclose(path.stops, [1.0])
    np.testing.assert_allclose(path.length, 1.8)
    straight = pose_path([cs.pose((0, 0, 0)), cs.pose((0.3, 0, 0)), there])
    assert not straight.stops.size


def test_points_on_a_line_give_a_line():
    T, goal = cs.pose((0, 0, 0)), cs.pose((1, 0, 0), rpy=(0, 0, 1))
    path = arc_path(T, goal, via=(0.3, 0, 0))
    np.testing.assert_allclose(path(0.5)[:3, 3], [0.5, 0, 0])
    np.testing.assert_allclose(path(path.length), goal, atol=1e-15)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda T, G: line_path(T, T), "all poses are the same"),
        (lambda T, G: line_path(T, cs.pose((1, 0, 0), rpy=(np.pi, 0, 0))), "180° apart"),
        (lambda T, G: line_path(T, np.full((4, 4), np.nan)), "goal pose"),
        (lambda T, G: pose_path([T]), r"shape \(1, 4, 4\)"),
        (lambda T, G: pose_path([T, G], deviation=-1.0), "deviation is -1"),
        (lambda T, G: pose_path([T, G], deviation=np.nan), "deviation"),
        (lambda T, G: arc_path(T, G), "needs a goal pose and via="),
        (lambda T, G: arc_path(T, G, via=(0, 0, 0)), "via is an end"),
        (lambda T, G: arc_path(T, G, via=(9, 0, 0)), "not between"),
        (lambda T, G: arc_path(T, T, via=(0.5, 0, 0)), "full circle"),
        (lambda T, G: arc_path(T, center=(1, 0, 0), axis=(0, 0, 0), angle=1), "axis is zero"),
        (lambda T, G: arc_path(T, center=(1, 0, 0), axis=(0, 0, 1), angle=0), "its angle is zero"),
        (lambda T, G: arc_path(T, center=(1, 0, 0), axis=(0, 0, 1), angle=1, rotation="slerp"), "'slerp'"),
        (lambda T, G: arc_path(T, G, via=(0, 1, 0), center=(1, 0, 0)), "needs a goal pose and via="),
        (lambda T, G: line_path(T, G)(1.5), "the path is from 0 to 1"),
        (lambda T, G: line_path(T, G).twists(-0.1), "the path is from 0 to 1"),
    ],
)
def test_what_is_no_path_is_named(make, message):
    with pytest.raises(InputError, match=message):
        make(np.eye(4), cs.pose((1, 0, 0)))


@pytest.mark.parametrize("seed", range(20))
def test_blends_that_meet_leave_no_piece_of_rounding(seed):
    """Legs of equal length whose blends want more than half of them."""
    rng = np.random.default_rng(seed)
    side = rng.uniform(1e-3, 1.0)
    corners = side * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]])
    turn = cs.spatial.random_pose(rng=rng)
    for scale in (0.11, 0.2, 0.3, 0.5, 2.0):
        path = pose_path(np.array([turn @ cs.pose(c) for c in corners]), deviation=scale * side)
        assert (np.diff(path.breaks) > 1e-9 * side).all()
        assert np.abs(path(path.breaks[-1])[:3, 3] - turn[:3, 3]).max() < 1e-12
