"""The names of branches: told apart, the same next door, and true to the drawing they describe."""

import numpy as np
import pytest

from cspace.ik import geometry
from cspace.model import from_screws
from cspace.robot import Robot
from cspace.robots import load_robot
from ik.arms import PARALLEL, SPHERICAL, load
from ik.geometries import angle_gap, random_q

X, Y, Z = np.eye(3)
O = np.zeros(3)


def arm(axes, points, tip, kinds, name):
    T_zero = np.eye(4)
    T_zero[:3, 3] = tip
    return Robot(from_screws(axes, points, T_zero, joint_types=kinds, name=name))


MADE = {
    "polar": arm([Z, X], [O, O], [0.5, 0, 0], "RP", "polar"),
    "slide then link": arm([X, Z], [O, O], [0.5, 0, 0], "PR", "slide_link"),
    "cylindrical": arm([Z, Z, X], [O, O, O], [0.5, 0, 0.2], "RPP", "cylindrical"),
    "gantry with a reach": arm([Z, Z, X], [O, O, O], [0.5, 0, 0.2], "PRP", "gantry"),
    "spherical": arm([Z, Y, X], [O, [0, 0.1, 0.3], O], [0.5, 0.1, 0.3], "RRP", "spherical"),
    "spherical, no offset": arm([Z, Y, X], [O, [0, 0, 0.3], O], [0.5, 0, 0.3], "RRP", "round"),
    "scara": arm([Z, Z, -Z], [O, [0.4, 0, 0], O], [0.7, 0, 0], "RRP", "scara3"),
    "lifted two links": arm([Z, Z, Z], [O, O, [0.4, 0, 0]], [0.7, 0, 0], "PRR", "lift"),
    "offset puma": arm([Z, Y, -Y], [O, [0, 0.15, 0.4], [0.5, 0.1, 0.4]], [0.9, 0.1, 0.5], "RRR", "offset"),
}
SHORT = ["planar_2r", "two_link", "rpr", "simplified_puma"]


def named(name):
    return MADE[name] if name in MADE else load(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*SHORT, *MADE])
def test_arms_of_few_joints_have_names_that_differ_and_stay_next_door(name):
    robot = named(name)
    rng = np.random.default_rng(1)
    seen = set()
    for _ in range(40):
        q = rng.uniform(-1.4, 1.4, robot.dof)
        p = robot.fk(q)[:3, 3]
        found = robot.ik(position=p)
        assert found.status == "exact"
        assert not any(label.startswith("branch") for label in found.branch)
        assert len(set(found.branch)) == len(found)
        seen |= set(found.branch)
        next_door = robot.ik(position=robot.fk(q + 1e-7)[:3, 3])
        for row, label in zip(found.q, found.branch, strict=True):
            gaps = angle_gap(next_door.q, row)
            if gaps.min() < 1e-4:
                assert next_door.branch[int(gaps.argmin())] == label
    assert len(seen) in (2, 4)


@pytest.mark.parametrize("name", ["planar_3r", "three_link"])
def test_the_elbow_of_a_planar_arm_with_a_wrist(name):
    robot = load(name)
    for q in np.random.default_rng(2).uniform(-1.4, 1.4, (20, 3)):
        found = robot.ik(robot.fk(q))
        assert sorted(found.branch) == ["elbow down", "elbow up"]
        assert found.branch[int(angle_gap(found.q, q).argmin())] == ("elbow up" if q[1] < 0 else "elbow down")


@pytest.mark.parametrize("name", ["planar_2r", "two_link"])
def test_for_a_goal_ahead_the_upper_elbow_is_the_higher_one(name):
    robot = load(name)
    h, elbow_at_zero = robot.chain.axes[0], robot.chain.points[1]
    up = Y if name == "planar_2r" else Z
    for x, y in np.random.default_rng(3).uniform([0.5, -1], [1.5, 1], (20, 2)):
        found = robot.ik(position=x * X + y * up)
        heights = {
            label: up @ (elbow_at_zero * np.cos(q[0]) + np.cross(h, elbow_at_zero) * np.sin(q[0]))
            for label, q in zip(found.branch, found.q, strict=True)
        }
        assert heights["elbow up"] > heights["elbow down"]
    assert robot.ik(position=2 * X).branch == ("elbow straight",)


@pytest.mark.parametrize(("axis", "ahead"), [(Z, X), (Y, X), (X, Y)])
def test_an_axis_drawn_the_other_way_changes_no_name(axis, ahead):
    one, other = (arm([s * axis] * 2, [O, ahead], 2 * ahead, "RR", "twin") for s in (1, -1))
    goal = one.fk(np.array([0.4, 0.8]))[:3, 3]
    found, turned = one.ik(position=goal), other.ik(position=goal)
    for q, label in zip(found.q, found.branch, strict=True):
        assert turned.branch[int(angle_gap(turned.q, -q).argmin())] == label


def test_the_simplified_puma_faces_its_goal_or_reaches_over_its_back():
    """At zero it lies along x: its face is where q1 points; links of 1 m, so the elbow's height is sin q2."""
    robot = load("simplified_puma")
    for q in np.random.default_rng(4).uniform(-1.4, 1.4, (30, 3)):
        p = robot.fk(q)[:3, 3]
        found = robot.ik(position=p)
        assert len(set(found.branch)) == 4
        for (q1, q2, _), label in zip(found.q, found.branch, strict=True):
            ahead = np.cos(q1) * p[0] + np.sin(q1) * p[1]
            assert ("front" in label) == (ahead > 0)
            elbow, line = np.array([np.cos(q2), -np.sin(q2)]), np.array([ahead, p[2]])
            above = (elbow - (elbow @ line) / (line @ line) * line)[1] > 0
            assert ("elbow up" in label) == above


def test_the_rpr_arm_says_where_its_slide_and_its_link_lie():
    """Tip in the turned frame: y = q2 − sin(q3) / 2 along the slide."""
    robot = load("rpr")
    for q in np.random.default_rng(5).uniform(-1.4, 1.4, (30, 3)):
        found = robot.ik(position=robot.fk(q)[:3, 3])
        assert len(found) == 4
        for (_, q2, q3), label in zip(found.q, found.branch, strict=True):
            assert ("slide forward" in label) == (q2 - np.sin(q3) / 2 > 0)
            assert ("link ahead" in label) == (np.sin(q3) < 0)


def test_a_planar_rpr_arm_reaches_forward_or_back():
    robot = arm([Z, X, Z], [O, O, [0.5, 0, 0]], [0.8, 0, 0], "RPR", "planar_rpr")
    found = robot.ik(robot.fk([0.3, 0.2, 0.4]))
    assert sorted(found.branch) == ["slide back", "slide forward"]
    for (_, q2, _), label in zip(found.q, found.branch, strict=True):
        assert ("forward" in label) == (0.5 + q2 > 0)


@pytest.mark.parametrize("name", ["al5d", "so101"])
def test_arms_of_four_and_five_joints_have_shoulders_and_elbows(name):
    robot = load(name)
    rng = np.random.default_rng(6)
    words = set()
    for _ in range(20):
        q = random_q(rng, robot.dof)
        found = robot.ik(robot.fk(q))
        assert len(set(found.branch)) == len(found)
        words |= set(found.branch)
    assert all(label.startswith("shoulder ") and ", elbow " in label for label in words)
    assert len(words) >= 4


@pytest.mark.parametrize("name", [n for n in SPHERICAL + PARALLEL if n not in ("j2s6s200", "j2s6s300")])
def test_eight_branches_have_eight_names(name):
    robot = load(name)
    for q in random_q(np.random.default_rng(7), 10, robot.dof):
        found = robot.ik(robot.fk(q))
        if found.branch[0].startswith("branch"):
            pytest.skip("this geometry has numbers only")
        assert len(set(found.branch)) == len(found)


def test_front_and_back_do_not_depend_on_how_the_axes_are_drawn():
    """An elbow arm upright at zero whose joint 2 tilts it to +x, its axes drawn either way."""
    tower = [O, [0, 0, 0.3], [0, 0, 0.8], [0, 0, 1.2], [0, 0, 1.2], [0, 0, 1.2]]
    axes = np.array([Z, Y, Y, Z, Y, Z])
    for signs in np.random.default_rng(8).choice([-1.0, 1.0], (8, 6)):
        signs[1] = 1
        T_zero = np.eye(4)
        T_zero[2, 3] = 1.4
        robot = Robot(from_screws(signs[:, None] * axes, tower, T_zero, name="tower"))
        q = signs * [0.0, 0.9, 0.5, 0.3, 0.4, 0.2]  # tilted towards +x, where the wrist is
        found = robot.ik(robot.fk(q))
        assert "shoulder front" in found.branch[int(angle_gap(found.q, q).argmin())]
        backwards = signs * [np.pi, -0.9, -0.5, 0.3, 0.4, 0.2]
        found = robot.ik(robot.fk(backwards))
        assert "shoulder back" in found.branch[int(angle_gap(found.q, backwards).argmin())]


def test_what_the_first_three_axes_share_is_said_of_short_arms():
    assert "axes 2 and 3 parallel" in str(geometry(load("simplified_puma")))
    meeting = arm([Z, X, Y], [O, O, [0, 1, 0.2]], [0, 1, 1], "RRR", "meeting")
    assert "axes 1 and 2 meet" in str(geometry(meeting))
    assert "up to three joints" in str(geometry(load("rpr")))


def test_branches_of_an_arm_in_general_position_are_numbered_as_all_branches_without_words_are():
    robot = load_robot("jaco2")
    labels = robot.ik(robot.fk(np.linspace(0.4, 0.9, 6))).branch
    assert labels
    assert all(label.startswith("branch ") for label in labels), labels


@pytest.mark.parametrize("name", ["ur5e", "panda", "jaco2", "planar_3r"])
def test_a_batch_has_the_branches_and_poses_of_its_goals(name):
    robot = load_robot(name)
    T = robot.fk(robot.random_configuration(4, rng=7))
    T = np.concatenate([T, T[:2] + 9.0 * np.eye(4, k=3)]).reshape(2, 3, 4, 4)
    batch = robot.ik(T)
    assert batch.branch.shape == batch.q.shape[:-1]
    for index in np.ndindex(2, 3):
        assert tuple(batch.branch[index][: batch.count[index]]) == batch[index].branch
        assert (batch.branch[index][batch.count[index] :] == "").all()
    assert np.array_equal(np.isnan(robot.fk(batch.q)[..., 0, 0]), np.isnan(batch.q[..., 0]))
