"""One robot asked by many threads at once, copied, and sent to other processes: always the same answers."""

import copy
import pickle
import threading

import numpy as np
import pytest

from cspace.model import from_screws
from cspace.robot import Robot
from ik.arms import load
from ik.likenesses import MAKERS, arm_of, random_configurations

THREADS = 8
NAMES = ["ur5e", "puma560", "yam", "jaco2", "so101", "stanford", "panda", "planar_3r"]


def goals_of(robot, n, seed=1):
    """Random, singular and unreachable poses."""
    rng = np.random.default_rng(seed)
    quarters = rng.integers(-1, 3, (n, robot.dof)) * (np.pi / 2)
    slides = np.array([kind == "P" for kind in robot.joint_types])
    goals = robot.fk(np.concatenate([random_configurations(robot, rng, n), np.where(slides, 0.3, quarters)]))
    away = goals[:1].copy()
    away[:, :3, 3] += 100
    return np.concatenate([goals, away])


def summary(found):
    self_motions = tuple(f.direction.tobytes() for f in found.self_motions)
    return (
        found.q.tobytes(),
        found.status,
        found.complete,
        found.reason,
        found.residual.tobytes(),
        self_motions,
    )


def in_threads(work):
    """work(k) by all threads, started together; their results, or the first error."""
    results, errors, start = [None] * THREADS, [], threading.Barrier(THREADS)

    def run(k):
        try:
            start.wait()
            results[k] = work(k)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=run, args=(k,)) for k in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if errors:
        raise errors[0]
    return results


def fresh(robot):
    """The same arm whose solver is not built yet."""
    c = robot.chain
    return Robot(from_screws(c.axes, c.points, c.T_zero, joint_types=c.joint_types, name=c.name))


@pytest.mark.parametrize("name", NAMES)
def test_threads_that_share_a_robot_get_what_one_alone_gets(name):
    robot = load(name)
    goals = goals_of(robot, 4)
    expected = [summary(robot.ik(T)) for T in goals]
    batch = robot.ik(goals, threads=1)

    def work(k):
        order = np.random.default_rng(k).permutation(len(goals))
        mine = {i: summary(robot.ik(goals[i])) for i in order}
        many = robot.ik(goals, threads=2)
        assert many.q.tobytes() == batch.q.tobytes()
        return [mine[i] for i in range(len(goals))]

    for result in in_threads(work):
        assert result == expected


@pytest.mark.parametrize("name", NAMES)
def test_threads_that_all_are_the_first_to_ask(name):
    goals = goals_of(load(name), 2)
    expected = [summary(fresh(load(name)).ik(T)) for T in goals]
    robot = fresh(load(name))
    for result in in_threads(lambda k: [summary(robot.ik(T)) for T in goals]):
        assert result == expected


COPIES = {"pickle": lambda r: pickle.loads(pickle.dumps(r)), "copy": copy.copy, "deepcopy": copy.deepcopy}


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("name", [*NAMES, "RPRRPR"])
def test_copies_of_a_robot_answer_as_it_does(name, how):
    robot = load(name) if name in NAMES else arm_of(name, *MAKERS["general"](name, np.random.default_rng(2)))
    goals = goals_of(robot, 2)
    expected = [summary(robot.ik(T)) for T in goals]
    twin = COPIES[how](robot)
    assert twin.name == robot.name
    assert [summary(twin.ik(T)) for T in goals] == expected
    again = COPIES[how](robot.ik(goals[0]))
    assert summary(again) == expected[0]
    assert np.array_equal(
        again.nearest(goals_q := np.zeros(robot.dof)).q, robot.ik(goals[0]).nearest(goals_q).q
    )


def test_an_answer_outlives_its_robot():
    robot = fresh(load("ur5e"))
    T = robot.fk(np.full(6, 0.4))
    found, expected = robot.ik(T), robot.ik(T).q.copy()
    del robot
    assert np.array_equal(found.q, expected)
    assert found.residual.max() < 1e-12
    assert found.derivative.shape == (len(expected), 6, 6)
