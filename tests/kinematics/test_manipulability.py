"""Singular values, manipulability, ellipsoids and singularities, against LAPACK and against what is known."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import from_screws
from cspace.robot import Robot
from kinematics import robots
from model.random_robots import random_pose

X, Y, Z = np.eye(3)


def spherical_wrist_arm():
    """A PUMA-like arm: shoulder, elbow, three wrist axes through one point, tip beyond it."""
    axes = [Z, Y, Y, X, Y, X]
    wrist = [0.9, 0.1, 0.8]
    points = [[0, 0, 0], [0, 0, 0.4], [0.5, 0, 0.4], wrist, wrist, wrist]
    T_zero = np.eye(4)
    T_zero[:3, 3] = [1.0, 0.1, 0.8]
    return Robot(from_screws(axes, points, T_zero, name="puma"))


@pytest.mark.parametrize("joint_types", ["R", "RR", "RPR", "RRRRR", "RRRRRR", "RRPRRRR", "R" * 9])
@pytest.mark.parametrize("rows", ["all", "linear", "angular", ("vx", "vy"), ("vy", "wz", "vx"), "wz"])
def test_singular_values_are_those_of_lapack(joint_types, rows):
    robot = robots.arm(len(joint_types), joint_types)
    q = robots.random_q(robot, np.random.default_rng(1), 50)
    names = {"all": range(6), "linear": range(3), "angular": range(3, 6)}
    words = ("vx", "vy", "vz", "wx", "wy", "wz")
    chosen = (
        names.get(rows)
        if isinstance(rows, str) and rows in names
        else [words.index(w) for w in ([rows] if isinstance(rows, str) else rows)]
    )
    J = robot.jacobian(q)[:, list(chosen)]
    expected = np.linalg.svd(J, compute_uv=False)
    got = robot.singular_values(q, rows=rows)
    np.testing.assert_allclose(got, expected, atol=5e-15)
    np.testing.assert_allclose(robot.manipulability(q, rows=rows), expected.prod(axis=-1), atol=1e-14)
    np.testing.assert_array_equal(robot.distance_to_singularity(q, rows=rows), got[:, -1])
    if len(joint_types) >= len(list(chosen)):
        volume = np.sqrt(np.maximum(np.linalg.det(J @ J.swapaxes(1, 2)), 0.0))
        np.testing.assert_allclose(robot.manipulability(q, rows=rows), volume, atol=1e-7)


@pytest.mark.parametrize("fixed", [0, 1, 3])
@pytest.mark.parametrize("rows", ["auto", "all", "linear", "angular", "vx"])
def test_a_robot_without_moving_joints_has_no_singular_values(fixed, rows):
    links = "".join(f"<link name='l{i}'/>" for i in range(fixed + 1))
    ends = "<parent link='l{}'/><child link='l{}'/>"
    joints = "".join(f"<joint name='j{i}' type='fixed'>{ends.format(i, i + 1)}</joint>" for i in range(fixed))
    robot = Robot.from_urdf(f"<robot name='post'>{links}{joints}</robot>")
    for q in ([], np.zeros((3, 0)), np.zeros((2, 3, 0))):
        shape = np.shape(q)[:-1]
        assert robot.singular_values(q, rows=rows).shape == (*shape, 0)
        np.testing.assert_array_equal(robot.manipulability(q, rows=rows), np.ones(shape))
        np.testing.assert_array_equal(robot.distance_to_singularity(q, rows=rows), np.full(shape, np.inf))
    with pytest.raises(InputError, match="no joint of post moves this frame"):
        robot.singularity([], rows=rows)


def test_small_singular_values_keep_their_digits():
    """Where q5 = ε the smallest singular value is proportional to ε, down to where a float ends."""
    robot = spherical_wrist_arm()
    q = np.array([0.3, -0.4, 0.9, 0.5, 0.0, 0.7])
    ratio = []
    for eps in (1e-3, 1e-5, 1e-7, 1e-9, 1e-11):
        q[4] = eps
        ratio.append(robot.distance_to_singularity(q) / eps)
    np.testing.assert_allclose(ratio, ratio[-1], rtol=2e-3)
    np.testing.assert_allclose(ratio[1:], ratio[-1], rtol=1e-4)


def test_the_planar_arm_is_singular_where_it_is_stretched_or_folded():
    l1, l2 = 0.8, 0.5
    robot = robots.planar(l1, l2)
    angles = np.linspace(-np.pi, np.pi, 41)
    q = np.stack(np.meshgrid(angles, angles), axis=-1)
    w = robot.manipulability(q, rows=("vx", "vy"))
    np.testing.assert_allclose(w, l1 * l2 * np.abs(np.sin(q[..., 1])), atol=1e-15)


def planar_arm(n):
    points = [[0.4 * k, 0.0, 0.0] for k in range(n)]
    T_zero = np.eye(4)
    T_zero[0, 3] = 0.4 * n
    return Robot(from_screws([Z] * n, points, T_zero, name=f"planar_{n}r"))


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 8])
def test_a_planar_arm_is_singular_where_it_is_stretched_and_nowhere_else(n):
    robot, rng = planar_arm(n), np.random.default_rng(n)
    q = rng.uniform(0.2, 1.0, (30, n))
    assert robot.singular_values(q).shape == (30, min(n, 3))
    assert robot.distance_to_singularity(q).min() > 1e-3
    assert robot.manipulability(q).min() > 1e-3
    stretched = np.zeros(n)
    stretched[0] = 0.7
    found = robot.singularity(stretched)
    assert bool(found) == (n > 1)
    assert found.rank == min(n, 3) - (n > 1)
    assert found.distance == pytest.approx(robot.distance_to_singularity(stretched), abs=1e-15)
    if n > 1:
        assert len(found.joints) <= 3
        np.testing.assert_allclose(robot.jacobian(stretched) @ found.motion, 0, atol=2e-15 if n > 2 else 1)


@pytest.mark.parametrize(
    ("joint_types", "rows", "rank"),
    [
        ("PPP", "linear", 3),
        ("RRR", "linear", 3),
        ("RP", "linear", 2),
        ("RRRR", "all", 4),
        ("R" * 7, "all", 6),
    ],
)
def test_rows_that_count_are_those_that_the_arm_can_move(joint_types, rows, rank):
    robot, rng = robots.arm(2, joint_types), np.random.default_rng(0)
    q = robots.random_q(robot, rng, 20)
    T = random_pose(rng)
    expected = robot.singular_values(q, rows=rows)[:, :rank]
    assert expected.shape == (20, rank)
    np.testing.assert_array_equal(robot.singular_values(q), expected)
    np.testing.assert_allclose(robot.singular_values(q, T_world_base=T), expected, atol=1e-14)
    np.testing.assert_allclose(robot.singular_values(q, expressed_in="tip"), expected, atol=1e-14)
    np.testing.assert_array_equal(robot.manipulability(q[3]), robot.manipulability(q)[3])
    np.testing.assert_array_equal(robot.singular_values(q, rows="auto"), robot.singular_values(q))


def test_a_robot_of_the_catalogue_is_singular_nowhere_in_general():
    rng = np.random.default_rng(2)
    for name in cs.robots.names():
        robot = cs.load_robot(name)
        for frame in robot.frames if robot.tip is None else [None, *robot.frames[-3:]]:
            q = rng.uniform(-1.2, 1.2, (5, len(robot.joint_names)))
            sigma = robot.singular_values(q, frame)
            assert robot.distance_to_singularity(q, frame).max() > 1e-4, (name, frame)
            J = robot.jacobian(q, frame)[..., robot.dof - len(robot.joint_names) :]
            assert sigma.shape[-1] <= np.linalg.matrix_rank(J).max()


def test_the_rank_is_that_of_the_point():
    """The tip lies on the last axis, the point beside it: three joints then position a point."""
    T_zero = np.eye(4)
    T_zero[:3, 3] = [0.4, 0, 0.8]
    robot = Robot(from_screws([Z, Y, X], [[0, 0, 0], [0, 0, 0.3], [0, 0, 0.8]], T_zero))
    q = np.random.default_rng(0).uniform(-1, 1, (6, 3))
    beside = np.random.default_rng(1).uniform(0.1, 0.3, (6, 3))
    assert robot.distance_to_singularity(q, point=[0.2, 0.1, 0.3]).min() > 1e-3
    assert robot.distance_to_singularity(q, point=beside).min() > 1e-3
    expected = robot.singular_values(q, point=beside, rows="linear")
    np.testing.assert_array_equal(robot.singular_values(q, point=beside), expected)
    np.testing.assert_array_equal(robot.singular_values(q), robot.singular_values(q, rows="all"))


def test_ellipsoid_holds_exactly_the_twists_of_unit_joint_velocities():
    rng = np.random.default_rng(0)
    for joint_types in ("RR", "RRRR", "RRRRRRR"):
        robot = robots.arm(3, joint_types)
        q = robots.random_q(robot, rng, 4)
        directions, radii = robot.manipulability_ellipsoid(q)
        assert directions.shape == (4, 3, 3)
        assert radii.shape == (4, 3)
        J = robot.jacobian(q)[:, :3]
        rebuilt = directions * radii[:, None] ** 2 @ directions.swapaxes(1, 2)
        np.testing.assert_allclose(rebuilt, J @ J.swapaxes(1, 2), atol=1e-14)
        np.testing.assert_allclose(
            directions @ directions.swapaxes(1, 2), np.tile(np.eye(3), (4, 1, 1)), atol=1e-14
        )


@pytest.mark.parametrize("offset", [0.0, 1e-6, 1e-3])
def test_each_singularity_of_a_wristed_arm_names_its_joints(offset):
    robot = spherical_wrist_arm()
    rng = np.random.default_rng(4)
    for _ in range(5):
        q = rng.uniform(-1, 1, 6)
        q[4] = offset
        found = robot.singularity(q)
        assert found.joints == ("joint_4", "joint_6")
        assert bool(found) == (offset == 0.0)
        assert found.distance == pytest.approx(robot.distance_to_singularity(q), rel=1e-6, abs=1e-15)
        J = robot.jacobian(q)
        np.testing.assert_allclose(np.linalg.norm(J @ found.motion), found.moves, atol=1e-15)
        np.testing.assert_allclose(np.linalg.norm(found.direction @ J), found.distance, atol=1e-14)
        assert found.rank == (5 if offset == 0.0 else 6)
        assert "joint_4 and joint_6" in str(found)


def test_a_stretched_elbow_and_a_wrist_over_the_shoulder_name_theirs():
    """Elbow: joints 2 and 3 and the wrist centre on one line; the wrist then makes good the orientation."""
    robot = spherical_wrist_arm()
    reach = np.array([0.4, 0.4])  # from elbow to wrist at zero, in x and z; the upper arm lies along x
    q = np.array([0.2, -0.3, np.arctan2(reach[1], reach[0]), 0.4, 0.8, -0.5])
    assert robot.singularity(q)
    assert {"joint_2", "joint_3"} < set(robot.singularity(q).joints)
    assert "joint_1" not in robot.singularity(q).joints
    assert robot.singularity(q, point=[-0.1, 0, 0], rows="linear").joints == ("joint_2", "joint_3")


def test_of_a_redundant_arm_only_the_joints_in_line_are_named():
    axes, points = [Z, Y, Z, Y, Z, Y, Z], np.array([[0, 0, h] for h in (0, 0.3, 0.3, 0.7, 0.7, 1.1, 1.1)])
    robot = Robot(from_screws(axes, points, random_pose(np.random.default_rng(0))))
    q = np.array([0.3, 0.7, -0.4, 0.0, 0.5, 0.6, 0.2])
    assert robot.singularity(q).joints == ("joint_3", "joint_5")
    assert not robot.singularity(q + 0.3)


def test_a_base_that_floats_does_not_hide_a_singularity():
    made = spherical_wrist_arm()
    robot = Robot(made.description, floating=True)
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.0, 0.6])
    assert robot.distance_to_singularity(q) < 1e-15
    assert robot.singularity(q, T_world_base=random_pose(np.random.default_rng(0))).joints == (
        "joint_4",
        "joint_6",
    )


def test_rows_and_batches_that_make_no_sense_are_refused():
    robot = robots.arm(1)
    with pytest.raises(UnknownNameError, match="no row 'vw' in the Jacobian; did you mean"):
        robot.manipulability(np.zeros(6), rows="vw")
    for rows in (np.array(3), 3, None):
        with pytest.raises(InputTypeError, match="rows must be names"):
            robot.manipulability(np.zeros(6), rows=rows)
    for rows in (np.eye(2), [["vx"]], [3]):
        with pytest.raises(UnknownNameError, match="in the Jacobian"):
            robot.manipulability(np.zeros(6), rows=rows)
    with pytest.raises(InputError, match="once"):
        robot.singular_values(np.zeros(6), rows=("vx", "vx"))
    with pytest.raises(InputError, match="distance_to_singularity accepts batches"):
        robot.singularity(np.zeros((3, 6)))
    with pytest.raises(InputError, match="no joint of arm 1 moves this frame"):
        robot.singularity(np.zeros(6), frame="link_0")
