"""One goal or many, in any form numpy reads; the batch agrees with the single calls."""

import numpy as np
import pytest

from ik.arms import FEW, load
from ik.geometries import angle_gap, random_pose, random_q

NAMES = [*FEW, "icub_left_leg"]
LANES = ["ur5e", "puma560", "kr6_r900", "romeo_left_leg", "z1"]  # those that a kernel answers


class LockedArm:
    """Something that holds a pose in the way of another library."""

    def __init__(self, T, how):
        if how == "A":
            self.A = T
        elif how == "as_matrix":
            self.as_matrix = lambda: T
        else:
            self._T = T

    def __array__(self, dtype=None, copy=None):
        if not hasattr(self, "_T"):
            raise TypeError("no array")
        return self._T


def goal_of(robot, seed=0):
    return robot.fk(random_q(np.random.default_rng(seed), robot.dof))


FORMS = {
    "nested lists": lambda T: T.tolist(),
    "rows as tuples": lambda T: tuple(map(tuple, T)),
    "Fortran order": np.asfortranarray,
    "transposed view": lambda T: np.ascontiguousarray(T.T).T,
    "strided view": lambda T: np.repeat(np.repeat(T, 2, axis=0), 3, axis=1)[::2, ::3],
    "backwards in memory": lambda T: np.ascontiguousarray(T[::-1, ::-1])[::-1, ::-1],
    "other byte order": lambda T: T.astype(">f8"),
    "read-only": lambda T: np.frombuffer(T.tobytes()).reshape(4, 4),
    "objects": lambda T: T.astype(object),
    "long double": lambda T: T.astype(np.longdouble),
    "__array__": lambda T: LockedArm(T, "__array__"),
    "as_matrix()": lambda T: LockedArm(T, "as_matrix"),
}


@pytest.mark.parametrize("name", ["ur5e", "yam", "al5d"])
@pytest.mark.parametrize("form", FORMS)
def test_the_form_of_the_goal_changes_nothing(form, name):
    robot = load(name)
    T = goal_of(robot)
    assert np.array_equal(robot.ik(FORMS[form](T)).q, robot.ik(T).q)


def test_an_object_with_a_matrix_called_a():
    class Pose:
        A = goal_of(load("ur5e"))

    assert np.array_equal(load("ur5e").ik(Pose()).q, load("ur5e").ik(Pose.A).q)


def test_single_precision_goals_are_met_to_single_precision():
    robot = load("ur5e")
    T = goal_of(robot)
    found, exact = robot.ik(T.astype(np.float32)), robot.ik(T)
    assert len(found) == len(exact)
    for q in exact.q:
        assert angle_gap(found.q, q).min() < 1e-5


def test_integers_are_numbers():
    assert load("ur5e").ik(np.eye(4, dtype=int)).status == load("ur5e").ik(np.eye(4)).status


def mixed_goals(robot, rng, n):
    """Random poses within reach, out of reach, and at singular configurations."""
    inside = robot.fk(random_q(rng, n, robot.dof))
    outside = np.array([random_pose(rng, 3.0) for _ in range(n)])
    singular = robot.fk(rng.integers(-1, 3, (n, robot.dof)) * (np.pi / 2))
    goals = np.concatenate([inside, outside, singular])
    return goals[rng.permutation(len(goals))]


@pytest.mark.parametrize("name", NAMES)
def test_a_batch_is_its_single_calls(name):
    robot = load(name)
    goals = mixed_goals(robot, np.random.default_rng(1), 30)
    batch = robot.ik(goals)
    room = batch.q.shape[1]
    assert batch.q.shape == (90, room, robot.dof)
    assert room in {8, 16}
    for i, T in enumerate(goals):
        single = robot.ik(T)
        assert batch.count[i] == min(len(single), room)
        assert batch.status[i] == single.status
        assert batch.reachable[i] == bool(single)
        assert np.isnan(batch.q[i, batch.count[i] :]).all()
        for q in batch.q[i, : batch.count[i]]:
            assert angle_gap(single.q, q).min() < 1e-7
        one = batch[i]
        assert np.array_equal(one.q, batch.q[i, : batch.count[i]])
        assert one.status == single.status
        assert len(one.branch) == len(one)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_number_of_threads_changes_no_bit(name):
    robot = load(name)
    goals = mixed_goals(robot, np.random.default_rng(2), 300 if name in LANES else 90)
    one = robot.ik(goals, threads=1)
    for threads in (2, 5):
        other = robot.ik(goals, threads=threads)
        assert one.q.tobytes() == other.q.tobytes()
        assert one.count.tobytes() == other.count.tobytes()
        assert np.array_equal(one.status, other.status)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "al5d"])
@pytest.mark.parametrize("n", [1, 2, 3, 5, 7, 8, 9, 15, 17])
def test_the_size_of_the_batch_changes_no_bit(name, n):
    """Goals at the end of a batch fill part of a pack of lanes only."""
    robot = load(name)
    goals = mixed_goals(robot, np.random.default_rng(3), 6)[:n]
    alone = np.stack([robot.ik(T[None]).q[0] for T in goals])
    assert robot.ik(goals).q.tobytes() == alone.tobytes()


def test_leading_axes_are_kept():
    robot = load("ur5e")
    goals = robot.fk(random_q(np.random.default_rng(4), 2, 3, 6))
    batch = robot.ik(goals)
    assert batch.q.shape == (2, 3, 8, 6)
    assert batch.count.shape == batch.status.shape == batch.reachable.shape == (2, 3)
    assert batch.residual.shape == (2, 3, 8)
    flat = robot.ik(goals.reshape(6, 4, 4))
    assert np.array_equal(batch.q.reshape(6, 8, 6), flat.q, equal_nan=True)
    assert np.array_equal(batch[1, 2].q, robot.ik(goals)[1, 2].q)
    assert batch.nearest(np.zeros(6)).shape == (2, 3, 6)
    assert batch.within().q.shape == (2, 3, 8, 6)


@pytest.mark.parametrize("shape", [(0,), (2, 0), (0, 3)])
@pytest.mark.parametrize("name", ["ur5e", "al5d", "yam"])
def test_an_empty_batch_has_an_empty_answer(name, shape):
    robot = load(name)
    batch = robot.ik(np.zeros((*shape, 4, 4)))
    assert batch.q.shape in {(*shape, 8, robot.dof), (*shape, 16, robot.dof)}
    assert batch.count.shape == batch.reachable.shape == shape
    assert batch.within().count.shape == shape


def test_batches_in_every_memory_order():
    robot = load("ur5e")
    goals = robot.fk(random_q(np.random.default_rng(5), 20, 6))
    expected = robot.ik(goals).q.tobytes()
    padded = np.zeros((20, 2, 5, 6))
    padded[:, 1, :4, 1:5] = goals
    for same in (np.asfortranarray(goals), padded[:, 1, :4, 1:5], goals[::-1][::-1], goals.tolist()):
        assert robot.ik(same).q.tobytes() == expected
    broadcast = robot.ik(np.broadcast_to(goals[0], (3, 4, 4, 4)))
    assert (broadcast.count == broadcast.count[0, 0]).all()


def test_residuals_of_a_batch():
    robot = load("puma560")
    goals = mixed_goals(robot, np.random.default_rng(6), 20)
    batch = robot.ik(goals)
    real = np.arange(8) < batch.count[:, None]
    assert np.isnan(batch.residual[~real]).all()
    assert batch.residual[real].max() < 1e-9
