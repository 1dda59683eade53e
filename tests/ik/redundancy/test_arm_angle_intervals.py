"""The feasible intervals of the swivel, against the limits kept at many swivels."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError


def branches_within(robot, T, psi):
    """How many solutions at a swivel keep all limits: by the filter of results."""
    return len(robot.ik(T, swivel=psi).within(robot.limits))


@pytest.mark.parametrize("name", ["iiwa14", "openarm_left", "lwr4", "xmatepro7"])
def test_as_many_branches_as_keep_the_limits(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(4)
    for q in robot.random_configuration(6, rng=rng):
        T = robot.fk(q)
        found = robot.redundancy(T, parameter="swivel")
        assert found.parameter == "swivel"
        assert found.complete
        assert found.feasible(float(cs.ik.swivel(robot, q)))
        for psi in rng.uniform(-np.pi, np.pi, 40):
            assert len(found.feasible(psi)) == branches_within(robot, T, psi)


def test_ends_are_where_a_joint_stands_at_its_limit():
    robot = cs.load_robot("iiwa14")
    for q in robot.random_configuration(5, rng=2):
        T = robot.fk(q)
        for interval in robot.redundancy(T, parameter="swivel"):
            assert interval.lower < interval.upper
            assert np.abs(robot.fk(interval.q) - T).max() < 1e-9
            assert float(cs.ik.swivel(robot, interval.q)) in interval
            for end, value in zip(interval.ends, (interval.lower, interval.upper), strict=True):
                if not end.endswith("limit"):
                    continue
                joint = robot.joint_names.index(end.split()[0])
                limit = (robot.limits.upper if "upper" in end else robot.limits.lower)[joint]
                rows = robot.ik(T, swivel=value).q
                assert np.abs(np.sin((rows[:, joint] - limit) / 2)).min() < 1e-8


def test_without_limits_every_branch_goes_all_the_way_round():
    limited = cs.load_robot("iiwa14")
    c = limited.chain
    robot = cs.Robot.from_screws(c.axes, c.points, c.T_zero, joint_types="R" * 7)
    found = robot.redundancy(robot.fk([0.3, 0.7, -0.2, -1.2, 0.3, 0.9, 0.6]), parameter="swivel")
    assert [(i.lower, i.upper, i.ends) for i in found] == [(-np.pi, np.pi, ("nothing", "nothing"))] * 8


def test_questions_without_an_answer():
    iiwa = cs.load_robot("iiwa14")
    far = np.eye(4)
    far[0, 3] = 5.0
    assert not iiwa.redundancy(far, parameter="swivel")
    with pytest.raises(InputError, match="swivel"):
        cs.load_robot("panda").redundancy(np.eye(4), parameter="swivel")
    with pytest.raises(InputTypeError, match="locked"):
        iiwa.redundancy(np.eye(4), parameter="swivel", locked={0: 0.1})
