"""Unreachable, singular, nearest: each verdict against an independent look at the arm."""

import numpy as np
import pytest
from scipy.optimize import least_squares as scipy_least_squares

from cspace.model import from_screws
from cspace.robot import Robot
from cspace.spatial import exp_so3
from ik.arms import load
from ik.geometries import CLASSES, angle_gap, random_arm, random_direction, random_pose, random_q
from oracles.ik_many_starts import all_solutions, levenberg_marquardt


def moved(T, by):
    out = T.copy()
    out[:3, 3] += by
    return out


# --- out of reach --------------------------------------------------------------------------------------


def far_goals(robot, rng, n):
    steps = np.vstack([robot.chain.points, robot.chain.T_zero[:3, 3]])
    reach = np.linalg.norm(np.diff(steps, axis=0), axis=1).sum()
    ways = [2 * reach * random_direction(rng) for _ in range(n)]
    return [moved(T, way) for T, way in zip(robot.fk(random_q(rng, n, robot.dof)), ways, strict=True)]


@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900", "yam", "romeo_left_leg"])
def test_an_unreachable_goal_is_false_and_says_by_how_much(name):
    robot = load(name)
    for T in far_goals(robot, np.random.default_rng(1), 3):
        found = robot.ik(T)
        assert not found
        assert found.status == "unreachable"
        assert found.q.shape == (0, robot.dof)
        assert found.residual.shape == (0,)
        assert found.branch == found.self_motions == ()
        assert f"{found.out_of_reach:.4g} m" in found.reason
        assert not found.within()
        assert not found.nearest(np.zeros(robot.dof))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900"])
def test_the_missing_distance_against_a_numeric_search(name):
    """The nearest goal with the same orientation, looked for by scipy from many starts."""
    robot = load(name)
    rng = np.random.default_rng(2)
    for T in far_goals(robot, rng, 2):

        def miss(q, T=T):
            at = robot.fk(q)
            return np.concatenate([at[:3, 3] - T[:3, 3], 1e3 * (at[:3, :3] - T[:3, :3]).ravel()])

        best = min(
            (scipy_least_squares(miss, q0, xtol=1e-12, ftol=1e-12) for q0 in random_q(rng, 25, 6)),
            key=lambda r: r.cost,
        )
        distance = np.linalg.norm(best.fun[:3])
        assert robot.ik(T).out_of_reach == pytest.approx(distance, rel=1e-4)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900"])
def test_the_missing_distance_grows_as_the_goal_goes_away(name):
    robot = load(name)
    T = robot.fk(np.array([0.4, -0.9, 0.8, 0.3, 0.7, -0.2]))
    way = np.array([0.6, 0.5, 0.4])
    missing = [robot.ik(moved(T, step * way)).out_of_reach for step in (3.0, 4.0, 6.0, 10.0, 100.0)]
    assert (np.diff(missing) > 0).all()
    # Far away the arm is a point: every metre of the goal's way counts.
    assert missing[-1] - missing[-2] == pytest.approx(90 * np.linalg.norm(way), rel=1e-2)


def test_a_goal_a_hair_out_of_reach_is_missed_by_that_hair():
    """A stretched arm of three joints and a wrist, its reach known by its links."""
    _, Y, Z = np.eye(3)
    wrist = [0, 0, 1.0]
    points = [[0, 0, 0], [0, 0, 0], [0, 0, 0.6], wrist, wrist, wrist]
    T_zero = np.eye(4)
    T_zero[:3, 3] = wrist
    robot = Robot(from_screws([Z, Y, Y, Z, Y, Z], points, T_zero, name="tower"))
    for hair in (1e-3, 1e-5, 1e-7):
        found = robot.ik(moved(random_turn(T_zero, 3), [0, 0, hair]))
        assert not found
        assert found.out_of_reach == pytest.approx(hair, rel=1e-3)
        assert robot.ik(moved(random_turn(T_zero, 3), [0, 0, -hair]))


def random_turn(T, seed):
    out = T.copy()
    out[:3, :3] = random_pose(np.random.default_rng(seed))[:3, :3]
    return out


@pytest.mark.parametrize("angle", [1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("name", ["al5d", "cobra600"])
def test_an_orientation_a_hair_off_is_named_as_such(name, angle):
    robot = load(name)
    T = robot.fk(np.full(robot.dof, 0.4))
    T[:3, :3] = exp_so3([angle, angle, 0.0]) @ T[:3, :3]
    found = robot.ik(T)
    assert not found
    assert "cannot reach this orientation" in found.reason


def test_an_arm_of_four_joints_says_that_the_orientation_is_the_trouble():
    robot = load("al5d")
    T = robot.fk(np.full(robot.dof, 0.4))
    found = robot.ik(random_turn(T, 4))
    assert not found
    assert "orientation" in found.reason
    assert "°" in found.reason


# --- least squares -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["ur5e", "kr6_r900", "so101"])
def test_least_squares_against_a_numeric_search(name):
    robot = load(name)
    rng = np.random.default_rng(5)
    length = robot_length(robot)
    for T in far_goals(robot, rng, 2):
        found = robot.ik(T, least_squares=True)
        assert found
        assert found.status == "least_squares"
        assert not found.complete
        assert found.residual[0] > 0.01
        starts = random_q(rng, 40, robot.dof)
        c = robot.chain
        scaled = T.copy()
        scaled[:3, 3] /= length
        T_zero = c.T_zero.copy()
        T_zero[:3, 3] /= length
        goals = np.repeat(scaled[None], 40, axis=0)
        q, _ = levenberg_marquardt(c.axes, c.points / length, T_zero, goals, starts, 150)
        assert cost(robot, found.q[0], T, length) <= min(cost(robot, row, T, length) for row in q) + 1e-6


def robot_length(robot):
    """The longest step from axis to axis or to the tip, as the documentation of least_squares weighs."""
    c = robot.chain
    ends = np.vstack([c.points[1:], c.T_zero[None, :3, 3]]) - c.points
    steps = [np.linalg.norm(np.cross(step, h)) for step, h in zip(ends, c.axes, strict=True)]
    back = [np.linalg.norm(np.cross(step, h)) for step, h in zip(ends[:-1], c.axes[1:], strict=True)]
    return max(steps + back)


def cost(robot, q, T, length):
    at = robot.fk(q)
    angle = np.arccos(np.clip((np.trace(T[:3, :3] @ at[:3, :3].T) - 1) / 2, -1, 1))
    return np.hypot(np.linalg.norm(at[:3, 3] - T[:3, 3]) / length, angle)


def test_least_squares_changes_nothing_where_the_goal_is_reached():
    robot = load("ur5e")
    T = robot.fk(np.full(6, 0.7))
    assert np.array_equal(robot.ik(T, least_squares=True).q, robot.ik(T).q)
    assert robot.ik(T, least_squares=True).status == "exact"


# --- singular ------------------------------------------------------------------------------------------


def follow(robot, T, q, direction, stride):
    """Along a family: a stride in its direction, then back onto the goal by the oracle's own descent."""
    c = robot.chain
    start = (q + stride * direction)[None]
    back, left = levenberg_marquardt(c.axes, c.points, c.T_zero, T[None], start, 200)
    return back[0], left[0]


def expect_self_motions_are_real(robot, T, found):
    assert found.status == "singular"
    assert found.self_motions
    assert "can move while the tip does not" in found.reason
    for self_motion in found.self_motions:
        assert np.linalg.norm(self_motion.direction) == pytest.approx(1)
        assert np.array_equal(self_motion.q, found.q[self_motion.row])
        assert np.linalg.norm(robot.jacobian(self_motion.q) @ self_motion.direction) < 1e-6
        assert self_motion.joints == tuple(
            n for n, d in zip(robot.joint_names, self_motion.direction, strict=True) if abs(d) > 1e-6
        )
        for step in (1e-3, 1e-4):
            gap = np.abs(robot.fk(self_motion.q + step * self_motion.direction) - T).max()
            assert gap < 10 * step**2 + 1e-9
        moved_to, left = follow(robot, T, self_motion.q, self_motion.direction, 0.1)
        assert left < 1e-7
        assert angle_gap(moved_to, self_motion.q) > 0.03


FREE = {
    "puma560, wrist straight": ("puma560", [0.3, -0.4, 0.7, 0.5, 0.0, 0.2]),
    "kr6_r900, wrist straight": ("kr6_r900", [0.3, -1.2, 1.1, 0.5, 0.0, 0.2]),
    "ur5e, axis 6 parallel to axis 2": ("ur5e", [0.3, -1.0, 0.9, 0.5, 0.0, 0.2]),
    "ur5_dh, the same the other way round": ("ur5_dh", [0.3, -1.0, 0.9, 0.5, np.pi, 0.2]),
    "z1, wrist turned in line": ("z1", [0.3, 1.0, -0.9, 0.5, np.pi / 2, 0.2]),
    "elbow, stretched over a straight wrist": ("elbow", [0.3, -0.4, 0.0, 0.5, np.pi / 2, 0.2]),
    "romeo_left_leg, hip in line": ("romeo_left_leg", [0.3, -np.pi / 2, 0.2, 0.6, -0.4, 0.1]),
}


@pytest.mark.parametrize("case", FREE)
def test_a_pose_with_a_self_motion_is_singular_and_describes_it(case):
    name, q = FREE[case]
    robot = load(name)
    if np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] > 1e-9:
        pytest.fail(f"{case}: not singular, the test is wrong")
    expect_self_motions_are_real(robot, robot.fk(q), robot.ik(robot.fk(q)))


def test_a_wrist_above_axis_one_leaves_the_first_joint_free():
    """Wrist centre on axis 1 of an arm without offsets: the base joint turns under it."""
    X, Y, Z = np.eye(3)
    points = [[0, 0, 0], [0, 0, 0.3], [0.5, 0, 0.3], [0.9, 0, 0.3], [0.9, 0, 0.3], [0.9, 0, 0.3]]
    T_zero = np.eye(4)
    T_zero[:3, 3] = [1.0, 0, 0.3]
    robot = Robot(from_screws([Z, -Y, -Y, X, -Y, X], points, T_zero, name="overhead"))
    # Law of cosines: the wrist 0.3 above the shoulder.
    fold = np.pi - np.arccos((0.5**2 + 0.4**2 - 0.3**2) / (2 * 0.5 * 0.4))
    lift = np.pi / 2 - np.arctan2(0.4 * np.sin(fold), 0.5 + 0.4 * np.cos(fold))
    q = np.array([0.4, lift, fold, 0.3, 0.6, -0.5])
    T = robot.fk(q)
    found = robot.ik(T)
    expect_self_motions_are_real(robot, T, found)
    assert any(
        "joint_1" in self_motion.joints[0] or self_motion.direction[0] != 0
        for self_motion in found.self_motions
    )
    assert np.abs(found.q[:, 0]).max() < 1e-9  # free joints stand at zero


@pytest.mark.parametrize("name", ["puma560", "kr6_r900", "ur5e", "irb1600"])
def test_a_stretched_arm_is_a_fold_and_no_family(name):
    """Elbow stretched, wrist bent: two solutions become one, and nothing can move."""
    robot = load(name)
    rng = np.random.default_rng(6)
    q = random_q(rng, robot.dof)
    q[2] = stretched_elbow(robot)
    assert np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] < 1e-7
    found = robot.ik(robot.fk(q))
    assert found.status == "exact"
    assert found.self_motions == ()
    assert angle_gap(found.q, q).min() < 1e-6
    assert found.residual.max() < 1e-9


def stretched_elbow(robot):
    """The angle of joint 3 at which axes 2, 3 and the wrist (axis 4 of parallel arms) lie in one plane."""
    c = robot.chain
    h, p2, p3 = c.axes[1], c.points[1], c.points[2]
    # Where axis 4 meets axis 5, or for parallel axes any point of axis 4.
    wrist = c.points[3]
    if np.linalg.norm(np.cross(c.axes[3], h)) > 1e-6:
        n = np.cross(c.axes[3], c.axes[4])
        gap = c.points[4] - c.points[3]
        wrist = c.points[3] + (np.cross(gap, c.axes[4]) @ n) / (n @ n) * c.axes[3]
    upper, fore = ((v - (v @ h) * h) for v in (p3 - p2, wrist - p3))
    angle = np.arctan2(np.cross(fore, upper) @ h, fore @ upper)
    return angle * np.sign(c.axes[2] @ h)


@pytest.mark.parametrize("case", FREE)
def test_near_sets_free_joints_and_returns_the_configuration_itself(case):
    """Of a family that holds q, the nearest to q that the solver names is q."""
    name, q = FREE[case]
    robot = load(name)
    one = robot.ik(robot.fk(q), near=q, limits=False)
    assert len(one) == 1
    assert angle_gap(one.q[0], np.array(q)) < 1e-6


@pytest.mark.parametrize("name", ["puma560", "kr6_r900", "irb120", "rv4fr"])
def test_without_near_the_free_wrist_joint_stands_at_zero(name):
    robot = load(name)
    q = np.array([0.3, -0.7, 0.9, 0.5, 0.0, 0.2])
    assert np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] < 1e-9
    found = robot.ik(robot.fk(q))
    free = [self_motion.q for self_motion in found.self_motions]
    assert free
    assert min(abs(row[3]) for row in free) < 1e-9


@pytest.mark.parametrize("name", CLASSES)
def test_near_is_the_nearest_of_all(name):
    rng = np.random.default_rng([7, *map(ord, name)])
    robot = random_arm(CLASSES[name], rng)
    for T in robot.fk(random_q(rng, 6, 6)):
        seed = random_q(rng, 6)
        one = robot.ik(T, near=seed)
        every = robot.ik(T)
        assert len(one) == 1
        gaps = (every.q - seed + np.pi) % (2 * np.pi) - np.pi
        assert np.linalg.norm(one.q[0] - seed) == pytest.approx(np.linalg.norm(gaps, axis=1).min(), abs=1e-6)


# --- near singular -------------------------------------------------------------------------------------

SINGULAR_AT = {
    "wrist": ("puma560", 4, 0.0),
    "wrist of a kuka": ("kr6_r900", 4, 0.0),
    "elbow": ("puma560", 2, None),
    "elbow of a kuka": ("kr6_r900", 2, None),
    "ur wrist": ("ur5e", 4, 0.0),
    "ur elbow": ("ur5e", 2, 0.0),
    "wrist of an idealised arm": ("puma560_urdf", 4, 0.0),
}


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("case", SINGULAR_AT)
def test_solutions_near_singularities_are_recovered(case, off):
    name, joint, angle = SINGULAR_AT[case]
    robot = load(name)
    rng = np.random.default_rng([8, *map(ord, case)])
    q = random_q(rng, 200, 6)
    q[:, joint] = (stretched_elbow(robot) if angle is None else angle) + off * rng.choice([-1, 1], 200)
    missed, worst = 0, 0.0
    for row, T in zip(q, robot.fk(q), strict=True):
        found = robot.ik(T)
        missed += not found or angle_gap(found.q, row).min() > max(1e-7, 1e-12 / off**2)
        worst = max(worst, found.residual.max(initial=0))
    assert missed == 0
    assert worst <= (1e-9 if off <= 1e-4 else 1e-12)


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("name", ["puma560", "kr6_r900", "ur5e", "irb1600"])
def test_solutions_near_shoulder_singularities_are_recovered(name, off):
    """Configurations on the singular set by joint 2 alone, found by bisection, then left by `off`."""
    robot = load(name)
    rng = np.random.default_rng([9, *map(ord, name)])
    tried = missed = 0
    while tried < 40:
        q = random_q(rng, 6)
        at = shoulder_root(robot, q)
        if at is None:
            continue
        tried += 1
        at[1] += off
        found = robot.ik(robot.fk(at))
        missed += not found or angle_gap(found.q, at).min() > max(1e-7, 1e-12 / off**2)
        assert found.residual.max(initial=0) <= 1e-9
    assert missed == 0


@pytest.mark.parametrize("name", ["puma560", "kr6_r900", "irb1600"])
def test_a_fold_keeps_its_two_solutions_apart_down_to_a_millionth(name):
    """On one side of a fold as many solutions at a distance of 1e-6 rad as at 1e-4, unless rounding of the
    goal moves them farther than they are apart.
    """
    robot = load(name)
    rng = np.random.default_rng([11, *map(ord, name)])
    compared = 0
    while compared < 100:
        at = shoulder_root(robot, random_q(rng, 6))
        if at is None:
            continue
        far, near = at.copy(), at.copy()
        far[1] += 1e-4
        near[1] += 1e-6
        if np.linalg.svd(robot.jacobian(near), compute_uv=False)[-1] < 1e-9:
            continue
        assert len(robot.ik(robot.fk(far))) == len(robot.ik(robot.fk(near)))
        compared += 1


def shoulder_root(robot, q):
    """q with joint 2 moved to where det J changes sign, or None."""
    t = np.linspace(-np.pi, np.pi, 41)
    rows = np.tile(q, (len(t), 1))
    rows[:, 1] = t
    det = np.linalg.det(robot.jacobian(rows))
    change = np.flatnonzero(det[:-1] * det[1:] < 0)
    if len(change) == 0:
        return None
    low, high = t[change[0]], t[change[0] + 1]
    out = q.copy()

    def det_at(angle):
        out[1] = angle
        return np.linalg.det(robot.jacobian(out))

    sign = np.sign(det_at(low))
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.sign(det_at(middle)) == sign else (low, middle)
    out[1] = low
    return out


def test_a_fold_has_the_count_that_many_starts_find():
    """Just inside and just outside the border of the reach: all solutions, none, never a false one."""
    robot = load("puma560")
    q = random_q(np.random.default_rng(10), 6)
    q[2] = stretched_elbow(robot)
    T = robot.fk(q)
    c = robot.chain
    outward = T[:3, 3] / np.linalg.norm(T[:3, 3])
    for step in (-1e-3, 1e-3):
        goal = moved(T, step * outward)
        found = robot.ik(goal)
        expected = all_solutions(c.axes, c.points, c.T_zero, goal[None], starts=400, steps=80)[0]
        assert len(found) == len(expected)
