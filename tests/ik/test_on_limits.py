"""Configurations with joints on their limits: rounding takes none of them out, and none stays outside."""

import numpy as np
import pytest

import cspace as cs
from cspace.ik.wrapping import short_way
from cspace.model import Limits
from ik.arms import load

TURN = 2 * np.pi
LIMITED = [
    name
    for name in cs.robots.names()
    if np.isfinite([cs.load_robot(name).limits.lower, cs.load_robot(name).limits.upper]).any()
]
SETTLED = [name for name in LIMITED if cs.load_robot(name).dof <= 6]
REDUNDANT = [name for name in LIMITED if cs.load_robot(name).dof == 7]
MERGED = 6e-7
"""Two solutions on either side of a limit are one up to this distance [rad]: tolerances.DOUBLE_SOLUTION."""


def on_limits(robot, n, rng):
    """n configurations with half of the joints on a limit, each revolute joint in (−π, π], and which are."""
    lower, upper = robot.limits.lower, robot.limits.upper
    q = robot.random_configuration(n, rng=rng, reach=1.0)
    side = np.where(rng.random(q.shape) < 0.5, lower, upper)
    on = (rng.random(q.shape) < 0.5) & np.isfinite(side)
    return np.where(on, side, q), on


def distances(robot, rows, q):
    """How far each row is from a configuration, by the largest joint difference; infinite for padding."""
    gap = np.abs(short_way(rows - q, robot.joint_types)).max(axis=-1)
    return np.where(np.isnan(gap), np.inf, gap)


def is_inside(q, limits):
    return (((limits.lower <= q) & (q <= limits.upper)) | np.isnan(q)).all()


@pytest.mark.parametrize("name", SETTLED)
def test_a_configuration_on_its_limits_is_within_them(name):
    robot = load(name)
    q, _ = on_limits(robot, 30, np.random.default_rng(list(map(ord, name))))
    batch = robot.ik(robot.fk(q))
    inside = batch.within()
    assert is_inside(inside.q, robot.limits)
    assert np.nanmax(inside.residual, initial=0) < 2e-9
    for i in np.flatnonzero(batch.status == "exact"):  # a self-motion is listed by another member
        found = distances(robot, batch.q[i], q[i]).min()
        assert distances(robot, inside.q[i], q[i]).min() <= found + MERGED
        one = batch[i]
        kept = one.within()
        assert np.array_equal(kept.q, inside.q[i][: inside.count[i]])
        assert len(kept) == sum(not v for v in one.violations())
        assert not any(kept.violations())


@pytest.mark.parametrize("name", SETTLED)
def test_a_configuration_slightly_outside_is_out(name):
    """A millionth of a radian is more than rounding; where a joint may stand a turn away it is inside."""
    robot, rng = load(name), np.random.default_rng([1, *map(ord, name)])
    lower, upper = robot.limits.lower, robot.limits.upper
    q, on = on_limits(robot, 30, rng)
    turns = np.array([kind == "R" for kind in robot.joint_types])
    leaves = on & ~(turns & (upper - lower > TURN - 1e-5))
    q[leaves] += np.where(q == lower, -1e-6, 1e-6)[leaves]
    batch = robot.ik(robot.fk(q))
    inside = batch.within()
    assert is_inside(inside.q, robot.limits)
    for i in np.flatnonzero((batch.status == "exact") & leaves.any(axis=1)):
        away = distances(robot, inside.q[i], q[i])
        well_known = distances(robot, batch.q[i], q[i]).min() < 1e-8
        assert away.min() > 0.9e-6 or not well_known
        row = int(np.argmin(distances(robot, batch.q[i], q[i])))
        if well_known:
            out = batch[i].violations()[row]
            assert set(out) == {robot.joint_names[k] for k in np.flatnonzero(leaves[i])}
            np.testing.assert_allclose(list(out.values()), 1e-6, atol=2e-8)


@pytest.mark.parametrize("name", REDUNDANT)
def test_a_configuration_of_a_redundant_arm_on_its_limits_is_within_them(name):
    robot = load(name)
    q, _ = on_limits(robot, 5, np.random.default_rng(list(map(ord, name))))
    q = np.where(np.arange(7) % 2 == 0, q, robot.random_configuration(5, rng=3))  # the elbow is not stretched
    for goal in q:
        kept = robot.ik(robot.fk(goal), near=goal).within()
        assert len(kept) == 1
        assert is_inside(kept.q, robot.limits)
        assert distances(robot, kept.q, goal).min() < 1e-8
        assert not kept.violations()[0]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900", "al5d", "scara", "stanford", "planar_2r"])
@pytest.mark.parametrize("off", [0.0, 1e-15, 1e-12, 5e-10])
def test_limits_at_a_solution_keep_it_on_whichever_side_rounding_puts_it(name, off):
    """Each solution of a goal in turn is a limit of every joint, whole turns away in some of them."""
    robot, rng = load(name), np.random.default_rng([2, *map(ord, name)])
    turns = np.array([TURN if kind == "R" else 0.0 for kind in robot.joint_types])
    for goal in robot.fk(rng.uniform(-1.5, 1.5, (4, robot.dof))):
        found = robot.ik(goal)
        for row in found.q:
            corner = row + turns * rng.integers(-2, 3, robot.dof)
            width = rng.uniform(0.1, 3, robot.dof)
            for limits in (Limits(corner + off, corner + width), Limits(corner - width, corner - off)):
                for windings in (False, True):
                    kept = found.within(limits, windings=windings)
                    assert is_inside(kept.q, limits)
                    assert distances(robot, kept.q, row).min() <= off + 1e-14
                assert sum(not v for v in found.violations(limits)) == len(found.within(limits))
            for limits in (Limits(corner + 1e-6, corner + width), Limits(corner - width, corner - 1e-6)):
                kept = found.within(limits)
                assert not len(kept) or distances(robot, kept.q, row).min() > 1e-5
                assert not found.within(limits, windings=True) or len(kept)


def test_every_copy_whole_turns_away_counts_where_it_ends_on_a_limit():
    """Limits one, two and three turns wide that begin at each solution: 2, 3 and 4 copies of every joint."""
    robot = load("ur5e")
    found = robot.ik(robot.fk(np.array([0.3, -1.1, 0.9, 0.4, 0.8, -0.5])))
    for count in (1, 2):
        for row in found.q:
            limits = Limits(row - TURN, row - TURN + TURN * count)
            copies = found.within(limits, windings=True)
            assert is_inside(copies.q, limits)
            own = distances(robot, copies.q, row) < 1e-9
            assert own.sum() == (count + 1) ** 6


def test_the_puma_with_its_tool_straight_down_keeps_every_solution_on_half_a_turn():
    chain = load("puma560").chain
    half = np.full(6, 3.14159265358979)  # π as a robot file may print it, 3e-15 short
    robot = cs.Robot.from_screws(chain.axes, chain.points, chain.T_zero, lower=-half, upper=half)
    T = np.diag([1.0, -1.0, -1.0, 1.0])
    T[:3, 3] = 0.45, 0.15, -0.1
    found = robot.ik(T)
    assert len(found) == 8
    assert len(found.within()) == len(found.within(Limits(-half - 1, half + 1))) == 8
    assert not any(found.violations())


@pytest.mark.parametrize(
    ("name", "knee"), [("romeo_left_leg", 3), ("talos_left_leg", 3), ("planar_2r", 1), ("elbow", 2)]
)
def test_a_double_solution_on_its_limit_reaches_the_goal_from_there(name, knee):
    """Knees stop where the leg is straight, and there the solver knows their angles to 1e-8 alone."""
    robot, rng = load(name), np.random.default_rng(0)
    straight = rng.uniform(-0.9, 0.9, (20, robot.dof))
    straight[:, knee] = 0.0
    far = np.full(robot.dof, 3.1)
    bent = np.where(np.arange(robot.dof) == knee, 0.0, far)
    for q in straight:
        found = robot.ik(robot.fk(q))
        for limits in (Limits(-bent, far), Limits(-far, bent)):
            kept = found.within(limits)
            assert is_inside(kept.q, limits)
            assert kept.residual.max() < 1e-12
            assert distances(robot, kept.q, q).min() < MERGED
