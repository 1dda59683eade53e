"""The benchmarks on seven joints, paths, building and false solutions ask what they say and judge rightly."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from data import ROOT


@pytest.fixture(autouse=True)
def _benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))


def test_a_false_solution_is_counted_and_a_true_one_is_not():
    import arms
    import soundness

    class Liar:
        def __init__(self, robot, error):
            self.robot, self.error = robot, error

        def ik(self, T, threads):
            answer = self.robot.ik(T)
            answer.q[..., 0] += self.error
            return answer

    arm = arms.load("ur5e")
    T = soundness.random(arm, 60, np.random.default_rng(1))
    robot = cs.load_robot("ur5e")
    honest, lying = (soundness.examine(arm, Liar(robot, error), T) for error in (0.0, 1e-8))
    assert honest["false"] == 0
    assert honest["solutions"] > 60
    assert lying["false"] == lying["solutions"] == honest["solutions"]


def test_an_exception_is_counted_as_a_crash_of_every_goal_of_its_call():
    import arms
    import soundness

    class Broken:
        def ik(self, T, threads):
            raise RuntimeError("no")

    arm = arms.load("ur5e")
    T = soundness.random(arm, 60, np.random.default_rng(1))
    assert soundness.examine(arm, Broken(), T)["crashes"] == 60


@pytest.mark.parametrize(
    "kind", ["random", "right angles", "almost right angles", "next to singular", "rim of reach", "turned"]
)
def test_adversarial_goals_are_poses(kind):
    import arms
    import soundness

    T = soundness.KINDS[kind](arms.load("jaco2"), 30, np.random.default_rng(2))
    assert T.shape == (30, 4, 4)
    assert np.abs(cs.as_pose(T) - T).max() == 0


def test_goals_out_of_reach_are_out_of_reach_but_for_few():
    import arms
    import soundness

    T = soundness.KINDS["out of reach"](arms.load("ur5e"), 200, np.random.default_rng(2))
    assert (cs.load_robot("ur5e").ik(T).count == 0).mean() > 0.7


def test_the_arm_named_after_its_neighbours_is_solved_through_them():
    import building
    from peers import cspace_

    plan = cspace_.robot(building.through_neighbours()).ik_plan()
    assert "Two neighbours of the arm" in plan.to_text()


def test_an_answer_farther_from_the_seed_than_the_configuration_of_the_goal_is_not_right():
    import arms
    import chains
    import problems
    import seven

    arm = arms.load("panda")
    q = problems.within_limits(arm, 20, np.random.default_rng(3))
    assert (arm.lower <= q).all()
    assert (q <= arm.upper).all()
    seeds = q + 0.05
    turned = q + 2 * np.pi  # the same configurations, a whole turn on
    right = seven.nearness(arm, turned, q, seeds, chains.fk(arm, q))
    assert right["near"] == 1
    assert right["residual"] < 1e-13
    wrong = np.where(np.arange(20)[:, None] < 5, q - 0.01, q)
    judged = seven.nearness(arm, wrong, q, seeds, chains.fk(arm, q))
    assert judged["near"] == 0.75
    assert judged["residual"] > 1e-3


def test_a_branch_that_ends_early_does_not_count():
    import arms
    import chains
    import following

    arm = arms.load("ur5e")
    line = following.FIRST + np.linspace(0, 1, 10)[:, None] * (following.LAST - following.FIRST)
    judged = following.straightness(arm, [line, line[:7]], chains.fk(arm, line), line)
    assert judged == {"branches": 1, "residual": 0.0, "away": 0.0}


def test_a_descent_of_the_peer_arrives_from_close_by():
    pytest.importorskip("pinocchio")
    import arms
    import chains
    from peers import pinocchio_

    arm = arms.load("panda")
    q = np.array([0.3, 0.4, -0.2, -1.9, 0.3, 2.1, 0.6])
    step, prepare = pinocchio_.descent(arm)
    T = chains.fk(arm, q)
    assert np.abs(chains.fk(arm, step((prepare(T), q + 0.1))) - T).max() < 1e-8
    far = T.copy()
    far[:3, 3] += 5
    assert np.isnan(step((prepare(far), q))).all()
