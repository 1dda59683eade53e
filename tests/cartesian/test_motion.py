"""Motions of the tip: on the path, within every limit, the fastest of the branches, free in a scene."""

import numpy as np
import pytest

import cspace as cs
from cspace.cartesian import move_cartesian
from cspace.errors import InputError
from cspace.trajectory import line_path

START = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
LIMITS = {"velocity": 2.0, "acceleration": 8.0}


def limits_of(robot):
    n = robot.dof
    return cs.Limits(robot.limits.lower, robot.limits.upper, np.full(n, 2.0), np.full(n, 8.0))


def beside(robot):
    return robot.fk(START) @ cs.pose((0.1, 0, 0))


def tip_speeds(robot, motion, count=2000):
    t = np.linspace(0, motion.duration, count)
    twist = np.einsum("nij,nj->ni", robot.jacobian(motion(t)), motion(t, 1))
    return np.linalg.norm(twist[:, :3], axis=1), np.linalg.norm(twist[:, 3:], axis=1)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda", "iiwa14"])
def test_a_line_is_followed_within_all_limits(name, seed):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(seed)
    arrived = 0
    for q in robot.random_configuration(3, rng=rng, reach=0.5):
        T = robot.fk(q)
        goal = T.copy()
        goal[:3, 3] += rng.uniform(-0.12, 0.12, 3)
        goal[:3, :3] = cs.spatial.exp_so3(rng.uniform(-0.2, 0.2, 3)) @ T[:3, :3]
        motion = robot.move_linear(goal, start=q, speed=0.2, turn_rate=0.5, **LIMITS)
        if not motion:
            assert motion.chosen == -1
            assert motion.reason
            continue
        arrived += 1
        assert motion.check(limits_of(robot))
        np.testing.assert_allclose(motion(0.0), q, atol=1e-8)
        np.testing.assert_allclose(robot.fk(motion(motion.duration)), goal, atol=1e-8)
        np.testing.assert_allclose(motion([0.0, motion.duration], 1), 0.0, atol=1e-12)
        speeds, rates = tip_speeds(robot, motion)
        assert speeds.max() <= 0.2 * (1 + 1e-6)
        assert rates.max() <= 0.5 * (1 + 1e-6)
        s = motion.parameter(np.linspace(0, motion.duration, 50))
        np.testing.assert_allclose(
            robot.fk(motion(np.linspace(0, motion.duration, 50)))[:, :3, 3],
            motion.cartesian(s)[:, :3, 3],
            atol=2e-5,
        )
    assert arrived


def test_the_fastest_branch_is_taken():
    robot = cs.load_robot("ur5e")
    T = robot.fk(START)
    path = line_path(T, T @ cs.pose((0.15, 0.1, -0.1), rpy=(0.2, 0, 0.3)))
    every = move_cartesian(robot, path, **LIMITS)
    assert len(every.branches) == 8
    assert every.chosen == np.argmin(every.durations)
    for branch, coarse in zip(every.branches, every.durations, strict=True):
        alone = move_cartesian(robot, path, branch.q_start, **LIMITS)
        assert alone.duration >= every.duration * (1 - 1e-3)
        assert alone.duration == pytest.approx(coarse, rel=0.05)


def test_arcs_and_polylines_move_through_their_points():
    robot = cs.load_robot("ur5e")
    T = robot.fk(START)
    via, goal = T @ cs.pose((0.05, 0.03, 0)), T @ cs.pose((0.1, 0, 0), rpy=(0, 0, 0.3))
    arc = robot.move_arc(goal, start=START, via=via[:3, 3], **LIMITS)
    assert arc
    t = np.linspace(0, arc.duration, 5000)
    points = robot.fk(arc(t))[:, :3, 3]
    assert np.linalg.norm(points - via[:3, 3], axis=1).min() < 2e-4
    np.testing.assert_allclose(robot.fk(arc(arc.duration)), goal, atol=1e-8)

    stops = robot.move_through([via, goal], start=START, **LIMITS)
    rounded = robot.move_through([via, goal], start=START, deviation=0.01, turn_deviation=0.1, **LIMITS)
    assert stops.path.stops.size == 1
    assert not rounded.path.stops.size
    assert rounded.duration < stops.duration
    for motion in (arc, stops, rounded):
        assert motion.check(limits_of(robot))


def test_a_valve_turns_further_with_a_hand_that_turns_on_its_handle():
    robot = cs.load_robot("ur5e")
    T = robot.fk(START)
    circle = {"center": T[:3, 3] + [0.0, 0.1, 0.0], "axis": T[:3, 2], "angle": 4 * np.pi}
    loose = robot.move_arc(start=START, free_axis="z", **circle, **LIMITS)
    assert loose
    assert loose.check(limits_of(robot))
    stiff = robot.move_arc(start=START, **circle, **LIMITS)
    assert not stiff
    assert "limits" in stiff.reason
    assert 0 < stiff.s_end < stiff.cartesian.length


def test_a_scene_rules_branches_out_and_says_what_is_touched():
    robot = cs.load_robot("panda")
    q = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8])
    T = robot.fk(q)
    goal = T.copy()
    goal[:3, 3] += [0.1, 0.4, -0.1]
    free = robot.move_linear(goal, start=q, scene=cs.Scene())
    assert free
    box = cs.Box((0.1, 0.1, 0.1), T[:3, 3] + [0.05, 0.2, -0.05], name="crate")
    blocked = robot.move_linear(goal, start=q, scene=cs.Scene([box]))
    assert not blocked
    assert "crate" in blocked.reason
    t = np.linspace(0, free.duration, 3000)
    assert not cs.collision.collides(robot, free(t), cs.Scene()).any()


@pytest.mark.parametrize("name", ["panda", "ur5e"])
def test_as_far_as_possible_stops_before_an_obstacle(name):
    """Lines towards a box end beside it: proved free up to there, and blocked a little farther."""
    robot = cs.load_robot(name)
    rng, stopped = np.random.default_rng(2), 0
    for q in robot.random_configuration(12, rng=rng, reach=0.5):
        goal = robot.fk(q).copy()
        goal[:3, 3] += rng.uniform(-0.3, 0.3, 3)
        options = {"start": q, "velocity": 2.0, "acceleration": 8.0}
        free = robot.move_linear(goal, scene=cs.Scene(), **options)
        if not free:
            continue
        scene = cs.Scene([cs.Box((0.1, 0.1, 0.1), goal[:3, 3], name="crate")])
        part = robot.move_linear(goal, scene=scene, as_far_as_possible=True, **options)
        if cs.collision.collides(robot, q, scene):
            assert not part
            assert "crate" in part.reason
            continue
        assert part
        assert "crate" in part.stopped_by
        assert f"{part.s_end:.6g}" in part.stopped_by
        assert 0.0 < part.s_end == part.path.length < part.cartesian.length == free.cartesian.length
        assert not cs.collision.collides(robot, part(np.linspace(0, part.duration, 500)), scene).any()
        s = np.linspace(part.s_end, min(part.s_end + 5e-3, free.path.length), 30)
        assert cs.collision.collides(robot, free.path(s), scene).any() or len(free.branches) > 1
        assert part(part.duration, 1).max() == 0.0
        stopped += 1
    assert stopped >= 3


def test_lines_through_a_singularity_slow_down_or_say_so():
    """The shoulder singularity: the tip passes beside the first axis at some distance."""
    robot = cs.load_robot("ur5e")
    durations = []
    for aside in (0.2, 0.16, 0.14):
        first = cs.pose((-0.3, aside, 0.5), rpy=(np.pi, 0, 0))
        last = cs.pose((0.3, aside, 0.5), rpy=(np.pi, 0, 0))
        motion = move_cartesian(robot, line_path(first, last), **LIMITS)
        if motion:
            assert motion.check(limits_of(robot))
            durations.append(motion.duration)
        else:
            assert "singular" in motion.reason or "limits" in motion.reason or "unreachable" in motion.reason
    assert durations
    assert sorted(durations) == durations  # the nearer, the slower


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda r: r.move_linear(np.eye(3), start=START), "goal pose"),
        (lambda r: r.move_linear(np.eye(4), start=START[:3]), "start has shape"),
        (lambda r: r.move_linear(beside(r), start=START), "pass acceleration="),
        (lambda r: r.move_linear(beside(r), start=START, speed=0.0, acceleration=1.0), "speed"),
        (lambda r: r.move_through(np.eye(4), start=START, acceleration=8.0), "poses has shape"),
        (lambda r: r.move_arc(start=START, acceleration=8.0), "an arc needs"),
        (
            lambda r: move_cartesian(r, line_path(np.eye(4), cs.pose((0.1, 0, 0))), START, acceleration=8.0),
            "from the begin of the path",
        ),
    ],
)  # fmt: skip
def test_what_makes_no_motion_is_named(call, message):
    with pytest.raises(InputError, match=message):
        call(cs.load_robot("ur5e"))


def test_motions_to_where_the_arm_is_have_no_length():
    robot = cs.load_robot("ur5e")
    T = robot.fk(START)
    about = {"center": T[:3, 3] + 0.1, "axis": [0, 0, 1], "angle": 0.0}
    for motion in (
        robot.move_linear(T, start=START),
        robot.move_through([T, T], start=START),
        robot.move_arc(start=START, **about),
        robot.move_to(START, start=START, acceleration=1.0, jerk=1.0),
        cs.move(robot, START, START),
    ):
        assert motion
        assert motion.duration == 0.0
        assert np.array_equal(motion(0.0), START)
        assert not motion(0.0, 1).any()
        assert motion.check(robot)
        assert len(motion.sample(100.0).times) == 1
    outside = robot.limits.upper + 0.1
    assert "beyond its limits" in robot.move_linear(robot.fk(outside), start=outside).reason


@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_as_far_as_possible_is_the_part_that_can_be_followed(name):
    robot = cs.load_robot(name)
    rng, parts = np.random.default_rng(4), 0
    for q in robot.random_configuration(6, rng=rng, reach=0.6):
        goal = robot.fk(q).copy()
        goal[:3, 3] += rng.uniform(-1.2, 1.2, 3)
        whole = robot.move_linear(goal, start=q, acceleration=8.0)
        part = robot.move_linear(goal, start=q, acceleration=8.0, as_far_as_possible=True)
        if whole:
            assert not part.stopped_by
            assert part.duration == whole.duration
            continue
        if not part:
            continue
        parts += 1
        assert part.stopped_by == whole.reason
        assert 0.0 < part.s_end <= whole.s_end
        assert part.s_end == part.path.length
        s = np.linspace(0.0, part.s_end, 50)
        np.testing.assert_allclose(robot.fk(part.path(s)), part.cartesian(s), atol=3e-5)
        assert part.check(cs.Limits(robot.limits.lower, robot.limits.upper))
    assert parts >= 3


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_polylines_that_are_timed_without_jerk_limits_are_timed_with_them(name):
    """Blends of every size, up to those that meet: a slow motion keeps any limit of jerk."""
    robot = cs.load_robot(name)
    rng, timed = np.random.default_rng(9), 0
    for _ in range(12):
        q = robot.random_configuration(rng=rng, reach=0.4)
        T = robot.fk(q)
        size = 10.0 ** rng.uniform(-2.0, -0.8)
        poses = [T @ cs.pose(rng.normal(size=3) * size) for _ in range(int(rng.integers(2, 5)))]
        options = {
            "start": q,
            "deviation": size * 10.0 ** rng.uniform(-2, 0),
            "velocity": 2,
            "acceleration": 5,
        }
        plain = robot.move_through(poses, **options)
        if not plain:
            continue
        timed += 1
        for jerk in (10.0, 100.0, 10_000.0):
            motion = robot.move_through(poses, jerk=jerk, **options)
            assert motion, motion.reason
            assert motion.duration >= plain.duration * (1.0 - 1e-3)  # what their grids differ by
            assert motion.extremes(3).highest.max() <= jerk * (1.0 + 1e-9)
    assert timed >= 4


@pytest.mark.parametrize("turns", [3, 100, 1000])
def test_an_arc_of_many_turns_ends_at_the_same_place_as_one_turn(turns):
    """Between the stations of a long path joints move too far; its end is not theirs."""
    panda = cs.load_robot("panda")
    start = np.array([0.0, -0.3, 0.0, -1.8, 0.0, 1.5, 0.5])
    T = panda.fk(start)

    def turn(angle):
        about = {"center": T[:3, 3], "axis": T[:3, 2], "angle": angle}
        return panda.move_arc(start=start, rotation="follow", velocity=1.0, acceleration=5.0, **about)

    one, many = turn(2 * np.pi), turn(turns * 2 * np.pi)
    assert not one
    assert not many
    assert many.s_end == pytest.approx(one.s_end, abs=1e-3)
    assert many.reason.partition(":")[2] == one.reason.partition(":")[2]


@pytest.mark.slow
@pytest.mark.parametrize("elbow", [0.003, 0.01, 0.03, 0.06, 0.1])
@pytest.mark.parametrize("name", ["ur3e", "ur5e", "ur16e"])
def test_lines_from_and_to_an_elbow_that_is_nearly_straight_are_followed(name, elbow):
    """The joints turn by up to some thousand rad/m there, smoothly: the tip slows down."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(int(1000 * elbow))
    for sign in (1.0, -1.0):
        q = np.append(np.append(rng.uniform(-1.0, 1.0, 2), sign * elbow), rng.uniform(0.4, 1.0, 3))
        T = robot.fk(q)
        goal = T.copy()
        goal[:3, 3] *= rng.uniform(0.75, 0.9)
        motion = robot.move_linear(goal, start=q, **LIMITS)
        assert motion, motion.reason
        assert motion.check(limits_of(robot))
        reached = robot.fk(motion(np.linspace(0.0, motion.duration, 400)))
        way = goal[:3, 3] - T[:3, 3]
        off = np.linalg.norm(np.cross(reached[:, :3, 3] - T[:3, 3], way), axis=1) / np.linalg.norm(way)
        assert off.max() < 2e-5
        back = robot.move_linear(T, start=motion(motion.duration), **LIMITS)
        assert back, back.reason
        np.testing.assert_allclose(back.duration, motion.duration, rtol=1e-3)


def test_a_margin_that_is_not_kept_is_named():
    robot = cs.load_robot("ur10e")
    q = np.array([0.2, -1.3, 1.4, -0.9, -1.2, 0.3])
    T = robot.fk(q)
    goal = T.copy()
    goal[1, 3] += 0.35
    scene = cs.Scene([cs.Sphere(0.08, T[:3, 3] + [0.0, 0.45, 0.0], name="ball")])
    apart = robot.move_linear(goal, start=q, acceleration=5.0, scene=scene, margin=0.05)
    assert not apart
    assert "than the margin of 50 mm" in apart.reason
    touching = robot.move_linear(goal, start=q, acceleration=5.0, scene=scene)
    assert not touching
    assert "touches" in touching.reason
