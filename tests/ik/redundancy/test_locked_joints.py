"""Arms with joints held at given values: every recorded solution, the same for names, numbers and batches."""

import json
import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from data import shared_data
from ik.arms import robot_from_chain, shared_chains


def wrapped(difference):
    return np.abs(np.angle(np.exp(1j * difference)))


def recorded_sets():
    folder = shared_data() / "arms"
    meta = json.loads((folder / "solutions_meta.json").read_text())
    sets = np.load(folder / "solutions.npz")
    for name, about in meta.items():
        if about["locked_joint"] is not None:
            yield (
                name,
                about["locked_joint"],
                {key: sets[f"{name}/{key}"] for key in ("T", "q_true", "nsol", "Q")},
            )


def test_every_recorded_solution_of_the_locked_arms_is_found():
    names = []
    for name, locked, data in recorded_sets():
        robot = robot_from_chain(shared_chains()[name])
        names.append(name)
        for T, q_true, count, recorded in zip(
            data["T"], data["q_true"], data["nsol"], data["Q"], strict=True
        ):
            s = robot.ik(T, locked={locked: q_true[locked]})
            assert len(s) == count, name
            assert s.residual.max() < 1e-11
            for row in recorded[:count]:
                assert wrapped(s.q - row).max(axis=1).min() < 1e-7, name
    assert sorted(names) == ["franka_panda", "gen3", "iiwa14", "rizon4"]


@pytest.mark.parametrize("joint", range(7))
@pytest.mark.parametrize("name", ["panda", "gen3"])
def test_any_joint_may_be_locked(name, joint):
    robot = cs.load_robot(name)
    for q in robot.random_configuration(5, rng=joint):
        s = robot.ik(robot.fk(q), locked={robot.joint_names[joint]: q[joint]})
        assert s.residual.max() < 1e-11
        assert (s.q[:, joint] == q[joint]).all()
        assert wrapped(s.q - q).max(axis=1).min() < 1e-8
        assert not s.freedom


def test_names_numbers_and_batches_give_the_same():
    robot = cs.load_robot("panda")
    q = robot.random_configuration(40, rng=3)
    Ts = robot.fk(q)
    together = robot.ik(Ts, locked={6: q[:, 6]}, threads=2)
    assert together.q.shape == (40, 8, 7)
    for k, (T, row) in enumerate(zip(Ts, q, strict=True)):
        one = robot.ik(T, locked={"panda_joint7": row[6]})
        assert together.count[k] == len(one) > 0
        assert wrapped(together.q[k, : len(one)] - one.q).max() < 1e-9
        assert np.array_equal(together[k].q, together.q[k, : len(one)])
    values = np.linspace(-2.8, 2.8, 9)
    swept = robot.ik(Ts[0], locked={-1: values})
    for k, value in enumerate(values):
        one = robot.ik(Ts[0], locked={-1: value})
        assert len(one) == swept.count[k]
        assert wrapped(swept.q[k, : len(one)] - one.q).max(initial=0) < 1e-9
    alone = robot.ik(Ts, locked={6: q[:, 6]}, threads=1)
    assert np.array_equal(alone.q, together.q, equal_nan=True)


def test_joints_of_arms_that_are_not_redundant_may_be_locked_too():
    robot = cs.load_robot("ur5e")
    q = robot.random_configuration(rng=2)
    s = robot.ik(robot.fk(q), locked={"wrist_3_joint": q[5]})
    assert len(s)
    assert wrapped(s.q - q).max(axis=1).min() < 1e-9
    assert (s.q[:, 5] == q[5]).all()
    missed = robot.ik(robot.fk(q), locked={"wrist_3_joint": q[5] + 0.1})
    assert not missed
    assert "wrist_3_joint" in missed.reason


def test_eight_joints_are_solved_by_holding_two():
    robot = cs.load_robot("pr2_right_torso")
    q = robot.random_configuration(rng=5)
    s = robot.ik(robot.fk(q), locked={0: q[0], 1: q[1]})
    assert s.residual.max() < 1e-11
    assert wrapped(s.q - q).max(axis=1).min() < 1e-8
    nearest = robot.ik(robot.fk(q), near=q + 0.01)
    assert nearest.residual.max() < 1e-11
    assert np.linalg.norm(nearest.q - (q + 0.01)) <= 0.01 * np.sqrt(8) + 1e-9
    assert len(nearest.freedom) == 2
    one_left = robot.ik(robot.fk(q), locked={0: q[0]})
    assert len(one_left.freedom) == 1
    assert one_left.residual.max() < 1e-9
    assert np.allclose(one_left.q[:, 0], q[0])
    middle = robot.ik(robot.fk(q))
    assert len(middle) == 1
    assert middle.residual.max() < 1e-11


def test_freedom_that_a_held_joint_leaves_is_named():
    robot = cs.load_robot("iiwa14")
    q = robot.random_configuration(rng=4)
    s = robot.ik(
        robot.fk(q), locked={3: q[3]}
    )  # the elbow's angle is given by the goal: the arm still swivels
    assert len(s.freedom) == 1
    assert len(s) >= 16
    assert s.residual.max() < 1e-11
    assert np.abs(s.q[:, 3] - q[3]).max() == 0
    assert not robot.ik(robot.fk(q), locked={3: q[3] + 0.2})


def test_answers_survive_pickling():
    robot = cs.load_robot("panda")
    q = robot.random_configuration(rng=1)
    s = robot.ik(robot.fk(q))
    again = pickle.loads(pickle.dumps(s))
    assert np.array_equal(again.q, s.q)
    assert again.freedom == s.freedom
    assert again.reason == s.reason


@pytest.mark.parametrize(
    ("locked", "error", "words"),
    [
        ({"panda_joint9": 0.1}, UnknownNameError, "panda_joint"),
        ({7: 0.1}, InputError, "joints 0 to 6"),
        ({6: np.nan}, InputError, "finite"),
        ({6: 0.1, "panda_joint7": 0.2}, InputError, "twice"),
        ({1.5: 0.1}, InputTypeError, "name or number"),
        ([0.1], InputTypeError, "dict"),
        (dict.fromkeys(range(7), 0.0), InputError, "at least one must stay free"),
    ],
)
def test_what_cannot_be_locked_is_refused(locked, error, words):
    robot = cs.load_robot("panda")
    with pytest.raises(error, match=words):
        robot.ik(robot.fk(np.zeros(7)), locked=locked)


def test_samples_and_near_need_freedom_of_the_right_kind():
    robot = cs.load_robot("panda")
    T = robot.fk(np.zeros(7))
    with pytest.raises(InputTypeError, match="one free dimension"):
        robot.ik(T, locked={6: 0.1}, samples=4)
    with pytest.raises(InputTypeError, match="near"):
        robot.ik(T, near=np.zeros(7), samples=4)
    with pytest.raises(InputError, match="samples is 0"):
        robot.ik(T, samples=0)
    with pytest.raises(InputError, match="near has shape"):
        robot.ik(T, near=np.zeros((2, 7)))


@pytest.mark.parametrize(("name", "words"), [("ur5e", "ur5e has 0 here: leave samples= out")])
def test_samples_without_freedom_say_so(name, words):
    robot = cs.load_robot(name)
    with pytest.raises(InputTypeError, match=words):
        robot.ik(robot.fk(np.full(6, 0.3)), samples=4)


def test_goals_and_values_that_do_not_fit_together_are_refused():
    robot = cs.load_robot("iiwa14")
    T = np.stack([robot.fk(np.full(7, 0.3))] * 2)
    with pytest.raises(InputError, match=r"goal \(2,\) and locked\['iiwa_joint_1'\] \(3,\)"):
        robot.ik(T, locked={0: [0.1, 0.2, 0.3]})
    with pytest.raises(InputError, match=r"goal \(2,\) and swivel \(3,\)"):
        robot.ik(T, swivel=[0.1, 0.2, 0.3])


@pytest.mark.parametrize("name", ["panda", "iiwa14", "pr2_right_torso", "ur5e"])
def test_one_number_answers_like_an_array_of_it(name):
    """The compiled entry takes numbers; whatever else is given goes the long way."""
    robot = cs.load_robot(name)
    locked = {"panda": (6,), "iiwa14": (2,), "pr2_right_torso": (0, 3), "ur5e": (5,)}[name]
    for q in robot.random_configuration(6, rng=4):
        T = robot.fk(q)
        numbers = {robot.joint_names[j]: float(q[j]) for j in locked}
        long_way = robot.ik(T, locked={j: np.array(q[j]) for j in locked})
        headings = {f"q{j + 1}": q[j] for j in locked}
        for given in (numbers, headings, {j: q[j] for j in locked}, {j - robot.dof: q[j] for j in locked}):
            short = robot.ik(T, locked=given)
            assert np.array_equal(short.q, long_way.q)
            for what in ("branch", "complete", "status", "reason", "freedom", "self_motions"):
                assert getattr(short, what) == getattr(long_way, what), what
    far = T.copy()
    far[:3, 3] = 50.0
    assert not robot.ik(far, locked=numbers)
    assert robot.joint_names[locked[0]] in robot.ik(far, locked=numbers).reason
    for wrong in (np.nan, np.inf, 1e200):
        with pytest.raises(InputError):
            robot.ik(T, locked=numbers | {robot.joint_names[locked[0]]: wrong})
    with pytest.raises(InputError, match="twice"):
        robot.ik(T, locked=numbers | {locked[0]: 0.1})
    for unknown in ("no_such_joint", "q0", f"q{robot.dof + 1}", "q01", "Q1", "q"):
        with pytest.raises(UnknownNameError):
            robot.ik(T, locked={unknown: 0.1})


def test_headings_of_joints_are_names_in_every_function_that_takes_joints():
    robot = cs.load_robot("iiwa14")
    T = robot.fk(robot.random_configuration(rng=3))
    name = robot.joint_names[6]
    assert robot.redundancy(T, "q7").parameter == robot.redundancy(T, name).parameter == name
    assert str(robot.ik_plan(locked={"q7": 0.0})) == str(robot.ik_plan(locked={name: 0.0}))
    part = {"position": T[:3, 3], "direction": T[:3, 2]}
    short = robot.ik(**part, locked={"q7": 0.2, "q1": 0.1}, near=np.zeros(7))
    assert np.array_equal(short.q, robot.ik(**part, locked={6: 0.2, 0: 0.1}, near=np.zeros(7)).q)
    with pytest.raises(InputError, match="twice"):
        robot.ik(T, locked={"q7": 0.1, name: 0.1})


@pytest.mark.parametrize("name", ["panda", "gen3", "tiago_arm", "fetch_torso"])
def test_goals_that_nothing_reaches_are_told_alike_one_by_one_and_in_a_batch(name):
    robot = cs.load_robot(name)
    T = robot.fk(robot.random_configuration(60, rng=4))
    locked = {robot.joint_names[-1]: 0.3, 0: -0.2} if robot.dof == 8 else {robot.joint_names[-1]: 0.3}
    batch = robot.ik(T, locked=locked)
    empty = 0
    for goal, expected in zip(T, batch, strict=True):
        for s in (robot.ik(goal, locked=locked), pickle.loads(pickle.dumps(robot.ik(goal, locked=locked)))):
            assert (s.status, s.reason, s.complete) == (expected.status, expected.reason, expected.complete)
            assert len(s) == len(expected)
            empty += not s
    assert empty > 10
