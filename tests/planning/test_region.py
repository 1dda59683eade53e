"""Regions of poses as goals: samples, membership, and plans that end inside."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.planning import Region
from cspace.planning.region import rotations_within

SEEDS = range(6)
LOOSE = 1e-8
"""By how much the plain check below may differ from the library's [m, rad]."""


def plain_excess(region, T, size, T_box, direction, axis, angle):
    """How far a pose is outside a region [m, rad], by other formulas than the library's."""
    p = np.linalg.solve(T_box, [*T[:3, 3], 1.0])[:3]
    away = max(0.0, *(np.abs(p) - np.asarray(size) / 2))
    tilt = np.arccos(np.clip((T[:3, :3] @ axis) @ direction, -1, 1))
    return away, max(0.0, tilt - angle)


def random_parts(rng):
    """Size, pose, direction, axis and angle of a region in front of an arm."""
    unit = rng.normal(size=(2, 3))
    unit /= np.linalg.norm(unit, axis=1)[:, None]
    T = cs.pose([0.45, rng.uniform(-0.2, 0.2), 0.45], rpy=rng.uniform(-3, 3, 3))
    return rng.uniform(0.01, 0.2, 3), T, *unit, rng.uniform(0.05, 1.5)


@pytest.mark.parametrize("seed", SEEDS)
def test_samples_fill_the_region_and_nothing_else(seed):
    size, T_box, direction, axis, angle = parts = random_parts(np.random.default_rng(seed))
    region = Region((size, T_box), axis, direction, within=angle)
    poses = region.sample(0, 2000)
    assert region.contains(poses).all()
    for T in poses[::50]:
        assert max(plain_excess(region, T, *parts)) < LOOSE
    p = (np.linalg.inv(T_box) @ poses)[:, :3, 3] / size
    np.testing.assert_allclose(np.abs(p).max(axis=0), 0.5, atol=2e-3)
    np.testing.assert_allclose(p.mean(axis=0), 0.0, atol=5e-3)
    height = 1.0 - (poses[:, :3, :3] @ axis) @ direction  # uniform over a cone: of areas of a sphere
    np.testing.assert_allclose(
        np.quantile(height / (1.0 - np.cos(angle)), [0.25, 0.5, 0.75]), [0.25, 0.5, 0.75], atol=5e-3
    )
    np.testing.assert_array_equal(region.sample(700, 300), poses[700:1000])


@pytest.mark.parametrize("seed", SEEDS)
def test_membership_agrees_with_plain_formulas(seed):
    rng = np.random.default_rng(seed)
    size, T_box, direction, axis, angle = parts = random_parts(rng)
    region = Region((size, T_box), axis, direction, within=angle)
    wide = Region((1.5 * size, T_box), axis, direction, within=min(1.3 * angle, np.pi))
    poses = wide.sample(0, 500)
    inside = region.contains(poses)
    assert 10 < inside.sum() < 490
    for T, verdict in zip(poses, inside, strict=True):
        excess = max(plain_excess(region, T, *parts))
        assert verdict == (excess == 0.0) or excess < LOOSE


@pytest.mark.parametrize("angle", [1e-6, 1e-3, 0.3, np.pi])
def test_turns_are_uniform_within_an_angle(angle):
    u = np.random.default_rng(1).random((4000, 3))
    turns = np.linalg.norm(cs.log_so3(rotations_within(u, angle)), axis=-1)
    assert turns.max() <= angle * (1 + 1e-9) + 1e-12
    share = turns**3 / angle**3 if angle < 0.01 else (turns - np.sin(turns)) / (angle - np.sin(angle))
    np.testing.assert_allclose(np.sort(share), np.sort(u[:, 2]), atol=1e-4)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_a_plan_ends_in_the_region(name, seed):
    robot = cs.load_robot(name, geometry="skeleton")
    size, T_box, direction, axis, angle = parts = random_parts(np.random.default_rng(seed))
    scene = cs.Scene([cs.HalfSpace(offset=-0.3, name="floor"), cs.Sphere(0.05, T_box[:3, 3] + [0, 0, 0.2])])
    start = robot.random_configuration(400, rng=seed)
    start = start[~robot.collides(start, scene)][0]
    region = Region((size, T_box), axis, direction, within=angle)
    plan = cs.plan(robot, start, region, scene)
    if not plan:
        assert plan.status == "undetermined"
        return
    assert max(plain_excess(region, robot.fk(plan.path[-1]), *parts)) < LOOSE
    assert region.contains(robot.fk(plan.path[-1]))
    assert plan.certified
    assert not robot.collides(plan.path, scene).any()
    again = cs.plan(robot, start, region, scene)
    np.testing.assert_array_equal(again.path, plan.path)
    many = cs.plan_many(robot, start, [region, region], scene)
    np.testing.assert_array_equal(many[1].path, plan.path)


@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_a_region_of_size_zero_is_the_pose_or_the_partial_goal(name):
    robot = cs.load_robot(name, geometry="skeleton")
    T = cs.pose([0.4, 0.2, 0.4], rpy=[np.pi, 0, 0])
    start = robot.random_configuration(400, rng=2)
    start = start[~robot.collides(start)][0]
    zero, p, down = [0, 0, 0], T[:3, 3], [0, 0, -1]
    pairs = [
        (Region((zero, T), rotation=T[:3, :3]), T),
        (Region((zero, p), direction=down), {"position": p, "direction": down}),
        (Region((zero, p), axis="-x", direction=down), {"position": p, "direction": down, "tool_axis": "-x"}),
        (Region((zero, p)), {"position": p}),
        (Region(direction=down), {"direction": down}),
        (Region(rotation=T[:3, :3]), {"rotation": T[:3, :3]}),
    ]
    for region, goal in pairs:
        ours, theirs = cs.plan(robot, start, region), cs.plan(robot, start, goal)
        assert ours
        assert region.contains(robot.fk(ours.path[-1]))
        np.testing.assert_allclose(ours.path, theirs.path, atol=1e-9)


def test_a_region_without_a_free_configuration_is_undetermined_with_counts():
    robot = cs.load_robot("ur5e", geometry="skeleton")
    start = np.radians([-60, -80, 90, -100, -90, 0])
    far = cs.plan(robot, start, Region(([0.1, 0.1, 0.1], [3.0, 0, 0])))
    assert far.status == "undetermined"
    assert "of 4096 poses that meet the goal 4096 have no IK solution, 0 none within limits" in far.reason
    wall = cs.Box([0.3, 0.3, 0.3], [0.5, 0.3, 0.5], name="wall")
    inside = cs.plan(robot, start, Region(([0.1, 0.1, 0.1], wall.pose)), cs.Scene([wall]))
    assert inside.status == "undetermined"
    assert "configurations of the others touch something: " in inside.reason
    assert "wall" in inside.reason


def test_arms_with_fewer_joints_reach_regions_by_position():
    robot = cs.load_robot("planar_3r", geometry="skeleton") if "planar_3r" in cs.robots.names() else None
    robot = robot or cs.load_robot("planar_2r", geometry="skeleton")
    region = Region(([0.2, 0.2, 0.0], [0.8, 0.9, 0.0]))
    plan = cs.plan(robot, np.full(robot.dof, 0.2), region)
    assert plan
    assert region.contains(robot.fk(plan.path[-1]))


def test_faults_are_named():
    with pytest.raises(InputTypeError, match="needs a box="):
        Region()
    with pytest.raises(InputTypeError, match="not both"):
        Region(direction=[0, 0, 1], rotation=np.eye(3))
    with pytest.raises(InputTypeError, match="needs direction= or rotation="):
        Region(([1, 1, 1], [0, 0, 0]), within=0.1)
    with pytest.raises(InputTypeError, match="axis= of a Region needs direction="):
        Region(([1, 1, 1], [0, 0, 0]), axis="x")
    with pytest.raises(InputTypeError, match="it must be a pair"):
        Region([1, 1, 1])
    with pytest.raises(InputError, match="no edge may be negative"):
        Region(([1, -1, 1], [0, 0, 0]))
    with pytest.raises(InputError, match="within"):
        Region(direction=[0, 0, 1], within=4.0)
    with pytest.raises(InputError, match="direction is zero"):
        Region(direction=[0, 0, 0])
    with pytest.raises(InputError, match="axis is 'w'"):
        Region(direction=[0, 0, 1], axis="w")
    with pytest.raises(InputTypeError, match=r"cs\.planning\.Region"):
        cs.plan(cs.load_robot("ur5e", geometry="skeleton"), np.zeros(6), 3.0)
