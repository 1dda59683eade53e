"""Tracking: every branch stays on the path, none changes unseen, and each ends where its reason says."""

from inspect import signature

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.ik.goals.partial import plain_goal
from ik.tracking.paths import TURN, matched, random_path, straight

ARMS = ["ur5e", "puma560", "jaco2", "stanford", "crx10ia"]
SEEDS = [0, 2, 0, 7, 1]  # of paths on which some branches end
FREE = {"limits": False, "max_step": np.inf}


def pose_errors(robot, q, poses):
    """The larger of the position error [m] and the angle [rad] between fk(q) and each pose."""
    return plain_goal(poses).residual(robot.fk(q))


def gap(a, b):
    """The largest difference of the rows that both have."""
    m = min(len(a), len(b))
    return np.abs(a[:m] - b[:m]).max(initial=0.0)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "seed"), list(zip(ARMS, SEEDS, strict=True)))
def test_branches_are_those_of_all_solutions_of_a_fine_path_matched(name, seed):
    robot, rng, ended = cs.load_robot(name), np.random.default_rng(seed), 0
    for _ in range(3):
        fine = random_path(robot, rng, 2401, size=0.9)
        coarse = robot.track(fine[::80], **FREE)
        dense = robot.track(fine, **FREE)
        assert len(coarse) == len(dense) == len(robot.ik(fine[0]))
        for branch, same in zip(coarse, dense, strict=True):
            oracle = matched(robot, fine, branch.q[0])
            lost = len(oracle) - 1
            if lost + 1 < same.end:  # a joint races past a singular pose: a finer path shows that it does
                between = straight(fine[lost], fine[lost + 1], 6001)
                np.testing.assert_allclose(
                    matched(robot, between, same.q[lost])[-1], same.q[lost + 1], atol=1e-6
                )
            else:
                assert branch.end == pytest.approx(lost / 80, abs=0.05)
                assert bool(branch) == (lost == 2400)
            assert gap(branch.q, oracle[::80]) < 1e-6
            assert gap(branch.q, same.q[::80]) < 1e-8
            assert branch.end == pytest.approx(same.end / 80, abs=1e-5)
            assert branch.cause == same.cause
            assert pose_errors(robot, branch.q, fine[::80][: len(branch.q)]).max() < 1e-11
            ended += branch.cause != "end"
    assert ended


@pytest.mark.parametrize("name", ARMS)
def test_the_reversed_path_gives_the_reversed_branch(name):
    robot = cs.load_robot(name)
    path = random_path(robot, np.random.default_rng(5), 60, size=0.3)
    through = [branch for branch in robot.track(path, **FREE) if branch]
    assert through
    for branch in through:
        back = robot.track(path[::-1], branch.q[-1], **FREE)
        np.testing.assert_allclose(back.q[::-1], branch.q, atol=1e-8)


@pytest.mark.parametrize("name", ["ur5e", "jaco2"])
def test_no_joint_moves_further_than_max_step(name):
    robot, rng, ended = cs.load_robot(name), np.random.default_rng(2), 0
    for _ in range(6):
        path = random_path(robot, rng, 40)
        for branch, freely in zip(
            robot.track(path, limits=False, max_step=0.05), robot.track(path, **FREE), strict=True
        ):
            steps = np.abs(np.diff(freely.q, axis=0)).max(axis=1)
            too_long = np.flatnonzero(steps > 0.05)
            assert np.abs(np.diff(branch.q, axis=0)).max(initial=0.0) <= 0.05
            assert gap(branch.q, freely.q) < 1e-8
            if len(too_long):
                assert branch.cause == "jump"
                assert len(branch.q) == too_long[0] + 1
                joint = robot.joint_names.index(branch.joint)
                assert np.abs(freely.q[too_long[0] + 1] - branch.q[-1])[joint] > 0.05
                ended += 1
    assert ended


def test_a_path_of_one_pose_is_followed_by_every_solution():
    robot = cs.load_robot("ur5e")
    T = robot.fk([0.3, -1.2, 1.4, -0.8, 0.7, 0.1])
    track = robot.track(T[None])
    assert len(track.branches) == len(robot.ik(T))
    assert "follow the one pose" in track.reason
    assert {branch.reason for branch in track.branches} == {"follows the one pose"}


def test_a_limit_is_met_where_the_joint_arrives():
    robot = cs.load_robot("ur5e")
    q0 = np.array([0.3, -1.2, 1.5, -0.8, 1.1, 0.4])
    path = straight(robot.fk(q0), robot.fk(q0 + np.array([0.4, 0.2, -0.3, 0.1, 0.2, -0.1])), 21)
    freely = robot.track(path, q0, limits=False)
    assert freely
    lower, upper = robot.limits.lower.copy(), robot.limits.upper.copy()
    bound = 0.6 * freely.q[12, 0] + 0.4 * freely.q[13, 0]
    upper[0] = bound
    limits = cs.model.Limits(lower, upper)
    stopped = robot.track(path, q0, limits=limits)
    assert not stopped
    assert stopped.cause == ("limit",)
    assert stopped[0].joint == robot.joint_names[0]
    assert len(stopped.q) == 13
    assert 12 < stopped[0].end < 13
    assert stopped[0].last[0] == pytest.approx(bound, abs=1e-9)
    pose = cs.spatial.interpolate_decoupled(path[12], path[13], stopped[0].end - 12)
    assert pose_errors(robot, stopped[0].last, pose) < 1e-10
    # Beyond it the joint goes on the way it went: the limit is met once.
    assert freely.q[13, 0] > bound > freely.q[12, 0]
    assert "shoulder_pan_joint would leave its limits" in stopped.reason


def test_a_start_beyond_its_limits_ends_at_once():
    robot = cs.load_robot("puma560")
    q0 = np.array([0.2, -0.5, 0.4, 0.3, 0.6, 0.1])
    upper = robot.limits.upper.copy()
    upper[1] = -0.6
    track = robot.track(robot.fk(q0)[None], q0, limits=cs.model.Limits(robot.limits.lower, upper))
    assert track.cause == ("limit",)
    assert track[0].joint == robot.joint_names[1]
    assert len(track.q) == 0
    assert track.reason.startswith("the branch ends before pose 0")


def test_angles_are_continuous_across_a_half_turn():
    robot = cs.load_robot("ur5e")
    angle = np.linspace(2.9, 3.6, 36)
    path = robot.fk(np.array([0.0, -1.2, 1.5, -0.8, 1.1, 0.4]) + np.outer(angle, [1, 0, 0, 0, 0, 0]))
    assert np.nanmax(robot.ik(path).q[..., 0]) - np.nanmin(robot.ik(path).q[..., 0]) > 6
    for branch in robot.track(path):
        assert branch
        assert np.abs(np.diff(branch.q, axis=0)).max() < 0.03
    one = robot.track(path, np.array([2.9, -1.2, 1.5, -0.8, 1.1, 0.4]))
    np.testing.assert_allclose(one.q[:, 0], angle, atol=1e-9)


def test_a_branch_takes_the_turn_that_gets_it_farthest():
    robot = cs.load_robot("ur5e")
    limits = cs.model.Limits(np.full(6, -3.5), np.full(6, 3.5))
    angle = np.linspace(2.9, 3.7, 41)
    path = robot.fk(np.array([0.0, -1.2, 1.5, -0.8, 1.1, 0.4]) + np.outer(angle, [1, 0, 0, 0, 0, 0]))
    from_here = robot.track(path, [2.9, -1.2, 1.5, -0.8, 1.1, 0.4], limits=limits)
    assert from_here.cause == ("limit",)
    assert from_here[0].last[0] == pytest.approx(3.5, abs=1e-9)
    best = max(robot.track(path, limits=limits), key=lambda b: np.isclose(b.q[0, 1], -1.2, atol=1e-6))
    assert best
    assert best.q[0, 0] == pytest.approx(2.9 - TURN)
    assert best.q[-1, 0] == pytest.approx(3.7 - TURN)


def through_the_wrist(n, tool=False):
    """A PUMA whose wrist passes through its singular pose: joint 5 goes from −0.4 to 0.4."""
    robot = cs.load_robot("puma560")
    if tool:
        T = np.eye(4)
        T[:3, 3] = 0.1, 0.0, 0.2
        robot = robot.with_tool(T)
    q = np.array([0.2, -0.5, 0.4, 0.3, 0.0, 0.1]) + np.outer(
        np.linspace(-1, 1, n), [0.2, 0.1, -0.2, 0.1, 0.4, 0.1]
    )
    return robot, q


@pytest.mark.parametrize("tool", [False, True])
@pytest.mark.parametrize("n", [400, 401, 1000])
def test_recorded_poses_through_a_singular_wrist_give_the_recorded_joints(n, tool):
    robot, q = through_the_wrist(n, tool)  # an odd number has a pose that is singular itself
    track = robot.track(robot.fk(q), q[0])
    assert track, track.reason
    np.testing.assert_allclose(track.q, q, atol=1e-6)


def test_a_turn_about_a_singular_wrist_axis_goes_straight_on():
    robot = cs.load_robot("puma560")
    q0, q1 = (np.array([0.2, -0.5, 0.4, 0.3, bend, 0.1]) for bend in (-0.5, 0.6))
    wrist = robot.chain.points[4]
    tool = np.eye(4)
    flange = np.linalg.inv(robot.chain.T_zero) @ np.append(wrist, 1.0)
    tool[:3, 3] = flange[:3]
    at_wrist = robot.with_tool(tool)  # its tip stays where the wrist axes meet
    for n in (2, 12, 100):
        track = at_wrist.track(straight(at_wrist.fk(q0), at_wrist.fk(q1), n), q0)
        assert track, track.reason
        np.testing.assert_allclose(track.q[-1], q1, atol=1e-9)
        np.testing.assert_allclose(track.q[:, 4], np.linspace(-0.5, 0.6, n), atol=1e-9)


def test_a_path_that_misses_the_singular_wrist_turns_it_over():
    robot, q = through_the_wrist(2)
    path = straight(robot.fk(q[0]), robot.fk(q[1]), 40)
    freely = robot.track(path, q[0], max_step=np.inf, limits=False)
    assert freely
    assert np.sign(freely.q[-1, 4]) == np.sign(q[0, 4])
    assert pose_errors(robot, freely.q, path).max() < 1e-10
    turned = np.abs(np.diff(freely.q, axis=0)).max()
    stopped = robot.track(path, q[0], max_step=0.5 * turned, limits=False)
    assert stopped.cause == ("jump",)
    assert stopped[0].joint in robot.joint_names[3::2]


def test_a_middle_out_of_reach_ends_every_branch_there():
    robot = cs.load_robot("ur5e")
    T0 = robot.fk(np.array([0.3, -0.7, 0.9, -0.8, 1.1, 0.4]))
    T0[:3, 3] = 0.35, -0.6, 0.3
    T1 = T0.copy()
    T1[:3, 3] = -0.35, -0.6, 0.3
    middle = T0.copy()
    middle[:3, 3] = 0.0, -1.1, 0.3
    path = np.concatenate([straight(T0, middle, 50), straight(middle, T1, 50)[1:]])
    assert robot.ik(T0)
    assert robot.ik(T1)
    assert not robot.ik(middle)
    track = robot.track(path, limits=False)
    assert not track
    assert "unreachable" in track.cause
    assert set(track.cause) <= {"unreachable", "singularity"}
    reachable = np.flatnonzero(robot.ik(path).count == 0)[0]
    assert reachable - 1 <= track.best.end <= reachable
    assert len(track.q) == reachable
    assert "no configuration reaches" in track.reason


@pytest.mark.parametrize("name", ["panda", "iiwa14"])
def test_joints_to_spare_move_as_little_as_they_can(name):
    robot = cs.load_robot(name)
    q0 = np.array([0.3, 0.4, -0.2, -1.3, 0.3, 1.4, 0.5])
    T1 = robot.fk(q0)
    T1[:3, 3] += 0.1, -0.15, -0.1
    coarse = robot.track(straight(robot.fk(q0), T1, 21), q0)
    fine = robot.track(straight(robot.fk(q0), T1, 2001), q0)
    assert coarse
    assert fine
    np.testing.assert_array_equal(coarse.q[0], q0)
    assert pose_errors(robot, fine.q, fine.poses).max() < 1e-10
    double = robot.track(straight(robot.fk(q0), T1, 41), q0)
    np.testing.assert_allclose(coarse.q, fine.q[::100], atol=2e-4)
    # The least motion is integrated to second order in the step.
    assert gap(double.q[::2], fine.q[::100]) < 0.3 * gap(coarse.q, fine.q[::100])
    step = np.diff(fine.q, axis=0)
    J = robot.jacobian(0.5 * (fine.q[1:] + fine.q[:-1]))
    across = step - np.einsum("nij,nj->ni", np.linalg.pinv(J) @ J, step)
    assert np.abs(across).max() < 1e-9
    back = robot.track(fine.poses[::-1], fine.q[-1])
    np.testing.assert_allclose(back.q[-1], q0, atol=1e-6)
    moved = robot.track(coarse.poses[3:], q0)  # brought to the first pose
    assert moved
    assert pose_errors(robot, moved.q[0], coarse.poses[3]) < 1e-9
    assert np.linalg.norm(moved.q[0] - q0) < 1.2 * np.linalg.norm(coarse.q[3] - q0)
    assert pose_errors(robot, robot.track(coarse.poses).q[0], coarse.poses[0]) < 1e-9


@pytest.mark.parametrize("name", ["planar_2r", "scara", "so101"])
def test_arms_of_few_joints_follow_poses_that_they_can_take(name):
    robot = cs.load_robot(name)
    n = len(robot.joint_names)
    lower, upper = np.clip([robot.limits.lower, robot.limits.upper], -2, 2)
    q = 0.5 * (lower + upper) + np.outer(np.linspace(0.1, 0.3, 60), (upper - lower) * [1, -1, 1, -1, 1][:n])
    track = robot.track(robot.fk(q), q[0])
    assert track, track.reason
    np.testing.assert_allclose(track.q, q, atol=1e-8)
    path = robot.fk(q)
    path[30:, :3, 3] += [0.0, 0.0, 0.01] if name == "planar_2r" else [0.01, 0.01, 0.0]
    if name != "scara":
        off = robot.track(path, q[0])
        assert off.cause == ("unreachable",)
        assert len(off.q) == 30


def test_the_best_is_the_cheapest_of_those_that_get_through():
    robot = cs.load_robot("ur5e")
    path = random_path(robot, np.random.default_rng(8), 80, size=0.4)
    for word, price in (
        ("length", lambda q: np.linalg.norm(np.diff(q, axis=0), axis=1).sum()),
        ("step", lambda q: np.abs(np.diff(q, axis=0)).max()),
        ("time", lambda q: (np.abs(np.diff(q, axis=0)) / robot.limits.velocity).max(axis=1).sum()),
    ):
        for cost in (word, price):
            track = robot.track(path, cost=cost)
            prices = [price(branch.q) for branch in track if branch]
            assert len(prices) > 1
            assert track.cost == pytest.approx(min(prices))
            assert price(track.q) == pytest.approx(min(prices))
    assert track.complete
    assert len(track.q) == 80


def test_rests_and_single_poses():
    robot = cs.load_robot("ur5e")
    q0 = np.array([0.3, -1.2, 1.5, -0.8, 1.1, 0.4])
    T = robot.fk(q0)
    still = robot.track(np.repeat(T[None], 5, axis=0), q0)
    np.testing.assert_allclose(still.q, np.repeat(q0[None], 5, axis=0), atol=1e-12)
    assert len(robot.track(T[None])) == 8
    far = T.copy()
    far[0, 3] = 9.0
    nowhere = robot.track(far[None])
    assert not nowhere
    assert len(nowhere) == len(nowhere.q) == 0
    assert "out of reach" in nowhere.reason
    assert "out of reach" in robot.track(far[None], q0).reason


def test_bad_questions_are_refused_by_name():
    robot = cs.load_robot("ur5e")
    T = robot.fk(np.zeros(6))
    opposite = T @ np.diag([-1.0, -1.0, 1.0, 1.0])
    with pytest.raises(InputError, match=r"expected \(n, 4, 4\)"):
        robot.track(T)
    with pytest.raises(InputError, match="poses 0 and 1 are 180° apart"):
        robot.track([T, opposite])
    with pytest.raises(InputError, match="start has shape"):
        robot.track([T], np.zeros((2, 6)))
    with pytest.raises(InputError, match="max_step"):
        robot.track([T], max_step=-1.0)
    with pytest.raises(UnknownNameError, match="length"):
        robot.track([T], cost="lenght")
    with pytest.raises(InputTypeError, match="velocity limits"):
        cs.load_robot("puma560_dh").track([T], cost="time")
    with pytest.raises(InputError, match="goal"):
        robot.track(np.full((2, 4, 4), np.nan))


@pytest.mark.parametrize(
    ("answer", "error"), [(np.nan, InputError), ("x", InputTypeError), ([1, 2], InputError)]
)
def test_costs_that_are_no_number_are_refused(answer, error):
    robot = cs.load_robot("ur5e")
    T = robot.fk(np.full(6, 0.3))
    with pytest.raises(error, match="result of cost="):
        robot.track([T, T], cost=lambda q: answer)


def test_the_method_shows_the_keywords_of_the_function():
    own = [p.replace(annotation=p.empty) for p in signature(cs.Robot.track).parameters.values()]
    wanted = [p.replace(annotation=p.empty) for p in signature(cs.ik.track).parameters.values()]
    assert own[1:] == wanted[1:]


@pytest.mark.parametrize("name", ["ur5e", "panda", "irb120", "stanford"])
def test_a_start_off_the_path_is_told_with_its_distance(name):
    robot = cs.load_robot(name)
    q = np.clip(robot.random_configuration(rng=4), -2, 2)
    poses = np.array([robot.fk(q)] * 3)
    assert "from the first pose" not in robot.track(poses, start=q).reason
    assert "from the first pose" not in robot.track(poses, start=q + 1e-6).reason
    seed = q + 0.3
    track = robot.track(poses, start=seed)
    off = np.linalg.norm(robot.fk(seed)[:3, 3] - poses[0][:3, 3])
    moved = np.abs(track.best.q[0] - seed).max()
    assert f"start is {off:.3g} m and " in track.reason
    assert f"up to {moved:.3g} " in track.reason
