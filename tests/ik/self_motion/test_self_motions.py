"""Families of configurations: how far each joint runs, and that the tip stays all the way."""

import copy
import pickle

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError
from cspace.model import from_screws
from cspace.robot import Robot
from ik.arms import load
from ik.geometries import angle_gap

X, Y, Z = np.eye(3)
O = np.zeros(3)
CASES = {
    "puma560, wrist straight": ("puma560", [0.1, 0.2, 0.3, 0.4, 0.0, 0.5]),
    "ur5e, axis 6 parallel to axis 2": ("ur5e", [0.3, -1.0, 0.9, 0.5, 0.0, 0.2]),
    "ur5_dh, the other way round": ("ur5_dh", [0.3, -1.0, 0.9, 0.5, np.pi, 0.2]),
    "elbow, stretched over a straight wrist": ("elbow", [0.3, -0.4, 0.0, 0.5, np.pi / 2, 0.2]),
    "planar 3R, tip inside": ("planar_3r", [0.3, 0.5, 0.7]),
    "planar 3R, folded": ("planar_3r", [0.3, 2.0, 1.7]),
    "planar 3R with limits": ("three_link", [0.3, 2.0, 1.7]),
    "planar 2R at its base": ("planar_2r", [0.3, np.pi]),
    "rpr under its axis": ("rpr", [0.3, 0.25, np.pi / 6]),
}


def self_motions_of(name, q):
    robot = load(name)
    T = robot.fk(np.array(q))
    found = robot.ik(T) if robot.dof == 6 else robot.ik(position=T[:3, 3])
    assert found.status == "singular"
    return robot, T, found.self_motions


def limited(robot, lower, upper):
    """The same arm with other limits."""
    c = robot.chain
    n = len(c.joint_types)
    ends = {side: np.broadcast_to(v, n).astype(float) for side, v in (("lower", lower), ("upper", upper))}
    return Robot(from_screws(c.axes, c.points, c.T_zero, joint_types=c.joint_types, name="limited", **ends))


def tip_stays(robot, T, q, position):
    at = robot.fk(q)
    return np.abs((at - T)[..., :3, 3:] if position else at - T).max(initial=0) < 1e-9


@pytest.mark.parametrize("case", CASES)
def test_the_tip_stays_along_every_family(case):
    robot, T, self_motions = self_motions_of(*CASES[case])
    assert self_motions
    seen = 0
    for self_motion in self_motions:
        bounds, path = self_motion.bounds, self_motion.sample(97)
        assert bounds.shape == (robot.dof, 2)
        if np.isnan(bounds).any():
            assert not robot.ik(T).within() or robot.ik(T).violations()[self_motion.row]
            continue
        seen += 1
        assert path.shape == (97, robot.dof)
        assert tip_stays(robot, T, path, robot.dof < 6)
        whole = np.isclose(bounds[:, 1] - bounds[:, 0], 2 * np.pi)
        inside = (path >= bounds[:, 0] - 1e-9) & (path <= bounds[:, 1] + 1e-9)
        assert inside[:, ~whole].all()
        # Neighbours are neighbours: no jump from one curve to another.
        steps = np.abs(np.angle(np.exp(1j * np.diff(path, axis=0)))).max(axis=1)
        assert steps.max() < 6 * np.median(steps) + 1e-9
        for joint, name in enumerate(robot.joint_names):
            assert (bounds[joint, 0] < bounds[joint, 1]) or name not in self_motion.joints
    assert seen


@pytest.mark.parametrize("case", CASES)
def test_bounds_are_what_a_fine_sample_comes_near_to(case):
    _, _, self_motions = self_motions_of(*CASES[case])
    for self_motion in self_motions:
        bounds = self_motion.bounds
        if np.isnan(bounds).any():
            continue
        path = self_motion.sample(4001)
        low, high = path.min(axis=0), path.max(axis=0)
        assert np.abs(np.stack([low, high], axis=1) - bounds).max() < 5e-3


def puma_self_motion(lower, upper, q4, q6):
    robot = limited(load("puma560"), lower, upper)
    q = np.array([0.1, 0.2, 0.3, q4, 0.0, q6])
    found = robot.ik(robot.fk(q), near=q, limits=False)
    assert angle_gap(found.q[0], q).max() < 1e-9
    return found.self_motions[0]


@pytest.mark.parametrize("total", [0.9, -2.0, 0.0])
def test_a_straight_wrist_rolls_all_the_way_round_without_limits(total):
    bounds = puma_self_motion(-np.inf, np.inf, 0.4, total - 0.4).bounds
    assert np.allclose(bounds[[3, 5]], [[-np.pi, np.pi]] * 2)
    assert np.array_equal(bounds[[0, 1, 2, 4], 0], bounds[[0, 1, 2, 4], 1])
    assert np.abs(bounds[:3, 0] - [0.1, 0.2, 0.3]).max() < 1e-12


@pytest.mark.parametrize("reach", [2.0, 3.0, 2 * np.pi, 11.0])
@pytest.mark.parametrize("total", [0.9, -1.5, 0.0])
def test_limits_of_a_straight_wrist_cut_both_joints_by_each_other(reach, total):
    """q4 + q6 is constant, so q4 lies within its own limits and those of total − q6."""
    self_motion = puma_self_motion(-reach, reach, 0.3, total - 0.3)
    low, high = max(-reach, total - reach), min(reach, total + reach)
    assert np.abs(self_motion.bounds[3] - [low, high]).max() < 1e-9
    assert np.abs(self_motion.bounds[5] - [total - high, total - low]).max() < 1e-9
    path = self_motion.sample(20)
    assert np.abs(path[:, 3] + path[:, 5] - total).max() < 1e-9
    assert np.abs(np.sort(path[[0, -1], 3]) - [low, high]).max() < 1e-9
    assert (np.abs(path) <= reach).all()


def test_joints_limited_on_one_side_go_on_for_ever_on_the_other():
    lower = np.full(6, -np.inf)
    lower[3] = -1.0
    self_motion = puma_self_motion(lower, np.inf, 0.3, 0.6)
    assert np.allclose(self_motion.bounds[3], [-1.0, np.inf])
    assert np.allclose(self_motion.bounds[5], [-np.inf, 1.9])
    with pytest.raises(InputError, match="unbounded: joint_4"):
        self_motion.sample(5)


def test_outside_the_limits_there_is_no_family():
    upper = np.full(6, np.inf)
    upper[0] = 0.0
    self_motion = puma_self_motion(-1.0, upper, 0.3, 0.6)
    assert np.isnan(self_motion.bounds).all()
    assert self_motion.sample(5).shape == (0, 6)


def four_bar_angles(l1, l2, l3, r):
    """Least and largest angle of crank l1 against the line to a point at distance r that l2 and l3 reach."""
    far, near = l2 + l3, abs(l2 - l3)
    limits = []
    for d in (near, far):
        c = (l1**2 + r**2 - d**2) / (2 * l1 * r)
        limits.append(np.arccos(np.clip(c, -1, 1)))
    return limits


POINTS = {
    "a swing": (1.9, 0.7, 0),
    "a swing beside the base": (0.4, -0.2, 0),
    "a crank": (-0.8, 0.6, 0),
    "nearly stretched": (2.4999, 0, 0),
    "where two curves cross, stretched": (1.5, 0, 0),
    "where two curves cross, folded": (0, 0.5, 0),
    "where two curves nearly cross": (1.500001, 0, 0),
    "where they nearly cross, the other way": (1.499999, 0, 0),
}


@pytest.mark.parametrize("case", POINTS)
def test_a_planar_arm_on_a_point_is_a_four_bar_linkage(case):
    """Links of 1, 1 and 0.5 m and the line to the goal: the first link swings as far as the other two reach,
    or goes round, by the law of cosines.
    """
    robot, p = load("planar_3r"), POINTS[case]
    found = robot.ik(position=p)
    r, towards = np.hypot(p[0], p[1]), np.arctan2(p[1], p[0])
    inner, outer = four_bar_angles(1.0, 1.0, 0.5, r)
    assert found.self_motions
    for self_motion in found.self_motions:
        low, high = self_motion.bounds[0]
        if inner > 1e-9:  # it cannot pass the goal's direction: the swing stays on one side
            side = np.sign(np.angle(np.exp(1j * (self_motion.q[0] - towards))))
            expected = np.sort(side * np.array([inner, outer]))
        else:
            expected = np.array([-outer, outer])
        middle = 0.5 * (low + high)
        turned = towards + 2 * np.pi * np.round((middle - towards - expected.mean()) / (2 * np.pi))
        if outer < np.pi - 1e-9 or inner > 1e-9:
            assert np.abs(np.array([low, high]) - turned - expected).max() < 1e-9
        else:
            assert np.allclose([low, high], [-np.pi, np.pi])


CROSSED = {
    "a wrist straightens while the waist turns": ("viperx300s", [1, -1, 1, 2, 0, 2]),
    "the same behind the other shoulder": ("widowx250s", [1, -1, 1, 2, 0, 2]),
    "a closed family next to a stretched arm": ("ur3", [0, 1, 0, -1.0075, 0, 1]),
}


@pytest.mark.parametrize("case", CROSSED)
def test_families_that_cross_or_are_small_are_listed(case):
    name, quarters = CROSSED[case]
    robot, q = load(name), np.pi / 2 * np.array(quarters)
    found = robot.ik(robot.fk(q))
    assert found.complete
    assert min(angle_gap(self_motion.nearest(q)[None], q).max() for self_motion in found.self_motions) < 1e-6


def test_more_freedom_than_one_is_not_certified():
    """Three axes in line: a curve does not say all."""
    robot = load("puma_style")
    found = robot.ik(robot.fk(np.pi / 2 * np.array([-1, -1, 0, 1, 0, 2])))
    assert found.status == "singular"
    assert not found.complete


def members_of_a_linkage(links, point, rng, n=150):
    """Configurations of a planar arm on a point: the first joint given, the others by the law of cosines, and
    the second given, which makes one link of the first two.
    """
    l1, l2, l3 = links

    def two_links(a, b, towards):
        c = (towards @ towards - a * a - b * b) / (2 * a * b)
        if abs(c) > 1:
            return
        for bend in (np.arccos(c), -np.arccos(c)):
            yield (
                np.arctan2(towards[1], towards[0]) - np.arctan2(b * np.sin(bend), a + b * np.cos(bend)),
                bend,
            )

    for given in rng.uniform(-np.pi, np.pi, n):
        elbow = l1 * np.array([np.cos(given), np.sin(given)])
        for second, bend in two_links(l2, l3, point - elbow):
            yield given, second - given, bend
        joined = l1 + l2 * np.exp(1j * given)
        for turn, bend in two_links(abs(joined), l3, point):
            first = turn - np.angle(joined)
            yield first, given, turn + bend - first - given


LINKAGES = {  # links, radius, and how many curves there are at it
    "four equal sides": ([1, 1, 1], 1.0, 3),
    "a kite with two sides folded": ([1, 1, 0.5], 0.5, 2),
    "a kite, the other way": ([0.5, 1, 1], 0.5, 2),
    "a parallelogram": ([1, 2, 1], 2.0, 2),
    "one that crosses itself, stretched": ([0.5, 1, 1], 1.5, 1),
    "one that crosses itself, folded": ([1, 0.7, 0.4], 0.7, 1),
    "a triangle that turns about the base": ([1, 1, 1], 0.0, 2),
}


@pytest.mark.slow
@pytest.mark.parametrize("towards", [0.0, 0.8, np.pi / 2])
@pytest.mark.parametrize("off", [0.0, 1e-6, -1e-6])
@pytest.mark.parametrize("case", LINKAGES)
def test_every_member_of_a_linkage_is_on_a_curve_that_is_listed(case, off, towards):
    """Where curves cross, or nearly do, none of them may be missing (Grashof 1883)."""
    links, r, curves = LINKAGES[case]
    point = (r + off) * np.array([np.cos(towards), np.sin(towards)])
    robot = Robot.from_dh([[0, a, 0, 0] for a in links], convention="standard")
    found = robot.ik(position=[*point, 0])
    assert off or len(found.self_motions) == len(found) == curves
    members = np.array(list(members_of_a_linkage(links, point, np.random.default_rng(3))))
    assert np.abs(robot.fk(members)[:, :2, 3] - point).max() < 1e-6
    listed = np.concatenate([self_motion.sample(600) for self_motion in found.self_motions])
    gaps = np.abs(np.angle(np.exp(1j * (members[:, None] - listed)))).max(axis=2).min(axis=1)
    assert gaps.max() < 0.05


def test_the_extremes_of_a_linkage_are_where_its_joints_turn_back():
    """UR, axis 6 parallel: four parallel axes hold a point; at an extreme one joint stands still."""
    robot, _, self_motions = self_motions_of(*CASES["ur5e, axis 6 parallel to axis 2"])
    for self_motion in self_motions:
        path = self_motion.sample(2000)
        for joint in (1, 2):
            for end, pick in ((0, np.argmin), (1, np.argmax)):
                at = path[pick(path[:, joint])]
                J = robot.jacobian(at)
                direction = np.linalg.svd(J)[2][-1]
                assert abs(direction[joint]) < 2e-2
                assert abs(self_motion.bounds[joint, end] - at[joint]) < 1e-4


def test_two_equal_links_at_the_base_turn_freely_and_within_limits():
    free = load("planar_2r").ik(position=(0, 0)).self_motions[0]
    assert np.allclose(free.bounds, [[-np.pi, np.pi], [np.pi, np.pi]])
    arm = limited(load("planar_2r"), [-0.5, -4], [1.25, 4])
    bound = arm.ik(position=(0, 0)).self_motions[0]
    assert np.allclose(bound.bounds, [[-0.5, 1.25], [np.pi, np.pi]])
    assert np.allclose(bound.sample(8)[:, 0], np.linspace(-0.5, 1.25, 8)) or np.allclose(
        bound.sample(8)[::-1, 0], np.linspace(-0.5, 1.25, 8)
    )


def test_two_slides_side_by_side_share_the_way():
    T_zero = np.eye(4)
    for lower, upper, expected in (
        (-np.inf, np.inf, [[-np.inf, np.inf]] * 2),
        ([-1, -2], [1, 2], [[-1, 1], [-0.7, 1.3]]),
        ([-1, -2], [1, 0.5], [[-0.2, 1], [-0.7, 0.5]]),
    ):
        robot = limited(Robot(from_screws([X, X], [O, O], T_zero, joint_types="PP")), lower, upper)
        self_motion = robot.ik(position=(0.3, 0, 0)).self_motions[0]
        assert np.allclose(self_motion.bounds, expected, atol=1e-9)


def test_samples_of_a_loop_start_at_its_representative_and_do_not_repeat_it():
    _, _, self_motions = self_motions_of(*CASES["planar 3R, tip inside"])
    for self_motion in self_motions:
        path = self_motion.sample(12)
        assert angle_gap(path[:1], self_motion.q).max() < 1e-9
        assert angle_gap(path[1:], self_motion.q).min() > 1e-2
        assert (np.abs(path) <= np.pi).all()


def test_families_can_be_copied_and_sent():
    _, _, self_motions = self_motions_of(*CASES["planar 3R, tip inside"])
    self_motion = self_motions[0]
    for twin in (copy.deepcopy(self_motion), pickle.loads(pickle.dumps(self_motion))):
        assert np.array_equal(twin.bounds, self_motion.bounds)


def test_what_is_no_number_of_samples_is_refused():
    self_motion = load("planar_2r").ik(position=(0, 0)).self_motions[0]
    for n, error in ((0, InputError), (-3, InputError), (2.5, InputTypeError), (True, InputTypeError)):
        with pytest.raises(error, match="n is"):
            self_motion.sample(n)


def test_more_configurations_than_make_sense_are_refused():
    robot = load("puma560")
    self_motion = robot.ik(robot.fk(CASES["puma560, wrist straight"][1])).self_motions[0]
    with pytest.raises(InputError, match="1 to 100000"):
        self_motion.sample(10**9)


def test_a_copy_of_a_family_can_be_sampled():
    robot = load("puma560")
    self_motion = robot.ik(robot.fk([0.1, 0.2, 0.3, 0.4, 0, 0.5])).self_motions[0]
    assert np.isfinite(self_motion.bounds).any()
    assert np.allclose(copy.deepcopy(self_motion).sample(3), self_motion.sample(3))
