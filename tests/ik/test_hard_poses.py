"""Singular grids, rounding noise, the border of the reach, goals at infinity: no crash, no hang, no lie."""

import os
from pathlib import Path

import numpy as np
import pytest
import tomllib

import cspace as cs
from ik.arms import ALL, FEW, is_idealised, load
from ik.geometries import CLASSES, angle_gap, random_arm, random_direction, random_pose, random_q

THOROUGH = os.environ.get("CSPACE_THOROUGH") == "1"
CASES = tomllib.loads((Path(__file__).parent.parent / "cases" / "ik.toml").read_text(encoding="utf-8"))


def expect_no_lie(robot, goals, reach=1.0):
    """Whatever is answered reaches the goal; counts and verdicts agree with each other."""
    batch = robot.ik(goals)
    residual = batch.residual
    assert np.nanmax(residual, initial=0) <= 1e-9 * max(reach, 1)
    assert ((batch.status == "unreachable") == (batch.count == 0)).all()
    is_row = np.arange(batch.q.shape[-2]) < batch.count[..., None]
    assert np.isnan(batch.q[~is_row]).all()
    real = batch.q[is_row]
    assert ((real > -np.pi) & (real <= np.pi)).all()
    return batch


@pytest.mark.parametrize("name", ALL if THOROUGH else FEW)
def test_configurations_of_right_angles(name):
    """The most singular places of every arm: joints at multiples of 90°, one step of rounding around them."""
    robot = load(name)
    rng = np.random.default_rng([1, *map(ord, name)])
    q = np.unique(rng.integers(-1, 3, (1000 if THOROUGH else 60, robot.dof)), axis=0) * (np.pi / 2)
    goals = robot.fk(q)
    batch = expect_no_lie(robot, goals)
    if is_idealised(robot):
        # Such an arm is singular only nearly, and its solutions scatter along what would be a family.
        assert (batch.count == 0).mean() < 0.1
        return
    assert (batch.count > 0).all()
    for i in np.flatnonzero(batch.status == "exact"):
        # Where several folds meet, rounding of 1e-16 moves a solution by its fourth root.
        assert angle_gap(batch.q[i, : batch.count[i]], q[i]).min() < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize("noise", [1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6])
@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900", "z1", "romeo_left_leg", "al5d"])
def test_noise_on_singular_poses(name, noise):
    robot = load(name)
    rng = np.random.default_rng(2)
    goals = robot.fk(rng.integers(-1, 3, (60, robot.dof)) * (np.pi / 2))
    goals[:, :3, 3] += noise * rng.normal(size=(60, 3))
    turn = np.eye(3) + noise * np.cross(np.eye(3), random_direction(rng))
    goals[:, :3, :3] = goals[:, :3, :3] @ np.linalg.qr(turn)[0] * np.sign(np.diag(np.linalg.qr(turn)[1]))
    goals = goals[np.linalg.det(goals[:, :3, :3]) > 0]
    expect_no_lie(robot, goals)


@pytest.mark.parametrize("name", FEW)
def test_goals_from_the_origin_to_infinity(name):
    robot = load(name)
    rng = np.random.default_rng(3)
    goals = [np.eye(4), robot.chain.T_zero]
    for size in (0.0, 1e-300, 1e-30, 1e-9, 1e3, 1e6, 1e12, 1e30, 1e60, 1e99):
        T = random_pose(rng)
        T[:3, 3] = size * random_direction(rng)
        goals.append(T)
    batch = expect_no_lie(robot, np.array(goals))
    assert (batch.count[-6:] == 0).all()
    for T in goals[-3:]:
        found = robot.ik(T)
        assert found.out_of_reach == pytest.approx(np.linalg.norm(T[:3, 3]), rel=1e-3)
        assert found.reason


@pytest.mark.parametrize("word", CLASSES.values(), ids=CLASSES)
def test_the_border_of_the_reach(word):
    """From far outside to inside along a line, by halving: never an answer is false."""
    rng = np.random.default_rng(4)
    robot = random_arm(word, rng)
    inside = robot.fk(random_q(rng, 6))
    way = 20 * random_direction(rng)
    low, high = 0.0, 1.0
    goals = []
    for _ in range(60):
        middle = 0.5 * (low + high)
        T = inside.copy()
        T[:3, 3] += middle * way
        goals.append(T)
        low, high = (middle, high) if robot.ik(T) else (low, middle)
    expect_no_lie(robot, np.array(goals), reach=20)
    assert high < 1


@pytest.mark.parametrize("name", FEW)
def test_random_goals_in_and_out_of_reach(name):
    robot = load(name)
    rng = np.random.default_rng(5)
    n = 20_000 if THOROUGH else 1_000
    goals = np.array([random_pose(rng, 1.5) for _ in range(n)])
    expect_no_lie(robot, goals, reach=1.5)


@pytest.mark.parametrize("case", CASES["found"], ids=lambda c: c["shows"])
def test_poses_that_once_went_wrong(case):
    robot = load(case["robot"])
    q = np.array(case["quarter_turns"]) * (np.pi / 2)
    found = robot.ik(robot.fk(q))
    assert found.status == case["status"]
    assert found.residual.max() < 1e-9
    if case["status"] == "exact":
        assert angle_gap(found.q, q).min() < 1e-6


def arm_of(case):
    if "robot" in case:
        return load(case["robot"])
    T_zero = np.eye(4)
    T_zero[:3, 3] = case["tip"]
    axes, points = np.array(case["axes"], dtype=float), np.array(case["points"], dtype=float)
    return cs.Robot(cs.model.from_screws(axes, points, T_zero, joint_types=case["joint_types"]))


@pytest.mark.parametrize("case", CASES["lost"], ids=lambda c: c["shows"])
def test_configurations_that_were_once_lost(case):
    robot, q = arm_of(case), np.array(case["q"])
    T = robot.fk(q)
    found = robot.ik(T)
    assert found.residual.max() < 1e-9
    if found.status == "singular":
        return
    slides = np.array([kind == "P" for kind in robot.joint_types])
    gap = np.abs(np.where(slides, found.q - q, np.angle(np.exp(1j * (found.q - q))))).max(axis=1)
    weakest = np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1]
    assert gap.min() < max(1e-5, 1e-13 / max(weakest, 1e-9))
