"""What is no goal, no seed, no arm for this: refused by name, with the value and the rule."""

import copy
import pickle
import re

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError
from cspace.ik import NoClosedFormError, geometry, redundancy
from cspace.model import Description, Joint, Link, Mimic, from_screws
from cspace.robot import Robot
from ik.arms import load
from ik.geometries import random_q


@pytest.fixture
def robot():
    return load("ur5e")


@pytest.fixture
def goal(robot):
    return robot.fk(np.array([0.3, -1.0, 1.2, 0.4, 0.9, -2.0]))


def spoilt(T, *changes):
    out = np.array(T)
    for index, value in changes:
        out[index] = value
    return out


BAD_POSES = {
    "NaN": (lambda T: spoilt(T, ((0, 3), np.nan)), "nan at index"),
    "NaN in the rotation": (lambda T: spoilt(T, ((1, 1), np.nan)), "nan at index"),
    "infinity": (lambda T: spoilt(T, ((1, 3), np.inf)), "inf at index"),
    "scaled": (lambda T: T * np.diag([1.01, 1.01, 1.01, 1]).max(axis=0), "not a rotation"),
    "sheared": (lambda T: spoilt(T, ((0, 1), T[0, 1] + 0.2)), "not a rotation"),
    "reflected": (lambda T: T @ np.diag([1.0, -1.0, 1.0, 1.0]), "reflection"),
    "last row": (lambda T: spoilt(T, ((3, 0), 0.1)), "last row"),
    "transposed": (lambda T: T.T, "last row"),
    "zeros": (lambda T: np.zeros((4, 4)), "last row"),
    "farther than numbers reach": (lambda T: spoilt(T, ((0, 3), 1e120)), r"1e\+120.*1e\+100"),
    "a rotation alone": (lambda T: T[:3, :3], r"\(3, 3\)"),
    "three rows": (lambda T: T[:3], r"\(3, 4\)"),
    "a vector": (lambda T: T.ravel(), r"\(16,\)"),
    "a number": (lambda T: 1.0, r"\(\)"),
}


@pytest.mark.parametrize("case", BAD_POSES)
def test_what_is_no_pose_is_refused_alone_and_in_a_batch(robot, goal, case):
    spoil, words = BAD_POSES[case]
    bad = spoil(goal)
    with pytest.raises(InputError, match=words):
        robot.ik(bad)
    if np.shape(bad) != (4, 4):
        return
    with pytest.raises(InputError, match=words):
        robot.ik(bad, near=np.zeros(6))
    for at in (0, 3, 6):
        goals = np.stack([goal] * 7)
        goals[at] = bad
        with pytest.raises(InputError, match=words) as caught:
            robot.ik(goals)
        assert str(at) in str(caught.value)


NO_NUMBERS = ["home", None, {"x": 1}, object(), b"\x00", [["a"] * 4] * 4, np.eye(4) * 1j, [[1, 2], [3]]]


@pytest.mark.parametrize("value", NO_NUMBERS, ids=lambda v: type(v).__name__ + repr(v)[:12])
def test_what_is_no_number_is_refused(robot, value):
    with pytest.raises((InputTypeError, InputError)):
        robot.ik(value)


def test_calls_without_a_goal_or_with_unknown_words(robot, goal):
    with pytest.raises(InputTypeError, match="goal"):
        robot.ik()
    with pytest.raises(TypeError, match="tolerance"):
        robot.ik(goal, tolerance=1e-6)
    with pytest.raises(TypeError):
        robot.ik(goal, np.zeros(6))


BAD_SEEDS = {
    "five joints": (np.zeros(5), InputError, r"\(5,\)"),
    "two configurations": (np.zeros((2, 6)), InputError, r"\(2, 6\)"),
    "NaN": (np.full(6, np.nan), InputError, "near holds nan"),
    "words": ("home", InputTypeError, "near"),
    "farther than numbers reach": (
        [0, 0, -1e308, 0, 0, 0],
        InputError,
        r"near holds -1e\+308 .*\(2,\).*1e\+100",
    ),
}


@pytest.mark.parametrize("case", BAD_SEEDS)
def test_a_seed_that_is_no_configuration(robot, goal, case):
    seed, error, words = BAD_SEEDS[case]
    with pytest.raises(error, match=words):
        robot.ik(goal, near=seed)


@pytest.mark.parametrize("shape", [(0, 6), (3, 6), (2, 3, 6), (1, 2, 6)])
def test_a_batch_of_seeds_that_does_not_fit_the_goals(robot, goal, shape):
    found = robot.ik(np.stack([goal] * 2))
    with pytest.raises(InputError, match=rf"q has shape {re.escape(str(shape))}.*\(6,\).*\(2, 6\)"):
        found.nearest(np.zeros(shape))


@pytest.mark.parametrize("value", [1e101, -1e308])
def test_seeds_farther_than_numbers_reach(robot, goal, value):
    for found in (robot.ik(goal), robot.ik(np.eye(4)), robot.ik(np.stack([goal] * 2))):
        with pytest.raises(InputError, match=r"q holds .* at index \(4,\).*1e\+100"):
            found.nearest([0, 0, 0, 0, value, 0])


def test_seeds_at_the_edge_of_the_numbers_keep_finite_answers(robot, goal):
    seed = np.full(6, 1e100)
    assert np.isfinite(robot.ik(goal, near=seed).q).all()
    assert np.isfinite(robot.ik(goal[None]).nearest(seed)).all()


@pytest.mark.parametrize("robot", ["ur5e", None, np.eye(4)], ids=["a name", "nothing", "a pose"])
def test_what_is_no_robot_is_refused_with_the_remedy(robot):
    for call in (lambda: geometry(robot), lambda: redundancy(robot, np.eye(4))):
        with pytest.raises(InputTypeError, match=rf"{type(robot).__name__}.*load_robot"):
            call()


@pytest.mark.parametrize("threads", [-1, 1025, 1.5, "2", True, np.True_])
def test_threads_that_are_no_count(robot, goal, threads):
    for goals in (goal, goal[None]):
        with pytest.raises((InputError, InputTypeError), match="threads"):
            robot.ik(goals, threads=threads)
    with pytest.raises((InputError, InputTypeError), match="threads"):
        robot.ik_numeric(goal, threads=threads)


def test_no_threads_are_as_many_as_there_are_processors(robot, goal):
    np.testing.assert_array_equal(robot.ik(goal[None], threads=0).q, robot.ik(goal[None], threads=1).q)


@pytest.mark.parametrize("name", ["ur5e", "panda", "al5d", "planar_3r", "simplified_puma"])
@pytest.mark.parametrize("seeds", [(3,), (2, 4), (5, 1)])
@pytest.mark.parametrize("parts", ["goal", "position", "direction", "position direction", "look_at", "ray"])
def test_seeds_that_do_not_fit_a_batch_are_refused(name, seeds, parts):
    robot = load(name)
    T = robot.fk(random_q(np.random.default_rng(0), 4, robot.dof))
    p, d = T[:, :3, 3], T[:, :3, 2]
    values = {"goal": T, "position": p, "direction": d, "look_at": p + 0.1 * d, "ray": (p, d)}
    with pytest.raises(InputError, match=r"expected \(\d,\) for all goals or \(4, \d\), one for each"):
        robot.ik(**{part: values[part] for part in parts.split()}, near=np.zeros((*seeds, robot.dof)))


# --- arms without a closed form ------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["jaco2", "crx10ia", "xarm6", "piper", "gen3_lite"])
def test_an_arm_without_a_closed_form_says_which_condition_failed_by_how_much(name):
    robot = load(name)
    seen = geometry(robot)
    assert not seen
    assert seen.family == "general"
    message = str(seen)
    assert robot.name in message
    assert "meet in a point" in message
    assert "parallel" in message
    assert "off by" in message
    assert "allowed" in message
    assert "general method" in message
    assert len(seen.conditions) == 8
    # The measured misses are real: the smallest distance of a point from three lines, the largest angle.
    for condition in seen.conditions:
        assert condition.holds == (condition.measured <= condition.allowed)
        assert str(condition) in message or condition.holds
    assert robot.ik(robot.fk(np.full(6, 0.4)))


def test_arms_of_more_than_sixteen_joints_are_refused():
    axes = np.eye(3)[np.arange(17) % 3]
    robot = Robot.from_screws(axes, 0.1 * np.arange(51).reshape(17, 3), np.eye(4))
    with pytest.raises(NoClosedFormError, match="17 joints") as caught:
        robot.ik(np.eye(4))
    assert str(geometry(robot)) == geometry(robot).reason == str(caught.value)


def chain_with(joint_at_three, **options):
    """A six-joint arm with a wrist, one joint changed."""
    axes = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]]
    offsets = [[0, 0, 0], [0, 0, 0.3], [0.4, 0, 0], [0.3, 0, 0], [0, 0, 0], [0, 0, 0]]
    joints = []
    for i, (axis, offset) in enumerate(zip(axes, offsets, strict=True)):
        origin = np.eye(4)
        origin[:3, 3] = offset
        more = options if i == 3 else {}
        kind = joint_at_three if i == 3 else "continuous"
        joints.append(Joint(f"j{i}", kind, f"l{i}", f"l{i + 1}", origin, np.array(axis, float), **more))
    return Description("odd", [Link(f"l{i}") for i in range(7)], joints)


def test_a_joint_that_mimics_another_is_refused():
    robot = Robot(chain_with("continuous", mimic=Mimic("j2", 1.0, 0.0)))
    assert robot.dof == 5
    with pytest.raises(NoClosedFormError, match="mimic"):
        robot.ik(np.eye(4))
    assert "mimic" in str(geometry(robot))


def test_a_fixed_joint_in_the_chain_leaves_an_arm_of_five():
    robot = Robot(chain_with("fixed"))
    q = random_q(np.random.default_rng(1), 5)
    assert np.abs(robot.ik(robot.fk(q), near=q).q[0] - q).max() < 1e-9


def test_a_floating_base_is_refused():
    robot = Robot(chain_with("continuous"), floating=True)
    with pytest.raises(NoClosedFormError, match="base is floating"):
        robot.ik(np.eye(4))
    assert "base is floating" in str(geometry(robot))


def test_a_tree_without_a_tip_names_its_leaves():
    arm = chain_with("continuous")
    branch = Joint("side", "continuous", "l2", "side_link", np.eye(4), np.array([1.0, 0, 0]))
    tree = Robot(Description("tree", [*arm.links, Link("side_link")], [*arm.joints, branch]))
    with pytest.raises(InputError, match=r"l6.*side_link|side_link.*l6"):
        tree.ik(np.eye(4))


# --- results as objects --------------------------------------------------------------------------------


def test_results_are_pickled_and_copied(robot, goal):
    for found in (
        robot.ik(goal),
        robot.ik(goal).within(),
        robot.ik(np.eye(4)),
        robot.ik(goal, near=np.zeros(6)),
    ):
        for same in (pickle.loads(pickle.dumps(found)), copy.copy(found), copy.deepcopy(found)):
            assert np.array_equal(same.q, found.q)
            assert np.array_equal(same.goal, found.goal)
            assert (same.status, same.reason, same.branch) == (found.status, found.reason, found.branch)
    batch = robot.ik(np.stack([goal, np.eye(4)]))
    same = pickle.loads(pickle.dumps(batch))
    assert same.q.tobytes() == batch.q.tobytes()
    assert same[0].branch == batch[0].branch


def test_a_result_keeps_its_robot_alive(goal):
    found = Robot(chain_with("continuous")).ik(goal)
    assert found.solver.name == "odd"
    assert found.residual.max(initial=0) < 1e-9


def test_results_cannot_be_spoilt_through_their_arrays(robot, goal):
    found = robot.ik(goal)
    before = found.q
    found.q[:] = 7
    found.goal[:] = 7
    assert np.array_equal(found.q, before)
    assert np.array_equal(found.goal, goal)
    locked = np.array(goal)
    found = robot.ik(locked)
    locked[:] = 0
    assert np.array_equal(found.goal, goal)


def test_solvers_are_built_again_for_tools_and_mounts(robot, goal):
    robot.ik(goal)
    tool = np.eye(4)
    tool[:3, 3] = [0, 0, 0.1]
    changed = robot.with_tool(tool)
    assert changed.ik(goal @ tool).residual.max() < 1e-12
    assert len(changed.ik(goal @ tool)) == len(robot.ik(goal))


def test_a_bare_chain_is_solved_like_any_robot():
    axes = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]]
    points = [[0, 0, 0], [0, 0, 0.3], [0.4, 0, 0.3], [0.7, 0, 0.3], [0.7, 0, 0.3], [0.7, 0, 0.3]]
    robot = Robot(from_screws(axes, points, np.eye(4)))
    assert robot.ik(robot.fk(np.full(6, 0.4)))
