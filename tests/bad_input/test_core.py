"""The compiled half under wrong objects, wrong sizes and several threads: it raises and never crashes."""

from __future__ import annotations

import copy
import gc
import pickle
import sys
import threading
import weakref
from types import SimpleNamespace

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.ik import Solutions

GOAL = cs.load_robot("ur5e").fk(np.full(6, 0.5))


@pytest.fixture
def arm():
    robot = cs.load_robot("ur5e")
    assert len(robot.ik(GOAL)) > 0
    return robot


def answers(n, **other):
    """The arrays that _ik_many fills for n goals, some of them replaced."""
    right = {
        "q": np.empty((n, 8, 6)),
        "count": np.empty(n, dtype=np.int64),
        "status": np.empty(n, dtype=np.uint8),
    }
    return (right | other).values()


def read_only(array):
    array.flags.writeable = False
    return array


@pytest.mark.parametrize(
    "wrong",
    [
        {"count": np.empty(100, dtype=np.int8)},
        {"count": np.empty(99, dtype=np.int64)},
        {"count": np.empty(200, dtype=np.int64)[::2]},
        {"count": read_only(np.zeros(100, dtype=np.int64))},
        {"status": np.empty(1, dtype=np.uint8)},
        {"status": np.empty(100, dtype=np.int64)},
        {"status": 5},
        {"q": np.empty((100, 8, 5))},
        {"q": read_only(np.zeros((100, 8, 6)))},
    ],
)
def test_a_batch_refuses_arrays_it_cannot_fill(arm, wrong):
    with pytest.raises((TypeError, ValueError), match=r"_ik_many|matching sizes"):
        _core._ik_many(arm.solver, np.stack([GOAL] * 100), *answers(100, **wrong), 1)


def test_what_is_no_solver_is_refused(arm):
    assert _core._ik_geometry(object()) is None
    rows = [np.zeros(6)] * 4
    arrays = np.zeros((6, 3)), np.zeros((6, 3)), rows[0], np.eye(4), *rows[1:], 1.0
    parts = GOAL, 1, np.zeros((1, 6)), (0,), (False,), None
    for other in (object(), 5, None, Solutions, arm):
        for call, arguments in [
            (_core._ik_build, arrays),
            (_core._ik_single, (GOAL,)),
            (_core._ik_near_singular, (GOAL, np.zeros(6))),
            (_core._ik_nearest_pose, (GOAL, 1.0)),
            (_core._ik_position, (np.zeros(3),)),
            (_core._ik_nearest_position, (np.zeros(3),)),
            (_core._ik_positions, (np.zeros((1, 3)), *answers(1), 1)),
            (_core._ik_follow, (np.zeros(6), np.zeros(6), True)),
            (_core._ik_onto, (np.zeros(6), np.zeros((2, 6)), np.zeros((2, 6)), True)),
            (_core._ik_many, (np.stack([GOAL]), *answers(1), 1)),
            (_core._ik_make, parts),
        ]:
            with pytest.raises(TypeError, match=r"solver|arm of up to three"):
                call(other, *arguments)
    with pytest.raises(TypeError, match="status"):
        _core._ik_make(arm.solver, GOAL, 99, *parts[2:])
    for other in (5, int, object, _core.KinematicsBase):
        with pytest.raises(TypeError, match="subclass of SolutionsBase"):
            _core._ik_results(other)
    assert type(arm.ik(GOAL)) is Solutions


def test_answers_that_do_not_fit_are_refused():
    zeros = np.zeros
    with pytest.raises(ValueError, match="equal lengths"):
        _core.sincos(zeros(1000), zeros(1000), zeros(1))
    with pytest.raises(ValueError, match="equal lengths"):
        _core.atan2(zeros(1000), zeros(1000), zeros(1))
    for function in (_core.acos, _core.asin):
        with pytest.raises(ValueError, match="equal lengths"):
            function(zeros(1000), zeros(1))
    one = zeros(1, np.int32), zeros(1, bool), zeros(1, bool)
    vectors = [zeros((1, 3))] * 3
    for theta, residual in [(zeros((1, 1, 1)), zeros(9999)), (zeros((1, 0, 1)), zeros(1))]:
        with pytest.raises(ValueError, match="one row per problem"):
            _core.subproblem_1(*vectors, theta, residual, *one)


@pytest.mark.parametrize("number", [99999, -1, "x", None, 2**70])
def test_names_of_frames_that_are_not_there_are_refused(arm, number):
    parts = {name: getattr(arm._assembly, name) for name in dir(arm._assembly) if name[0] != "_"}
    with pytest.raises((TypeError, OverflowError)):
        _core.KinematicsBase(SimpleNamespace(**(parts | {"frame_index": {"a": number}})))


def test_threads_that_ask_first_at_once_share_one_solver():
    """A later thread must not replace the solver that an earlier one is computing with."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(20):
            robot = cs.load_robot("ur5e")
            T = robot.fk(np.random.default_rng(3).uniform(-3, 3, (300, 6)))
            start, counts = threading.Barrier(6), []

            def ask(robot=robot, T=T, start=start, counts=counts):
                start.wait()
                counts.append(int(robot.ik(T, threads=2).count.sum()))

            threads = [threading.Thread(target=ask) for _ in range(6)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            assert counts == [counts[0]] * 6
    finally:
        sys.setswitchinterval(before)


def test_the_cycle_of_a_robot_and_its_answer_is_collected():
    robot = cs.load_robot("ur5e")
    robot._last = robot.ik(GOAL)
    gone = weakref.ref(robot)
    del robot
    gc.collect()
    assert gone() is None


def test_answers_outlive_their_robot_and_can_be_copied_and_sent(arm):
    position = cs.load_robot("planar_2r").ik(position=(0.5, 0.5))
    away = arm.ik(np.diag([1.0, 1, 1, 1]) + 9 * np.eye(4, k=3))
    assert not away
    for found in (arm.ik(GOAL), arm.ik(GOAL).nearest(np.zeros(6)), position, away):
        for twin in (copy.copy(found), copy.deepcopy(found), pickle.loads(pickle.dumps(found))):
            assert np.array_equal(twin.q, found.q)
            assert np.array_equal(twin.goal, found.goal)
            assert twin.out_of_reach == found.out_of_reach
            assert (twin.status, twin.reason, twin.branch) == (found.status, found.reason, found.branch)
    found = arm.ik(GOAL)
    del arm
    gc.collect()
    assert found.solver.name == "ur5e"
    assert found.residual.max() < 1e-9


def test_curves_and_points_refuse_rows_of_another_size(arm):
    q, rows = np.zeros(6), np.zeros((2, 6))
    for call, arguments in [
        (_core._ik_follow, (np.zeros(5), q, True)),
        (_core._ik_follow, (q, q.astype(np.float32), True)),
        (_core._ik_onto, (q, rows, rows[:1], True)),
        (_core._ik_onto, (q, np.zeros(11), np.zeros(11), True)),
        (_core._ik_onto, (q, rows.tolist(), rows, True)),
        (_core._ik_positions, (np.zeros((3, 3)), *answers(3), 1)),  # an arm of six joints
    ]:
        with pytest.raises((TypeError, ValueError), match=r"up to three joints|matching sizes|incompatible"):
            call(arm.solver, *arguments)
