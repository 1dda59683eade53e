"""Closed forms of the ready-made mechanisms against Newton's method, on random geometries."""

import numpy as np
import pytest

from cspace import pose
from cspace.errors import InputError, UnknownNameError
from cspace.mechanisms import Delta, FourBar, SliderCrank, Stewart
from cspace.mechanisms.platform import PLATFORM, find_platform_angles

LENGTHS = [f"length_{i + 1}" for i in range(6)]


def is_closed(mechanism, q):
    return np.abs(mechanism.residual(q)).max(initial=0.0) < 1e-13 * max(1, mechanism.constraints.length) * 10


def agrees_with_search(mechanism, driven, starts=60):
    """The closed form and the search find the same configurations, or the same gap."""
    ours = mechanism.assembly_modes(driven)
    theirs = super(type(mechanism), mechanism).assembly_modes(driven, starts=starts)
    assert ours.complete
    assert not theirs.complete
    assert len(ours) == len(theirs)
    if not ours:
        assert theirs.gap > 0
        return ours
    assert is_closed(mechanism, ours.q)
    turns = np.array([kind == "R" for kind in mechanism.robot.joint_types])
    for q in theirs.q:
        apart = np.where(turns, 2 * np.sin((ours.q - q) / 2), ours.q - q)
        assert np.abs(apart).max(axis=1).min() < 1e-6
    return ours


@pytest.mark.parametrize("seed", range(12))
def test_four_bars(seed):
    rng = np.random.default_rng(seed)
    linkage = FourBar(*rng.uniform(0.2, 1.2, 4))
    for name in linkage.joint_names:
        found = agrees_with_search(linkage, {name: rng.uniform(-3, 3)})
        assert len(found) in (0, 2)
    assert linkage.mobility(dimension=2) == 1
    assert linkage.mobility() == -2


@pytest.mark.parametrize("seed", range(8))
def test_slider_cranks(seed):
    rng = np.random.default_rng(seed)
    engine = SliderCrank(*rng.uniform(0.2, 1.2, 2), offset=rng.uniform(-0.3, 0.3))
    for name in ("crank", "rod"):
        agrees_with_search(engine, {name: rng.uniform(-3, 3)})
    agrees_with_search(engine, {"slider": rng.uniform(-1.5, 1.5)})


def test_gaps_of_planar_linkages():
    """What is missing is the distance by which the circles do not meet."""
    linkage = FourBar(2.0, 0.3, 0.4, 0.5)
    answer = linkage.assembly_modes({"crank": 0.0})
    assert not answer
    assert answer.gap == pytest.approx(1.7 - 0.9)
    assert answer.reason == "impossible: loop 'pin' stays open, 0.8 m are missing"
    search = linkage.close({"crank": 0.0})
    assert not search
    assert search.gap == pytest.approx(0.8, abs=1e-9)
    engine = SliderCrank(1.0, 0.4)
    assert engine.assembly_modes({"crank": np.pi / 2}).gap == pytest.approx(0.6)
    assert engine.assembly_modes({"slider": 2.0}).gap == pytest.approx(0.6)
    assert engine.assembly_modes({"slider": 0.1}).gap == pytest.approx(0.5)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_dead_points_of_four_bars(seed):
    """There the two configurations become one, and beyond there is none."""
    rng = np.random.default_rng(seed)
    linkage = FourBar(*rng.uniform(0.3, 1.0, 4))
    for name in ("crank", "rocker"):
        index = linkage.joint_names.index(name)
        rows = linkage.dead_points(name)
        turns = np.linspace(-np.pi, np.pi, 721)[:-1]
        counts = np.array([len(linkage.assembly_modes({name: turn})) for turn in turns])
        assert np.count_nonzero(np.diff(counts, append=counts[0])) == len(rows)
        for q in rows:
            assert is_closed(linkage, q)
            beside = [len(linkage.assembly_modes({name: q[index] + d})) for d in (-1e-5, 1e-5)]
            assert sorted(beside) == [0, 2]
            assert linkage.close({name: q[index]}, near=q, starts=0).singular


@pytest.mark.parametrize(
    ("lengths", "kind"),
    [
        ((1.0, 0.3, 0.9, 0.7), "crank-rocker"),
        ((1.0, 0.7, 0.9, 0.3), "rocker-crank"),
        ((0.3, 1.0, 0.9, 0.7), "double-crank"),
        ((0.9, 0.7, 0.3, 1.0), "double-rocker"),
        ((1.0, 0.5, 0.5, 0.9), "triple-rocker"),
        ((1.0, 0.5, 1.0, 0.5), "change-point"),
    ],
)
def test_grashofs_law(lengths, kind):
    linkage = FourBar(*lengths)
    assert linkage.kind == kind
    turns = np.linspace(-np.pi, np.pi, 360)
    full = {
        name: all(linkage.assembly_modes({name: turn}) for turn in turns)
        for name in ("crank", "rocker", "coupler")
    }
    expected = {
        "crank-rocker": {"crank", "coupler"},
        "rocker-crank": {"rocker"},
        "double-crank": {"crank", "rocker"},
        "triple-rocker": set(),
    }.get(kind)
    if expected is not None:
        assert {name for name in ("crank", "rocker") if full[name]} == expected - {"coupler"}


def test_a_four_bar_over_a_full_turn():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    start = linkage.assembly_modes({"crank": 0.0}).q[0]
    turns = np.linspace(0, 2 * np.pi, 181)
    motion = linkage.follow({"crank": turns}, start)
    assert motion
    assert np.abs(linkage.residual(motion.q)).max() < 1e-12
    np.testing.assert_allclose(motion.q[-1, 2], motion.q[0, 2], atol=1e-12)
    for turn, q in zip(turns, motion.q, strict=True):  # on one of the two closed forms, always the same
        both = linkage.assembly_modes({"crank": turn}).q
        np.testing.assert_allclose(np.cos(both[0] - q), 1, atol=1e-12)
    # The rocker turns back at its dead points.
    ends = linkage.dead_points("rocker")[:, 2]
    inside = ends[ends > 0]
    assert motion.q[:, 2].min() == pytest.approx(inside.min(), abs=1e-3)
    assert motion.q[:, 2].max() == pytest.approx(inside.max(), abs=1e-3)
    stuck = linkage.follow({"rocker": np.linspace(start[2], start[2] + 3, 50)}, start)
    assert not stuck
    assert stuck.reason.startswith("dead point: the motion cannot go on beyond rocker = ")
    assert stuck.stop[2] == pytest.approx(inside.max(), abs=1e-6)
    assert linkage.follow({"crank": [start[0]]}, start)


@pytest.mark.parametrize("seed", range(6))
def test_deltas(seed):
    rng = np.random.default_rng(seed)
    robot = Delta(
        rng.uniform(0.15, 0.3), rng.uniform(0.03, 0.1), rng.uniform(0.2, 0.4), rng.uniform(0.5, 0.9)
    )
    place = {"x": rng.uniform(-0.1, 0.1), "y": rng.uniform(-0.1, 0.1), "z": -0.6}
    inverse = robot.assembly_modes(place)
    assert inverse.complete
    assert len(inverse) in (0, 8)
    if not inverse:
        assert inverse.gap > 0
        return
    assert is_closed(robot, inverse.q)
    assert robot.dof(inverse.q[0]) == robot.mobility() == 3
    out = np.cos(inverse.q[:, :3]).sum(axis=1)
    assert out[0] == out.max()
    for q in inverse.q:
        forward = robot.assembly_modes(dict(zip(("arm_1", "arm_2", "arm_3"), q[:3], strict=True)))
        assert len(forward) == 2
        assert is_closed(robot, forward.q)
        assert np.abs(forward.q - q).max(axis=1).min() < 1e-9
        assert forward.q[0, 5] <= forward.q[1, 5]
    # Newton's method finds the same from beside.
    near = inverse.q[0] + rng.normal(size=9) * 0.02
    found = robot.close(place, near=near)
    np.testing.assert_allclose(found.q, inverse.q[0], atol=1e-8)


def test_a_delta_out_of_reach():
    robot = Delta(0.2, 0.05, 0.25, 0.6)
    answer = robot.assembly_modes({"x": 0, "y": 0, "z": -1.0})
    assert not answer
    nearest = np.hypot(0.15, 1.0) - 0.85
    assert answer.gap == pytest.approx(nearest)
    assert "rod_1a" in answer.reason
    short = Delta(1.0, 0.05, 0.25, 0.6)
    forward = short.assembly_modes({"arm_1": 0, "arm_2": 0, "arm_3": 0})
    assert not forward
    assert forward.gap == pytest.approx(0.95 + 0.25 - 0.6)


@pytest.mark.parametrize("seed", range(6))
def test_stewart_platforms(seed):
    rng = np.random.default_rng(seed)
    base, top = rng.normal(size=(2, 6, 3)) * [0.5, 0.5, 0.05]
    platform = Stewart(base, 0.6 * top, 0.8)
    T = pose(rng.uniform(-0.1, 0.1, 3) + np.array([0, 0, 0.8]), rpy=rng.uniform(-0.3, 0.3, 3))
    inverse = platform.assembly_modes(platform.pose_coordinates(T))
    assert inverse.complete
    assert len(inverse) == 1
    q = inverse.q[0]
    assert is_closed(platform, q)
    np.testing.assert_allclose(platform.robot.fk(q, "platform"), T, atol=1e-12)
    legs = (0.6 * top) @ T[:3, :3].T + T[:3, 3] - base
    np.testing.assert_allclose(q[2:18:3], np.linalg.norm(legs, axis=1), atol=1e-12)
    assert platform.dof(q) == platform.mobility() == 6
    lengths = dict(zip(LENGTHS, q[2:18:3], strict=True))
    forward = platform.assembly_modes(lengths, starts=60)
    assert not forward.complete
    assert 1 <= len(forward) <= 40
    assert is_closed(platform, forward.q)
    poses = platform.robot.fk(forward.q, "platform")
    assert np.abs(poses - T).max(axis=(1, 2)).min() < 1e-6
    found = platform.close(lengths, near=q + rng.normal(size=24) * 0.01, starts=0)
    np.testing.assert_allclose(found.q[-6:], q[-6:], atol=1e-8)


def test_a_stewart_platform_with_impossible_legs():
    platform = Stewart.of_radii(0.5, 0.3, 0.6)
    answer = platform.assembly_modes(dict(zip(LENGTHS, (0.1, 5, 1, 1, 1, 1), strict=True)), starts=20)
    assert not answer
    assert not answer.complete
    assert answer.reason.startswith("impossible: loop 'ball_")
    assert len(platform.home) == 6
    home = platform.assembly_modes(dict(zip(PLATFORM, platform.home, strict=True))).q[0]
    np.testing.assert_allclose(home[0:18:3], 0, atol=1e-15)
    np.testing.assert_allclose(home[1:18:3], 0, atol=1e-15)


def test_a_continuum_is_not_called_complete():
    """Links of equal lengths that fold onto each other leave a circle of configurations."""
    rhombus = FourBar(1.0, 1.0, 0.5, 0.5)
    folded = rhombus.assembly_modes({"crank": 0.0})
    assert folded
    assert not folded.complete
    assert folded.reason.startswith("singular: infinitely many")
    assert is_closed(rhombus, folded.q)
    assert rhombus.assembly_modes({"crank": 0.1}).complete
    engine = SliderCrank(0.5, 0.5)
    assert not engine.assembly_modes({"slider": 0.0}).complete
    assert not engine.assembly_modes({"rod": np.pi}).complete
    assert engine.assembly_modes({"slider": 1.0}).complete  # a dead point is one configuration
    delta = Delta(0.2, 0.2, 0.25, 0.6)
    straight = delta.assembly_modes(dict.fromkeys(("arm_1", "arm_2", "arm_3"), np.pi / 2))
    assert straight
    assert not straight.complete
    assert is_closed(delta, straight.q)
    pair = delta.assembly_modes({"arm_1": np.pi / 2, "arm_2": np.pi / 2, "arm_3": 0.3})
    assert not pair.complete
    assert is_closed(delta, pair.q)


def test_platform_angles():
    rng = np.random.default_rng(0)
    platform = Stewart.of_radii(0.5, 0.3, 0.6)
    for _ in range(50):
        T = pose((0, 0, 0), rpy=rng.uniform(-3, 3, 3))
        q = np.concatenate([np.zeros(21), find_platform_angles(T[:3, :3])])
        np.testing.assert_allclose(platform.robot.fk(q, "platform"), T, atol=1e-12)
    upright = pose((0, 0, 0), rpy=(0.4, np.pi / 2, 0))
    q = np.concatenate([np.zeros(21), find_platform_angles(upright[:3, :3])])
    np.testing.assert_allclose(platform.robot.fk(q, "platform"), upright, atol=1e-12)


def test_bad_input():
    with pytest.raises(InputError, match="crank is -1"):
        FourBar(1, -1, 1, 1)
    with pytest.raises(InputError, match="nan"):
        SliderCrank(1, np.nan)
    with pytest.raises(InputError, match=r"base_points has shape \(5, 3\)"):
        Stewart(np.zeros((5, 3)), np.zeros((6, 3)), 1)
    with pytest.raises(InputError, match="a leg has length 0"):
        Stewart(np.tile([0, 0, 1.0], (6, 1)), np.zeros((6, 3)), 1)
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    with pytest.raises(UnknownNameError, match="no driven link 'coupler'"):
        linkage.dead_points("coupler")
    with pytest.raises(UnknownNameError, match="no joint 'cranck' in four_bar; did you mean 'crank'"):
        linkage.assembly_modes({"cranck": 0.3})
