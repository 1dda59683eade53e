"""Position goals, one or many: the batch agrees with the single calls and refuses what they refuse."""

import pickle

import numpy as np
import pytest

from cspace.errors import InputError
from cspace.model import from_screws
from cspace.robot import Robot
from cspace.spatial import pose
from ik.arms import load
from ik.geometries import angle_gap

ARMS = ["planar_1r", "planar_2r", "two_link", "planar_3r", "rpr", "simplified_puma"]


def mixed_points(robot, rng, n):
    """Points that the arm reaches, points far away, and points at configurations of quarter turns."""
    q = rng.uniform(-1.5, 1.5, (n, robot.dof))
    square = rng.integers(-1, 3, (n, robot.dof)) * (np.pi / 2)
    inside, special = robot.fk(q)[:, :3, 3], robot.fk(square)[:, :3, 3]
    points = np.concatenate([inside, special, rng.uniform(-4, 4, (n, 3))])
    return points[rng.permutation(len(points))]


@pytest.mark.parametrize("name", ARMS)
def test_a_batch_is_its_single_calls(name):
    robot = load(name)
    points = mixed_points(robot, np.random.default_rng(1), 20)
    batch = robot.ik(position=points)
    assert batch.q.shape == (60, 8, robot.dof)
    assert batch.goal.shape == (60, 3)
    nearest = batch.nearest(np.zeros(robot.dof))
    reasons, missing = batch.reason, batch.out_of_reach
    for i, p in enumerate(points):
        single, one = robot.ik(position=p), batch[i]
        assert batch.count[i] == len(single) == len(one)
        assert batch.status[i] == single.status == one.status
        assert np.array_equal(batch.q[i, : batch.count[i]], single.q)
        assert np.isnan(batch.q[i, batch.count[i] :]).all()
        assert (one.branch, one.reason) == (single.branch, single.reason)
        assert reasons[i] == single.reason
        assert missing[i] == single.out_of_reach
        assert (missing[i] > 0) == (not single)
        assert np.array_equal(one.goal, p)
        if single:
            assert np.array_equal(single.nearest(np.zeros(robot.dof)).q[0], nearest[i])
    assert {"exact", "unreachable"} <= set(batch.status) or name == "planar_3r"


@pytest.mark.parametrize("name", ARMS)
def test_every_row_reaches_its_goal_and_the_one_that_made_it_is_there(name):
    robot = load(name)
    q = np.random.default_rng(2).uniform(-1.5, 1.5, (50, robot.dof))
    points = robot.fk(q)[:, :3, 3]
    batch = robot.ik(position=points)
    assert (batch.count > 0).all()
    real = np.arange(8) < batch.count[:, None]
    goals = np.repeat(points, batch.count, axis=0)
    away = np.linalg.norm(robot.fk(batch.q[real])[:, :3, 3] - goals, axis=1)
    assert away.max() < 1e-12
    assert np.array_equal(np.isnan(batch.residual), ~real)
    assert np.array_equal(batch.residual[real], away)
    for i in np.flatnonzero(batch.status == "exact"):
        assert angle_gap(batch[i].q, q[i]).min() < 1e-6


def test_points_of_the_plane_are_lifted_to_it():
    robot = load("planar_2r")
    flat = np.random.default_rng(3).uniform(-1.4, 1.4, (4, 5, 2))
    batch = robot.ik(position=flat)
    assert batch.q.shape == (4, 5, 8, 2)
    space = np.concatenate([flat, np.zeros((4, 5, 1))], axis=-1)
    assert np.array_equal(batch.goal, space)
    assert np.array_equal(batch.q, robot.ik(position=space).q, equal_nan=True)
    one = batch[2, 3]
    assert np.array_equal(one.q, robot.ik(position=flat[2, 3]).q)
    r = np.linalg.norm(flat, axis=-1)
    assert np.array_equal(batch.reachable, r <= 2)
    assert np.allclose(batch.out_of_reach, np.maximum(r - 2, 0), atol=1e-12)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_the_number_of_threads_changes_no_bit(threads):
    robot = load("simplified_puma")
    points = mixed_points(robot, np.random.default_rng(4), 700)
    one, other = robot.ik(position=points, threads=1), robot.ik(position=points, threads=threads)
    assert one.q.tobytes() == other.q.tobytes()
    assert one.count.tobytes() == other.count.tobytes()


@pytest.mark.parametrize("shape", [(0,), (2, 0)])
def test_an_empty_batch_has_an_empty_answer(shape):
    robot = load("planar_2r")
    batch = robot.ik(position=np.zeros((*shape, 2)))
    assert batch.q.shape == (*shape, 8, 2)
    assert batch.reason.shape == batch.out_of_reach.shape == batch.residual.shape[:-1] == shape


def test_filters_and_copies_keep_positions():
    robot = load("two_link")
    points = robot.fk(np.random.default_rng(5).uniform(-1.5, 1.5, (30, 2)))[:, :3, 3]
    batch = robot.ik(position=points)
    kept = batch.within()
    for i in range(30):
        single = robot.ik(position=points[i]).within()
        assert np.allclose(kept.q[i, : kept.count[i]], single.q)
        assert kept[i].branch == single.branch
    same = pickle.loads(pickle.dumps(batch))
    assert np.array_equal(same.q, batch.q, equal_nan=True)
    assert same[3].reason == batch[3].reason


BAD_ROWS = {
    "NaN": (lambda p: p.__setitem__((4, 1), np.nan), r"position holds nan at index \(4, 1\)"),
    "infinity": (lambda p: p.__setitem__((4, 0), np.inf), r"position holds inf at index \(4, 0\)"),
    "too far": (lambda p: p.__setitem__(4, 1e120), r"position \(4,\) lies at .*1e\+100"),
}


@pytest.mark.parametrize("case", BAD_ROWS)
def test_a_bad_row_is_named(case):
    spoil, words = BAD_ROWS[case]
    points = np.ones((600, 3))
    spoil(points)
    for threads in (1, 3):
        with pytest.raises(InputError, match=words):
            load("planar_2r").ik(position=points, threads=threads)


@pytest.mark.parametrize("shape", [(), (1,), (4,), (5, 4), (3, 1)])
def test_what_is_no_list_of_points_is_refused(shape):
    with pytest.raises(InputError, match=r"position has shape .* expected \(\.\.\., 3\), or \(\.\.\., 2\)"):
        load("planar_2r").ik(position=np.zeros(shape))


def test_what_another_number_of_goals_or_another_arm_can_do_is_refused():
    robot, points = load("planar_2r"), np.ones((3, 2))
    with pytest.raises(InputError, match="one for each"):
        robot.ik(position=points, near=np.zeros((2, 2)))
    with pytest.raises(InputError, match="is not a planar arm"):
        load("simplified_puma").ik(position=points)


def test_complaints_about_arguments_name_the_method():
    robot = load("planar_2r")
    with pytest.raises(TypeError, match=r"^ik\(\) got an unexpected keyword argument 'nere'"):
        robot.ik(np.eye(4), nere=[0, 0])
    with pytest.raises(TypeError, match=r"^ik\(\) takes"):
        robot.ik(np.eye(4), np.zeros(2))
    with pytest.raises(TypeError, match=r"^fk\(\) got an unexpected keyword argument 'frme'"):
        robot.fk(np.zeros(2), frme="tip")
    with pytest.raises(TypeError, match=r"^jacobian\(\) got an unexpected keyword argument 'frme'"):
        robot.jacobian(np.zeros(2), frme="tip")
    assert "position" in type(robot).ik.__doc__


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_joint_of_a_short_arm_is_held(joint):
    robot, q = load("planar_3r"), np.array([0.3, 0.5, 0.7])
    p = robot.fk(q)[:3, 3]
    for point in (p, p[:2]):
        found = robot.ik(position=point, locked={f"joint_{joint + 1}": q[joint]})
        assert found.complete
        assert len(found) == 2
        assert np.abs(found.q[:, joint] - q[joint]).max() < 1e-12
        assert np.abs(robot.fk(found.q)[:, :3, 3] - p).max() < 1e-9
        assert angle_gap(found.q, q).min() < 1e-9


@pytest.mark.parametrize("joint", ["joint_2", "joint_3"])
def test_a_held_joint_that_leaves_the_others_free_is_no_error(joint):
    """Two links folded on each other, held so: they turn about the middle of the one before."""
    T_zero = np.eye(4)
    T_zero[0, 3] = 3.0
    points = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    robot = Robot(from_screws([[0, 0, 1.0]] * 3, points, T_zero, joint_types="RRR"))
    found = robot.ik(position=(0, 1, 0), locked={joint: np.pi})
    assert len(found) > 1
    assert not found.complete
    assert np.abs(robot.fk(found.q)[:, :3, 3] - [0, 1, 0]).max() < 1e-9


@pytest.mark.parametrize("bounds", [{}, {"lower": [0.0] * 3, "upper": [0.5] * 3}], ids=["free", "limited"])
def test_one_of_two_parallel_slides_is_held(bounds):
    """The other slide goes along the coordinate that is left open, and what is free keeps to a plane."""
    T_zero = pose([0, -0.1, -0.2], rpy=[-0.6, 0.2, 3.1])
    points = [[-0.2, -0.1, 0], [0, 0.1, 0], [-0.1, 0.1, -0.3]]
    axes = [[0, 0, 1], [0.6, 0.8, 0], [0, 0, -1]]
    robot = Robot(from_screws(axes, points, T_zero, joint_types="PRP", **bounds))
    for q in np.random.default_rng(0).uniform(-1, 1, (20, 3)):
        x, y, _ = robot.fk(q)[:3, 3]
        found = robot.ik(position=(x, y, None), locked={"joint_1": q[0]})
        assert found
        assert np.abs(found.q[:, 0] - q[0]).max() < 1e-12
        assert np.abs(robot.fk(found.q)[:, :2, 3] - [x, y]).max() < 1e-9
