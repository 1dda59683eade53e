"""Feasible intervals against the solver of the arm with the parameter locked at many values.

Away from the interval ends as many intervals contain a value as locked solutions keep their limits there,
and the configuration that made the goal lies in an interval. Arms of the catalogue and random ones; random
goals and goals with all joints at multiples of 45 degrees; values on a grid and on both sides of every end.
"""

import numpy as np
import pytest

import cspace as cs
from ik.geometries import random_screws

TURN = 2 * np.pi
SPHERICAL = ["iiwa14", "iiwa7", "iiwa14_r820", "lwr4", "rm75", "xmatepro7", "openarm_left"]
OTHERS = ["panda", "xarm7", "j2s7s300", "pr2_right", "r1pro_left", "tiago_arm", "gen3"]
FOLLOWED = ["baxter_dh", "baxter_left", "g1_left_arm", "rizon4", "sawyer", "tiago_pro_left", "yumi_left"]
AS_FILES_SAY = ["fetch", "fr3", "panda_urdf", "lbr_iiwa14_r820_tool0"]
EIGHT = ["fetch_torso", "p8", "pr2_right_torso"]
"""Arms with eight joints: the first is locked too."""
# One letter per pair of neighbouring axes, see ik/geometries.py.
WORDS = {
    "general": "XXXXXX",
    "spherical_wrist": "XXXXMS",
    "spherical_shoulder": "MSXXXX",
    "offset_wrist": "XXXXMM",
    "axes_meet_in_pairs": "MMMMMM",
    "parallel_pairs": "XPXPXM",
}


def random_arm(word, rng):
    """An arm with random limits; a quarter of its joints has none."""
    axes, points, T_zero = random_screws(word, rng, square=bool(rng.integers(2)))
    middle, half = rng.uniform(-0.5, 0.5, 7), rng.uniform(1.0, 3.0, 7)
    half[rng.random(7) < 0.25] = np.inf
    return cs.Robot.from_screws(
        axes, points, T_zero, joint_types="R" * 7, lower=middle - half, upper=middle + half
    )


def round_angles(robot, q):
    """Multiples of 45 degrees within the limits."""
    lower, upper = robot.limits.lower + 0.05, robot.limits.upper - 0.05
    return np.clip(np.round(q / (np.pi / 4)) * (np.pi / 4), lower, upper)


def excess(robot, q, joint):
    """By how much rows (k, dof) leave the limits of the joints but one: negative inside."""
    lower, upper = robot.limits.lower, robot.limits.upper
    stopped = upper - lower < TURN
    stopped[joint] = False
    lower, upper = lower[stopped], upper[stopped]
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    off = np.abs(np.angle(np.exp(1j * (q[:, stopped] - middle)))) - half
    return off.max(axis=1, initial=-1.0)


def values_to_check(robot, found, joint, n):
    """A grid, and values on both sides of every end; none nearer to an end than 2e-4."""
    lower, upper = robot.limits.lower[joint], robot.limits.upper[joint]
    if not upper - lower < TURN:
        lower, upper = -np.pi, np.pi
    grid = lower + (upper - lower) * (np.arange(n) + 0.5) / n
    ends = np.array([end for interval in found for end in (interval.lower, interval.upper)])
    values = np.concatenate([grid, *(ends + off for off in (-1e-2, -3e-4, 3e-4, 1e-2))])
    values = values[(values > lower) & (values < upper)]
    gap = np.abs(np.angle(np.exp(1j * (values[:, None] - ends)))).min(axis=1, initial=np.pi)
    return values[gap > 2e-4]


def miscounted(robot, T, found, joint, n, locked):
    """Values at which the number of intervals differs from that of locked solutions within limits."""
    values = values_to_check(robot, found, joint, n)
    b = robot.ik(T, locked={joint: values, **locked})
    wrong = []
    for value, rows, count in zip(values, b.q, b.count, strict=True):
        off = excess(robot, rows[:count], joint)
        if np.any(np.abs(off) < 1e-6):
            continue
        within = int((off < 0).sum())
        if within != len(found.feasible(value)):
            wrong.append((float(value), within, len(found.feasible(value))))
    return wrong


def begin_twice(robot, T, found, joint, locked):
    """Values behind a common beginning of intervals at which there are more of these than solutions."""
    wrong = []
    for k, one in enumerate(found.intervals):
        for other in found.intervals[:k]:
            if abs(np.angle(np.exp(1j * (one.lower - other.lower)))) > 1e-9:
                continue
            value = one.lower + min(one.upper - one.lower, other.upper - other.lower) / 2
            off = excess(robot, robot.ik(T, locked={joint: value, **locked}).q, joint)
            if len(found.feasible(value)) > (off < 1e-6).sum():
                wrong.append((one, other))
    return wrong


def touches_limit(robot, T, q, joint, locked):
    """Whether q is within its limits only there: the next values on both sides keep them no more."""
    values = q[joint] + np.array([-1e-4, 1e-4])
    own = (values > robot.limits.lower[joint]) & (values < robot.limits.upper[joint])
    b = robot.ik(T, locked={joint: values[own], **locked})
    return all(
        (excess(robot, rows[:count], joint) > 0).all() for rows, count in zip(b.q, b.count, strict=True)
    )


def check_goal(robot, q, n):
    """Whether the intervals are complete; they must then agree with the locked solver."""
    T = robot.fk(q)
    locked = {0: q[0]} if robot.dof > 7 else {}
    found = robot.redundancy(T, locked=locked)
    joint = robot.joint_names.index(found.parameter)
    if not found.complete:
        return False
    assert begin_twice(robot, T, found, joint, locked) == []
    assert miscounted(robot, T, found, joint, n, locked) == []
    gaps = [abs(np.angle(np.exp(1j * (end - q[joint])))) for i in found for end in (i.lower, i.upper)]
    assert (
        found.feasible(q[joint])
        or min(gaps, default=np.inf) < 1e-6
        or touches_limit(robot, T, q, joint, locked)
    )
    assert all(interval.upper - interval.lower <= TURN + 1e-12 for interval in found)
    return True


CERTIFIED = {"p8": 80}
"""Of a hundred goals, where it is not nearly all. Four branches of p8 often meet in one fold, at the end of
the reach of its shoulder: their intervals are right and not certified.
"""


def check_arm(name, goals, n, rng, least):
    """Random goals of one arm; of every hundred, `least` must be complete."""
    least = CERTIFIED.get(name, least)
    robot = cs.load_robot(name)
    complete = [check_goal(robot, q, n) for q in robot.random_configuration(goals, rng=rng)]
    assert sum(complete) >= least / 100 * goals


@pytest.mark.slow
def test_every_redundant_arm_of_the_catalogue_is_here():
    arms = (cs.load_robot(name) for name in cs.robots.names())
    redundant = {robot.name for robot in arms if len(robot.joint_types) > 6 and robot.solver.is_redundant}
    listed = {cs.load_robot(name).name for name in (*FOLLOWED, *SPHERICAL, *OTHERS, *AS_FILES_SAY, *EIGHT)}
    assert listed == redundant


@pytest.mark.parametrize("name", [*FOLLOWED, *SPHERICAL, *OTHERS, *AS_FILES_SAY, *EIGHT])
def test_intervals_agree_with_the_locked_solver(name):
    check_arm(name, 2 if name == "gen3" else 5, 25, 2, 100)


@pytest.mark.parametrize("kind", WORDS)
def test_intervals_of_random_arms_agree_with_the_locked_solver(kind):
    rng = np.random.default_rng(7)
    for _ in range(4):
        robot = random_arm(WORDS[kind], rng)
        assert check_goal(robot, robot.random_configuration(rng=rng), 25)


@pytest.mark.parametrize("name", ["sawyer", "g1_left_arm", "yumi_left", "baxter_left"])
def test_intervals_at_round_angles_agree_where_they_are_complete(name):
    robot = cs.load_robot(name)
    complete = [check_goal(robot, round_angles(robot, q), 25) for q in robot.random_configuration(6, rng=1)]
    assert any(complete)


@pytest.mark.parametrize(
    ("name", "rng", "skip"),
    [("sawyer", 2, 97), ("baxter_left", 2, 0), ("yumi_left", 2, 28), ("rizon4", 2, 46)],
)
def test_arcs_that_all_but_cross_are_told_apart(name, rng, skip):
    robot = cs.load_robot(name)
    for q in robot.random_configuration(skip + 1, rng=rng)[-1:]:
        assert check_goal(robot, q, 60)


def test_small_loops_are_found():
    rizon4, sawyer = cs.load_robot("rizon4"), cs.load_robot("sawyer")
    # A loop 4 mrad wide in the parameter, and one of 16 mrad.
    q = np.array([-2.358051982539104, 0.48926494544944976, 1.1331512413172224, -0.2514944658733247])
    assert check_goal(rizon4, np.append(q, [1.2556128300544835, 0.722042276807983, 0.5321135285151115]), 400)
    assert check_goal(sawyer, sawyer.random_configuration(rng=700110), 400)


@pytest.mark.parametrize("name", ["xarm7", "sawyer", "rizon4"])
def test_a_whole_turn_more_changes_no_branch(name):
    robot = cs.load_robot(name)
    for q in robot.random_configuration(10, rng=5):
        found = robot.redundancy(robot.fk(q))
        value = q[robot.joint_names.index(found.parameter)]
        for turns in range(-3, 4):
            assert found.feasible(value + TURN * turns) == found.feasible(value) != ()


def at_limits(robot, rng):
    """A configuration, often at multiples of 45 degrees, with one joint exactly at one of its limits."""
    lower, upper = robot.limits.lower, robot.limits.upper
    q = robot.random_configuration(rng=rng)
    if rng.integers(2):
        q = round_angles(robot, q)
    finite = np.flatnonzero(np.isfinite(lower) & (upper - lower < TURN))
    joint = rng.choice(finite)
    q[joint] = rng.choice([lower[joint], upper[joint]])
    return q


@pytest.mark.slow
@pytest.mark.parametrize("name", [*SPHERICAL, *OTHERS, *AS_FILES_SAY, *EIGHT])
def test_joints_exactly_at_a_limit(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(11)
    for _ in range(12):
        check_goal(robot, at_limits(robot, rng), 25)


@pytest.mark.parametrize("name", ["lwr4", "iiwa14", "xmatepro7", "r1pro_left"])
def test_an_elbow_that_rests_on_its_limit_is_within(name):
    """Where no self-motion moves the elbow, rounding decides on which side of its limit it computes."""
    robot, rng = cs.load_robot(name), np.random.default_rng(12)
    for bound in (robot.limits.lower, robot.limits.upper):
        for q in robot.random_configuration(5, rng=rng):
            q[3] = bound[3]
            found = robot.redundancy(robot.fk(q))
            assert found.feasible(q[robot.joint_names.index(found.parameter)])


@pytest.mark.slow
@pytest.mark.parametrize("name", [*FOLLOWED, *SPHERICAL, *OTHERS, *AS_FILES_SAY, *EIGHT])
def test_many_goals_agree_with_the_locked_solver(name):
    check_arm(name, 20 if name == "gen3" else 100, 100, 31, 98)


@pytest.mark.slow
@pytest.mark.parametrize("kind", WORDS)
def test_many_random_arms_agree_with_the_locked_solver(kind):
    rng = np.random.default_rng(8)
    complete = []
    for _ in range(200):
        robot = random_arm(WORDS[kind], rng)
        complete.append(check_goal(robot, robot.random_configuration(rng=rng), 100))
    assert sum(complete) >= 196
