"""Newton's method, motions and freedoms of closed loops."""

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.kinematics import LoopConstraints, close_loops, find_assembly_modes, follow_loops, loop_freedom
from cspace.mechanisms import FourBar
from cspace.model import Loop, mobility
from cspace.robot import Robot
from kinematics.loops import bennett, closing_loop, random_tree


@pytest.mark.parametrize("seed", range(10))
def test_loops_are_closed_near_a_closed_configuration(seed):
    """A random mechanism, disturbed at all joints, is closed again nearby."""
    rng = np.random.default_rng(seed)
    robot = Robot(random_tree(rng, 9, mimic=False))
    q = rng.uniform(-1, 1, robot.dof)
    kinds = ("spherical", "distance")
    ends = [("link_0", "link_6"), ("link_1", "link_8")]
    loops = [closing_loop(robot, q, kind, *pair, kind, rng) for kind, pair in zip(kinds, ends, strict=True)]
    constraints = LoopConstraints(robot, loops)
    found = close_loops(constraints, near=q + rng.normal(size=q.size) * 0.01, starts=0)
    assert found
    assert found.reason == "closed"
    assert np.linalg.norm(constraints.residual(found.q)) < 1e-12
    assert np.abs(found.q - q).max() < 0.5


def test_a_bennett_linkage_moves_though_its_mobility_is_negative():
    robot = bennett()
    assert mobility(robot.description) == -2
    constraints = LoopConstraints(robot, robot.description.loops)
    modes = find_assembly_modes(constraints, {"pin_0": 0.8}, starts=100)
    assert modes
    assert not modes.complete
    for q in modes.q:
        freedom = loop_freedom(constraints, q)
        assert (freedom.dof, freedom.rank, freedom.rows) == (1, 2, 5)
        assert len(freedom.dependent) == 3
    motion = follow_loops(constraints, {"pin_0": np.linspace(0.8, 0.8 + 2 * np.pi, 200)}, modes.q[0])
    assert motion
    assert np.abs(constraints.residual(motion.q)).max() < 1e-12
    steps = np.abs(np.diff(motion.q, axis=0)).max()
    assert steps < 0.5
    # Opposite angles of a Bennett linkage are opposite.
    np.testing.assert_allclose(np.cos(motion.q[:, 0]), np.cos(motion.q[:, 2]), atol=1e-9)


def test_rows_that_repeat_others_are_named():
    robot = bennett()
    loop = robot.description.loops[0]
    twice = Loop("again", "spherical", loop.parent, loop.child, loop.origin, loop.child_origin)
    both, one = LoopConstraints(robot, [loop, twice]), LoopConstraints(robot, [loop])
    q = find_assembly_modes(one, {"pin_0": 0.8}, starts=50).q[0]
    freedom = loop_freedom(both, q)
    assert freedom.dof == 1
    assert len(freedom.dependent) == 6
    assert all(f"again.{c}" in freedom.dependent for c in "xyz")


def test_what_cannot_be_closed_says_what_is_missing():
    """Two bars of 1 m cannot reach a point 2.5 m away: half a metre is missing."""
    rng = np.random.default_rng(0)
    from cspace.model import Description, Joint, Link

    joints = [
        Joint("one", "continuous", "base", "upper", axis=(0, 0, 1)),
        Joint("two", "continuous", "upper", "lower", axis=(0, 0, 1), origin=shift(1.0)),
    ]
    arm = Robot(Description("arm", (Link("base"), Link("upper"), Link("lower")), tuple(joints)))
    far = Loop("hook", "spherical", "lower", "base", shift(1.0), shift(2.5))
    answer = close_loops(LoopConstraints(arm, [far]), near=rng.normal(size=2))
    assert not answer
    assert answer.gap == pytest.approx(0.5, abs=1e-9)
    assert answer.reason.startswith("impossible: loop 'hook' stays open, 0.5")
    edge = Loop("hook", "spherical", "lower", "base", shift(1.0), shift(2.0))
    stretched = close_loops(LoopConstraints(arm, [edge]), near=[0.3, 0.2])
    assert stretched
    assert stretched.singular
    assert stretched.reason.startswith("singular")
    many = close_loops(LoopConstraints(arm, [edge]), {"one": [0.0, 0.1]}, near=[0.3, 0.2])
    assert many.closed.tolist() == [True, False]
    assert many.reason.endswith("in row 1")


def shift(x):
    T = np.eye(4)
    T[0, 3] = x
    return T


def test_bad_input():
    robot = bennett()
    constraints = LoopConstraints(robot, robot.description.loops)
    with pytest.raises(UnknownNameError, match="no joint 'pin_9' in bennett"):
        close_loops(constraints, {"pin_9": 0.1})
    with pytest.raises(InputTypeError, match="expected a dict"):
        close_loops(constraints, [0.1])
    with pytest.raises(InputError, match="nan"):
        close_loops(constraints, {"pin_0": np.nan})
    with pytest.raises(InputError, match=r"near has shape \(2,\)"):
        close_loops(constraints, near=[0, 0])
    with pytest.raises(InputError, match=r"expected \(k,\)"):
        follow_loops(constraints, {"pin_0": 0.8}, [0, 0, 0])
    with pytest.raises(InputError, match="start cannot be closed"):
        follow_loops(constraints, {"pin_0": [0.8], "pin_1": [2.0]}, [0.8, 2, 0])
    with pytest.raises(InputError, match="one number each"):
        find_assembly_modes(constraints, {"pin_0": [0.1, 0.2]})


@pytest.mark.parametrize("turns", [2.0, 8.0])
def test_long_ways_between_two_values_are_no_dead_points(turns):
    """A crank that may turn for ever arrives however far the next value is; beyond any computation the time
    limit ends it."""
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    start = linkage.assembly_modes({"crank": 0.5}).q[0]
    motion = linkage.follow({"crank": [0.5, 0.5 + 2 * np.pi * turns]}, start)
    assert motion
    np.testing.assert_allclose(np.remainder(motion.q[-1] - start + 1, 2 * np.pi), 1, atol=1e-6)
    for far in (1e7, 1e12):
        endless = linkage.follow({"crank": [0.5, far]}, start, time_limit=0.05)
        assert not endless
        assert endless.reason == "time limit"
        assert endless.stop[0] > 0.5
