"""fk(ik(T)) = T, and what made T is among the answers: every arm, hundreds of random geometries."""

import numpy as np
import pytest

from cspace.ik import geometry
from cspace.model import from_screws
from cspace.robot import Robot
from ik.arms import (
    ALL,
    PARALLEL,
    SHORT,
    SHOULDER,
    SPHERICAL,
    has_closed_form,
    load,
    robot_from_chain,
    shared_chains,
)
from ik.geometries import CLASSES, angle_gap, random_arm, random_pose, random_q, random_screws
from oracles.ik_many_starts import forward


def expect_roundtrip(robot, q, *, gap=1e-6, residual=1e-12):
    """Each q (k, dof) comes back from its own pose, and every answer reaches that pose."""
    c = robot.chain
    for row, T in zip(q, robot.fk(q), strict=True):
        found = robot.ik(T)
        assert found, f"{robot.name}: {found.reason} at {row.tolist()}"
        assert angle_gap(found.q, row).min() < gap, f"{robot.name} misses {row.tolist()}"
        assert ((found.q > -np.pi) & (found.q <= np.pi)).all()
        # The residual by an independent forward kinematics, beside the one that the result reports.
        R, t, _ = forward(c.axes, c.points, c.T_zero, found.q)
        size = max(1.0, np.abs(c.points).max(), np.abs(T[:3, 3]).max())
        assert np.abs(t - T[:3, 3]).max() <= residual * size
        assert np.abs(R - T[:3, :3]).max() <= residual
        assert found.residual.max() <= 2 * residual * size


def conditioned(robot, rng, n, least=1e-3):
    """n random configurations that are not near a singularity."""
    q = random_q(rng, 4 * n, robot.dof)
    J = np.array(robot.jacobian(q))
    J[:, :3] /= np.abs(robot.chain.points - robot.chain.points[0]).max() + 1e-300
    return q[np.linalg.svd(J, compute_uv=False)[:, -1] > least][:n]


@pytest.mark.parametrize("name", ALL)
def test_every_arm_of_the_catalogue(name):
    robot = load(name)
    rng = np.random.default_rng(1)
    expect_roundtrip(robot, random_q(rng, 30, robot.dof))
    expect_roundtrip(
        robot.with_base(random_pose(rng)).with_tool(random_pose(rng, 0.2)), random_q(rng, 10, robot.dof)
    )


@pytest.mark.parametrize("name", ALL)
def test_the_family_of_every_arm_is_recognised(name):
    seen = geometry(load(name))
    family = "three parallel axes" if name in PARALLEL else "spherical wrist"
    assert seen.family == family
    assert seen.reversed == (name in SHOULDER)
    assert ("locked at zero" in seen.detail) == (name in SHORT)
    assert seen.idealised < 1e-4
    if name in SPHERICAL:
        assert any(c.holds and c.text == "axes 4, 5, 6 meet in a point" for c in seen.conditions)


@pytest.mark.data
def test_every_revolute_chain_of_the_shared_data():
    solved = 0
    for row in shared_chains().values():
        robot = robot_from_chain(row)
        if robot is None or not 4 <= robot.dof <= 6 or not has_closed_form(robot):
            continue
        solved += 1
        expect_roundtrip(robot, random_q(np.random.default_rng(2), 10, robot.dof))
    assert solved >= 30


@pytest.mark.slow
@pytest.mark.parametrize("square", [False, True], ids=["any angle", "right angles"])
@pytest.mark.parametrize("name", CLASSES)
def test_random_geometries_of_each_class(name, square):
    rng = np.random.default_rng([3, *map(ord, name), square])
    for _ in range(12):
        robot = random_arm(CLASSES[name], rng, square=square)
        expect_roundtrip(robot, conditioned(robot, rng, 4), residual=1e-11)


@pytest.mark.parametrize("joints", [4, 5])
@pytest.mark.parametrize(
    "name", ["wrist_23_parallel", "wrist_12_meet", "parallel_234_56_meet", "parallel_234_ur"]
)
def test_arms_with_joints_left_out(name, joints):
    """Four and five joints of a six-joint class: fk still comes back, whichever joint is missing."""
    rng = np.random.default_rng([4, joints, *map(ord, name)])
    for left_out in range(6):
        keep = [i for i in range(6) if i != left_out][:joints]
        axes, points, T_zero = random_screws(CLASSES[name], rng)
        robot = Robot(from_screws(axes[keep], points[keep], T_zero))
        if not has_closed_form(robot):
            continue
        expect_roundtrip(robot, conditioned(robot, rng, 4, least=1e-2), residual=1e-10)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
@pytest.mark.parametrize("word", ["XPXMS", "XXXMS", "XPPXM", "XPPXX"])
def test_arms_of_any_size(word, scale):
    """Millimetres or kilometres: the same angles."""
    rng = np.random.default_rng(5)
    axes, points, T_zero = random_screws(word, rng)
    big = T_zero.copy()
    big[:3, 3] *= scale
    robot, scaled = Robot(from_screws(axes, points, T_zero)), Robot(from_screws(axes, points * scale, big))
    for T in robot.fk(conditioned(robot, rng, 6)):
        T_scaled = T.copy()
        T_scaled[:3, 3] *= scale
        expect_same_set(robot.ik(T).q, scaled.ik(T_scaled).q)


def expect_same_set(a, b, apart=1e-6):
    assert len(a) == len(b)
    for row in a:
        assert angle_gap(b, row).min() < apart


@pytest.mark.parametrize("word", CLASSES.values(), ids=CLASSES)
def test_an_axis_turned_round_changes_the_sign_of_its_angle(word):
    rng = np.random.default_rng(6)
    axes, points, T_zero = random_screws(word, rng)
    sign = rng.choice([-1.0, 1.0], len(axes))
    robot = Robot(from_screws(axes, points, T_zero))
    turned = Robot(from_screws(axes * sign[:, None], points, T_zero))
    for T in robot.fk(conditioned(robot, rng, 4)):
        expect_same_set(robot.ik(T).q, turned.ik(T).q * sign)


@pytest.mark.parametrize("word", CLASSES.values(), ids=CLASSES)
def test_points_slide_along_axes_without_effect(word):
    rng = np.random.default_rng(7)
    axes, points, T_zero = random_screws(word, rng)
    robot = Robot(from_screws(axes, points, T_zero))
    slid = Robot(from_screws(axes, points + rng.uniform(-2, 2, (len(axes), 1)) * axes, T_zero))
    for T in robot.fk(conditioned(robot, rng, 4)):
        expect_same_set(robot.ik(T).q, slid.ik(T).q)


@pytest.mark.parametrize("word", CLASSES.values(), ids=CLASSES)
def test_a_mirrored_arm_has_mirrored_solutions(word):
    """Mirrored in a plane, the axes of turning change sign as axial vectors do; the angles stay."""
    rng = np.random.default_rng(8)
    axes, points, T_zero = random_screws(word, rng)
    mirror = np.diag([1.0, -1.0, 1.0])
    image = T_zero.copy()
    image[:3, :3], image[:3, 3] = mirror @ T_zero[:3, :3] @ mirror, mirror @ T_zero[:3, 3]
    robot = Robot(from_screws(axes, points, T_zero))
    mirrored = Robot(from_screws(-axes @ mirror, points @ mirror, image))
    for T in robot.fk(conditioned(robot, rng, 4)):
        T_image = np.eye(4)
        T_image[:3, :3], T_image[:3, 3] = mirror @ T[:3, :3] @ mirror, mirror @ T[:3, 3]
        expect_same_set(robot.ik(T).q, mirrored.ik(T_image).q)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900", "romeo_left_leg", "z1"])
def test_branch_labels_tell_solutions_apart(name):
    robot = load(name)
    for T in robot.fk(random_q(np.random.default_rng(9), 50, robot.dof)):
        found = robot.ik(T)
        assert len(set(found.branch)) == len(found) == len(found.branch)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900"])
def test_a_branch_keeps_its_label_along_a_short_way(name):
    """A small step of the joints, away from singularities, changes no label."""
    robot = load(name)
    rng = np.random.default_rng(10)
    for q in conditioned(robot, rng, 20, least=0.03):
        first, then = robot.ik(robot.fk(q)), robot.ik(robot.fk(q + 1e-4))
        label = first.branch[int(np.argmin(angle_gap(first.q, q)))]
        assert then.branch[int(np.argmin(angle_gap(then.q, q + 1e-4)))] == label
