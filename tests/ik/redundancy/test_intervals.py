"""Feasible intervals of a joint to spare: no sample contradicts them, and their ends are exact."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError

TURN = 2 * np.pi


def inside_limits(robot, q, skip):
    lower, upper = robot.limits.lower, robot.limits.upper
    turn = np.where((upper - lower) < TURN, 0.0, np.inf)
    bounded = np.isfinite(lower) & np.isfinite(upper)
    middle = np.where(bounded, 0.5 * (np.where(bounded, lower, 0) + np.where(bounded, upper, 0)), 0.0)
    off = np.abs(np.angle(np.exp(1j * (q - middle)))) - 0.5 * (upper - lower)
    fits = (off <= 0) | (turn > 0)
    fits[..., skip] = True
    return fits.all(axis=-1)


def contradictions(robot, T, found, joint, n):
    """At how many of n values, away from the ends, the intervals miscount the feasible branches."""
    lower, upper = robot.limits.lower[joint], robot.limits.upper[joint]
    if not upper - lower < TURN:
        lower, upper = -np.pi, np.pi
    values = lower + (upper - lower) * (np.arange(n) + 0.5) / n
    b = robot.ik(T, locked={joint: values})
    ends = np.array([end for interval in found for end in (interval.lower, interval.upper)])
    wrong = 0
    for value, rows, count in zip(values, b.q, b.count, strict=True):
        if len(ends) and np.abs(np.angle(np.exp(1j * (ends - value)))).min() < 2e-4:
            continue
        feasible = int(inside_limits(robot, rows[:count], joint).sum())
        wrong += feasible != sum(value in interval for interval in found)
    return wrong


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "iiwa14", "pr2_right", "j2s7s300", "xarm7", "tiago_arm", "rm75"])
def test_no_sample_contradicts_the_intervals(name):
    robot = cs.load_robot(name)
    for q in robot.random_configuration(4, rng=21):
        T = robot.fk(q)
        found = robot.redundancy(T)
        joint = robot.joint_names.index(found.parameter)
        assert found.complete
        assert found.feasible(q[joint])
        assert contradictions(robot, T, found, joint, 2000) == 0


@pytest.mark.parametrize("name", ["gen3", "rizon4", "yumi_left", "baxter_left", "g1_left_arm"])
def test_nor_do_those_of_arms_without_a_closed_form(name):
    robot = cs.load_robot(name)
    for q in robot.random_configuration(2, rng=22):
        T = robot.fk(q)
        found = robot.redundancy(T)
        joint = robot.joint_names.index(found.parameter)
        assert found.feasible(q[joint])
        assert contradictions(robot, T, found, joint, 200) == 0


@pytest.mark.parametrize(
    "q",
    [
        [-0.67057, -1.09108, 0.20320, 0.01313, 0.39270, -1.02450, -1.46968],
        [1.4554, -1.3463, 0.3647, 0.0089, -2.9799, 1.2228, -0.8238],
        [0.2084, 0.2189, -0.2395, -0.0147, -2.1482, -1.8309, -1.8745],
        [2.7289, 0.6169, 0.1995, 0.0120, 2.5331, -2.0397, 2.6530],
    ],
)
def test_narrow_loops_of_an_elbow_that_is_nearly_straight_are_followed_round_both_strands(q):
    robot = cs.load_robot("gen3")
    found = robot.redundancy(robot.fk(q))
    assert found.feasible(q[6])


@pytest.mark.parametrize("joint", [0, 1, 3, 5])
def test_any_joint_may_be_the_parameter(joint):
    robot = cs.load_robot("panda")
    for q in robot.random_configuration(2, rng=23):
        T = robot.fk(q)
        found = robot.redundancy(T, parameter=robot.joint_names[joint])
        assert found.feasible(q[joint])
        assert contradictions(robot, T, found, joint, 200) == 0


@pytest.mark.parametrize("name", ["panda", "gen3"])
def test_ends_are_limits_and_folds(name):
    robot = cs.load_robot(name)
    kinds = set()
    for q in robot.random_configuration(6, rng=24):
        T = robot.fk(q)
        found = robot.redundancy(T)
        joint = robot.joint_names.index(found.parameter)
        others = [k for k in range(7) if k != joint]
        for interval in found:
            for value, end in zip((interval.lower, interval.upper), interval.ends, strict=True):
                kinds.add(end.split(" at ")[-1])
                inwards = 1 if value == interval.lower else -1
                s = robot.ik(T, locked={joint: value + inwards * 1e-10})
                if end == "fold":
                    assert len(s), (name, value)
                    J = robot.jacobian(s.q)[:, :, others]
                    J[:, :3] /= 0.4
                    assert np.linalg.svd(J, compute_uv=False)[:, -1].min() < 1e-3
                elif end != "nothing":
                    name_of, side = end.split(" at ")
                    k = robot.joint_names.index(name_of)
                    limit = robot.limits.lower[k] if side == "lower limit" else robot.limits.upper[k]
                    if k == joint:
                        assert value == pytest.approx(limit, abs=1e-12)
                    else:
                        assert np.abs(np.angle(np.exp(1j * (s.q[:, k] - limit)))).min() < 1e-6
    assert {"fold", "lower limit", "upper limit"} <= kinds


def test_samples_are_spread_over_what_is_feasible():
    robot = cs.load_robot("panda")
    T = robot.fk(robot.random_configuration(rng=30))
    found = robot.redundancy(T)
    values = found.spread(16)
    assert all(found.feasible(value) for value in values)
    s = robot.ik(T)
    assert len(s.freedom) == 1
    assert s.freedom == (found.parameter,)
    assert np.allclose(np.unique(s.q[:, 6]), values)
    assert s.residual.max() < 1e-11
    assert "16 values" in s.reason
    assert len({round(v, 9) for v in s.within().q[:, 6]}) == 16
    assert len(np.unique(robot.ik(T, samples=5).q[:, 6])) == 5
    b = robot.ik(np.array([T, T]), samples=5)
    assert b.count.tolist() == [len(robot.ik(T, samples=5))] * 2
    assert b.freedom == s.freedom
    assert np.array_equal(b[1].q, robot.ik(T, samples=5).q)
    assert found.parameter in str(found)
    assert "branch" in str(found)


def test_goals_out_of_limits_are_sampled_limits_aside():
    robot = cs.load_robot("panda")
    q = np.array([0.3, 2.6, 0.2, 0.5, 0.3, -0.8, 0.1])  # most joints out
    T = robot.fk(q)
    found = robot.redundancy(T)
    if not found:
        s = robot.ik(T)
        assert len(s)
        assert "none of them within limits" in s.reason
        assert not s.within()
        assert "no value" in str(found)


def test_arms_with_none_or_more_to_spare_are_told_so():
    ur = cs.load_robot("ur5e")
    with pytest.raises(InputError, match="0 redundant joints"):
        ur.redundancy(ur.fk(np.zeros(6)))
    pr2 = cs.load_robot("pr2_right_torso")
    q = pr2.random_configuration(rng=1)
    with pytest.raises(InputError, match="2 redundant joints"):
        pr2.redundancy(pr2.fk(q))
    found = pr2.redundancy(pr2.fk(q), locked={0: q[0]})
    assert found
    assert found.intervals[0].q[0] == q[0]


def test_a_joint_that_the_goal_settles_is_no_parameter():
    iiwa = cs.load_robot("iiwa14")
    T = iiwa.fk([0.3, 0.7, -0.2, -1.2, 0.3, 0.9, 0.6])
    with pytest.raises(InputError, match=r"determined by the goal, at -1\.2 rad, 1\.2 rad"):
        iiwa.redundancy(T, parameter="iiwa_joint_4")
    assert iiwa.redundancy(T, parameter="iiwa_joint_1")


def test_a_slide_is_not_the_same_after_a_turn():
    chain = cs.load_robot("ur5e").chain
    robot = cs.Robot.from_screws(
        np.vstack([[[1, 0, 0]], chain.axes]),
        np.vstack([np.zeros((1, 3)), chain.points]),
        chain.T_zero,
        joint_types="PRRRRRR",
        lower=[0.0] + [-6.0] * 6,
        upper=[0.4] + [6.0] * 6,
    )
    found = robot.redundancy(robot.fk([0.2] + [0.3] * 6), parameter=0)
    assert found.feasible(0.2)
    assert not found.feasible(0.2 + TURN)
    assert not found.feasible(0.2 - TURN)


@pytest.mark.parametrize(
    ("value", "error"),
    [(np.nan, InputError), ([0.1, 0.2], InputError), ("x", InputTypeError), (None, InputError)],
)
def test_values_that_are_none_are_refused(value, error):
    panda = cs.load_robot("panda")
    found = panda.redundancy(panda.fk([0.3, 0.4, -0.2, -1.9, 0.3, 2.1, 0.6]))
    with pytest.raises(error, match="value"):
        found.feasible(value)
    with pytest.raises(InputTypeError, match="parameter contains an ndarray"):
        panda.redundancy(found.goal, parameter=np.zeros(2))
    with pytest.raises(InputError, match="1 to 100000"):
        found.spread(10**9)


REDUNDANT = [row.name for row in cs.robots.rows() if row.dof == 7 and "P" not in row.joints]


def test_listed_configurations_of_every_redundant_arm_have_angles_within_half_a_turn():
    """Also at sampled values of the locked joint, whose limits may reach farther."""
    listed = 0
    for name in REDUNDANT:
        robot = cs.load_robot(name)
        T = robot.fk(robot.random_configuration(3, rng=5))
        batch = robot.ik(T)
        for goal in T:
            found = robot.ik(goal)
            listed += len(found)
            assert found.q.min(initial=0) > -np.pi, name
            assert found.q.max(initial=0) <= np.pi, name
            assert found.residual.max(initial=0) < 1e-9, name
            inside = found.within()
            assert len(inside) > 0, name
            assert ((inside.q >= robot.limits.lower) & (inside.q <= robot.limits.upper)).all(), name
        assert np.nanmin(batch.q) > -np.pi, name
        assert np.nanmax(batch.q) <= np.pi, name
    assert len(REDUNDANT) > 20
    assert listed > 5000
