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


def distance_from_arc(path, point):
    """Of a point to the circle of an arc [m], from the poses on both sides of the nearest one."""
    s = np.linspace(0.0, path.length, 2001)
    near = s[np.linalg.norm(path(s)[:, :3, 3] - point, axis=1).argmin()]
    for _ in range(6):  # Newton
        gap, slope = path(near)[:3, 3] - point, path.twists(near)[0][:3]
        near = np.clip(near - gap @ slope / (slope @ slope), 0.0, path.length)
    return np.linalg.norm(path(near)[:3, 3] - point)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("bow", [1.0, 1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 2e-9, 1e-9, 1e-10, 1e-13])
def test_an_arc_attains_its_ends_however_large_its_radius(bow, seed):
    rng = np.random.default_rng(seed)
    for chord in (1e-3, 0.1, 1.0, 10.0):
        start, goal = random_poses(int(rng.integers(1000)), 2)
        R = cs.spatial.random_pose(rng=rng)[:3, :3]
        goal[:3, 3] = start[:3, 3] + chord * R[:, 0]
        via = start[:3, 3] + chord * (rng.uniform(0.05, 0.95) * R[:, 0] + bow * R[:, 1])
        for rotation in ("interpolate", "keep", "follow"):
            path = arc_path(start, goal, via=via, rotation=rotation)
            np.testing.assert_array_equal(path(0.0)[:3, 3], start[:3, 3])
            rounding = np.spacing(np.abs([start[:3, 3], goal[:3, 3]]).max())
            missed = np.linalg.norm(path(path.length)[:3, 3] - goal[:3, 3])
            assert missed < 1e-12 * chord + 4 * rounding
            assert distance_from_arc(path, via) < 1e-9 * chord


@pytest.mark.parametrize("radius", [1e-3, 1.0, 1e4, 1e8, 1e12])
def test_an_arc_about_an_axis_far_away_starts_at_the_tip(radius):
    start = cs.pose((0.3, -0.2, 0.5), rpy=(0.1, 0.2, 0.3))
    for way in (1e-3, 0.7):
        path = arc_path(start, center=(0.3, -0.2 + radius, 0.5), axis=(0, 0, 1), angle=way / radius)
        np.testing.assert_array_equal(path(0.0), start)
        angle = way / radius
        expected = start[:3, 3] + radius * np.array([np.sin(angle), 2 * np.sin(0.5 * angle) ** 2, 0.0])
        relative = 1e-12 + np.spacing(radius) / radius  # of the centre
        assert np.abs(path(path.length)[:3, 3] - expected).max() < 4 * relative * way + 1e-15


@pytest.mark.parametrize("angle", [1e-13, -1e-15, 1e-18, -1e-30, 1e-100, 1e-200, 1e-310, 5e-324, 0.0])
@pytest.mark.parametrize("rotation", ["keep", "follow"])
def test_arcs_of_no_length_are_refused_when_they_are_made(angle, rotation):
    start = cs.pose((0.3, -0.2, 0.5))
    for radius in (0.0, 1e-9, 0.1, 1.0):
        center = start[:3, 3] + [radius, 0.0, 0.0]
        with pytest.raises(InputError, match="one must exceed 1e-12 m or rad"):
            arc_path(start, center=center, axis=(0, 0, 1), angle=angle, rotation=rotation)


@pytest.mark.parametrize("angle", [1e-11, -1e-11, 1e-9, 1e-6])
def test_arcs_of_some_length_are_paths(angle):
    start = cs.pose((0.3, -0.2, 0.5))
    path = arc_path(start, center=(0.3, 0.8, 0.5), axis=(0, 0, 1), angle=angle)
    assert path.length == pytest.approx(abs(angle))
    assert path(path.length)[0, 3] - start[0, 3] == pytest.approx(angle, rel=1e-4, abs=1e-16)


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
        (lambda T, G: arc_path(T, center=(1, 0, 0), axis=(0, 0, 1), angle=0), "has a length of 0:"),
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
