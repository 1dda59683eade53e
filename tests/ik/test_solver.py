"""cs.ik.Solver: a solver without a Robot, and the law of its batches: each row is the answer to one goal."""

from __future__ import annotations

import copy
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.ik import NoClosedFormError, Solver

NAMES = ["ur5e", "puma560", "panda", "iiwa14_r820", "scara", "al5d", "jaco2", "planar_3r", "yumi_left"]
"""Closed forms, the general method, redundant arms and arms of few joints."""
PACKAGE = Path(cs.__file__).parent


def questions(solver, seed=0, count=6):
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1.2, 1.2, (count, solver.dof))
    return q, solver.fk(q)


def same(one, other):
    np.testing.assert_array_equal(one.q, other.q)
    assert (one.status, one.complete, one.reason, one.freedom) == (
        other.status,
        other.complete,
        other.reason,
        other.freedom,
    )


def partial(T, keywords):
    p, d = T[..., :3, 3], T[..., :3, 2]
    values = {"goal": T, "position": p, "direction": d, "look_at": p + 0.2 * d, "rotation": T[..., :3, :3]}
    return {name: values[name] for name in keywords.split()}


# --- without a Robot --------------------------------------------------------------------------------------
@pytest.mark.parametrize("name", NAMES)
def test_a_solver_of_a_chain_answers_as_the_robot_does(name):
    robot = cs.load_robot(name)
    solver = Solver(robot.chain, robot.limits)
    _, T = questions(robot)
    for pose in T:
        same(solver.solve(pose), robot.ik(pose))
    np.testing.assert_allclose(solver.fk(np.zeros(robot.dof)), robot.fk(np.zeros(robot.dof)), atol=1e-12)
    np.testing.assert_array_equal(solver.solve(T).q, robot.ik(T).q)


def test_a_solver_is_made_from_screws_and_knows_its_limits():
    chain = cs.load_robot("ur5e").chain
    solver = Solver.from_screws(chain.axes, chain.points, chain.T_zero, lower=[-1] * 6, upper=[1] * 6)
    q, T = questions(solver)
    found = solver.solve(T[0])
    assert np.abs(found.q - q[0]).max(axis=1).min() < 1e-9
    assert len(found.within()) <= len(found)
    assert np.isinf(Solver(solver.chain, False).limits.lower).all()
    with pytest.raises(InputError, match="limits are for 7 joints, robot has 6"):
        Solver(solver.chain, cs.load_robot("panda").limits)
    with pytest.raises(InputTypeError, match="Solver takes a Chain, got Robot"):
        Solver(cs.load_robot("ur5e"))
    with pytest.raises(NoClosedFormError, match="sixteen"):
        Solver.from_screws(np.eye(3)[[2] * 17], np.eye(17, 3), np.eye(4))


@pytest.mark.parametrize("name", ["ur5e", "panda", "scara"])
def test_solvers_and_their_results_survive_copies_and_pickles(name):
    solver = cs.load_robot(name).solver
    _, T = questions(solver)
    for made in (copy.deepcopy(solver), pickle.loads(pickle.dumps(solver))):
        same(made.solve(T[0]), solver.solve(T[0]))
    for keywords in ("goal", "position", "look_at"):
        found = solver.solve(**partial(T[0], keywords))
        again = pickle.loads(pickle.dumps(found))
        same(again, found)
        np.testing.assert_array_equal(again.residual, found.residual)


def test_functions_of_the_room_take_a_robot_or_a_solver():
    robot = cs.load_robot("iiwa14")
    q, T = questions(robot)
    for function in (lambda arm: cs.ik.redundancy(arm, T[0]), cs.ik.geometry, cs.ik.ik_plan):
        assert str(function(robot)) == str(function(robot.solver))
    np.testing.assert_array_equal(cs.ik.swivel(robot, q), cs.ik.swivel(robot.solver, q))
    for other in ("ur5e", None, np.eye(4)):
        for function in (cs.ik.geometry, cs.ik.ik_plan, lambda arm: cs.ik.redundancy(arm, np.eye(4))):
            with pytest.raises(InputTypeError, match=r"takes a robot or an ik\.Solver first"):
                function(other)


def test_threads_that_ask_one_solver_get_the_same_answers():
    robot = cs.load_robot("panda")
    _, T = questions(robot, count=8)
    kinds = ["goal", "position", "position direction", "look_at"]
    asked = [partial(pose, kind) for pose in T for kind in kinds]
    alone = [cs.load_robot("panda").ik(**keywords) for keywords in asked]
    with ThreadPoolExecutor(8) as pool:
        together = list(pool.map(lambda keywords: robot.ik(**keywords), asked))
    for one, other in zip(together, alone, strict=True):
        same(one, other)


@pytest.mark.parametrize("values", [{9: 0.1}, {0: np.nan}, {0: [0.1, 0.2]}, dict.fromkeys(range(6), 0.0)])
def test_joints_that_cannot_be_locked_are_refused(values):
    with pytest.raises(InputError, match="locked"):
        cs.load_robot("ur5e").solver.lock(values)


def test_redundancy_without_a_joint_of_another_arm():
    with pytest.raises(InputError, match="locked has joint 9"):
        cs.load_robot("ur5e").solver.redundancy_degree([9])


# --- batches ----------------------------------------------------------------------------------------------
@pytest.mark.parametrize("keywords", ["goal", "position", "position direction", "look_at", "rotation"])
@pytest.mark.parametrize("name", NAMES)
def test_a_batch_is_its_goals_one_by_one(name, keywords):
    robot = cs.load_robot(name)
    _, T = questions(robot, seed=3)
    T[-1, :3, 3] += 50.0
    batch = robot.ik(**partial(T, keywords))
    assert len(batch) == len(T)
    for k, pose in enumerate(T):
        one = robot.ik(**partial(pose, keywords))
        np.testing.assert_allclose(batch.q[k, : batch.count[k]], one.q, atol=1e-9)
        assert (batch.status[k], batch.complete[k]) == (one.status, one.complete)
        np.testing.assert_allclose(batch[k].q, one.q, atol=1e-9)
        np.testing.assert_allclose(batch[k].residual, one.residual, atol=1e-9)
        assert len(batch[k].self_motions) == len(one.self_motions)
    real = np.isfinite(batch.residual)
    assert batch.residual[real].max(initial=0) < 1e-6
    np.testing.assert_array_equal(real.sum(axis=-1), batch.count)


@pytest.mark.parametrize("keywords", ["goal", "position", "position direction"])
@pytest.mark.parametrize("each", [False, True], ids=["one seed", "a seed for each"])
@pytest.mark.parametrize("name", NAMES)
def test_near_of_a_batch_is_near_of_each_goal(name, each, keywords):
    robot = cs.load_robot(name)
    _, T = questions(robot, seed=4, count=5)
    seeds, _ = questions(robot, seed=5, count=5)
    batch = robot.ik(**partial(T, keywords), near=seeds if each else seeds[0])
    assert batch.q.shape == (5, 1, robot.dof)
    for k, pose in enumerate(T):
        one = robot.ik(**partial(pose, keywords), near=seeds[k] if each else seeds[0])
        if one.self_motions:
            continue  # a batch lists the representatives of self-motions, a single goal their nearest member
        np.testing.assert_allclose(batch.q[k, : batch.count[k]], one.q, atol=1e-8)


@pytest.mark.parametrize("keywords", ["goal", "position direction"])
@pytest.mark.parametrize("name", ["panda", "iiwa14_r820", "yumi_left"])
def test_locked_joints_of_a_batch_are_locked_for_each_goal(name, keywords):
    robot = cs.load_robot(name)
    q, T = questions(robot, seed=6)
    joint = robot.solver.redundant_joints[0]
    locked = {robot.joint_names[joint]: q[:, joint]}
    if keywords != "goal":
        locked["goal_tool_turn_z"] = 0.1
        with pytest.raises(InputTypeError, match="one number with parts of a pose"):
            robot.ik(**partial(T, keywords), locked=locked)
        return
    batch = robot.ik(T, locked=locked)
    for k, pose in enumerate(T):
        one = robot.ik(pose, locked={joint: q[k, joint]})
        np.testing.assert_allclose(batch.q[k, : batch.count[k]], one.q, atol=1e-9)
        assert batch[k].reason == one.reason


@pytest.mark.parametrize("name", ["ur5e", "panda", "planar_2r", "scara"])
def test_least_squares_of_a_batch_is_that_of_each_goal(name):
    robot = cs.load_robot(name)
    _, T = questions(robot, seed=7, count=4)
    T[1::2, :3, 3] += 3.0
    for keywords in ("goal", "position"):
        batch = robot.ik(**partial(T, keywords), least_squares=True)
        assert (batch.count > 0).all()
        for k, pose in enumerate(T):
            one = robot.ik(**partial(pose, keywords), least_squares=True)
            assert batch.status[k] == one.status == batch[k].status
            np.testing.assert_allclose(np.sort(batch[k].residual), np.sort(one.residual), atol=1e-6)


# --- the house --------------------------------------------------------------------------------------------
def rooms_entered(call):
    """The rooms of the package in the order in which a call enters them."""
    rooms: list[str] = []

    def enter(room):
        if room and (not rooms or rooms[-1] != room):
            rooms.append(room)

    def room_of(frame):
        path = Path(frame.f_code.co_filename)
        return path.relative_to(PACKAGE).parts[0] if PACKAGE in path.parents else None

    def watch(frame, event, argument):
        if event == "c_call":
            owner = argument.__self__
            of_core = "_core" in (getattr(owner, "__name__", ""), type(owner).__module__.split(".")[-1])
            if of_core or isinstance(owner, (cs.Robot, Solver)):
                enter("_core")
        elif event == "return":
            back = frame.f_back
            while back and room_of(back) is None:
                back = back.f_back
            enter(back and room_of(back))
        else:
            enter(room_of(frame))

    sys.setprofile(watch)
    try:
        call()
    finally:
        sys.setprofile(None)
    return rooms


@pytest.mark.parametrize(
    "keywords", ["position", "position direction", "direction", "look_at", "rotation", "position rotation"]
)
@pytest.mark.parametrize("name", ["ur5e", "panda", "al5d"])
def test_a_partial_goal_enters_few_rooms(name, keywords):
    robot = cs.load_robot(name)
    asked = partial(questions(robot)[1][0], keywords)
    robot.ik(**asked)
    unseen = 2  # the one call of the core that answers, and the way back: it raises no event of the profiler
    assert len(rooms_entered(lambda: robot.ik(**asked))) + unseen <= 8
