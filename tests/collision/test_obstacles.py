"""Obstacles that can be described in two ways, and those of many parts: the checks agree."""

import numpy as np
import pytest

import cspace as cs
from collision.cells import random_robot
from model.random_robots import random_pose
from oracles import collision as oracle
from shapes.solids import box_mesh

SEEDS = range(4)


def agree(robot, one, other, q):
    """Two scenes of the same solids: the same clearance, and the same verdicts away from contact."""
    a, b = robot.clearance(q, one), robot.clearance(q, other)
    np.testing.assert_allclose(a.distance, b.distance, atol=1e-9)
    sure = np.abs(a.distance) > oracle.BAND
    np.testing.assert_array_equal(robot.collides(q, one)[sure], robot.collides(q, other)[sure])
    return a.distance


@pytest.mark.parametrize("seed", SEEDS)
def test_a_box_is_its_mesh_and_its_hull(seed):
    rng, robot = np.random.default_rng(seed), random_robot(seed)
    q = robot.random_configuration(100, rng=seed, reach=1.0)
    boxes, meshes, hulls = [], [], []
    for _ in range(6):
        size, T = rng.uniform(0.1, 0.6, 3), random_pose(rng, 1.2)
        vertices, faces = box_mesh(size)
        boxes.append(cs.Box(size, T))
        meshes.append(cs.Mesh(vertices, faces, T))
        hulls.append(cs.Hull(vertices, T))
    found = agree(robot, cs.Scene(boxes), cs.Scene(meshes), q)
    agree(robot, cs.Scene(boxes), cs.Scene(hulls), q)
    assert (found < 0).any()


@pytest.mark.parametrize("seed", SEEDS)
def test_a_cloud_is_its_balls_alone_in_a_scene(seed):
    rng, robot = np.random.default_rng(seed), random_robot(seed)
    q = robot.random_configuration(100, rng=seed, reach=1.0)
    T = random_pose(rng, 0.5)
    points = rng.uniform(-1.0, 1.0, (300, 3))
    balls = [cs.Sphere(0.03, cs.transform_points(T, p)) for p in points]
    agree(robot, cs.Scene([cs.PointCloud(points, T, radius=0.03)]), cs.Scene(balls), q)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_crowded_cloud_is_its_balls(seed):
    """Places of every distance from the middle, many of them equal, and one far away."""
    rng, robot = np.random.default_rng(seed), random_robot(seed)
    q = robot.random_configuration(100, rng=seed, reach=1.0)
    points = rng.normal(size=(700, 3)) * 10.0 ** rng.uniform(-12.0, 0.0, (700, 1))
    points[rng.random(700) < 0.3] = points[0]
    points = np.concatenate([points, [[1e3, -20.0, 5.0]]])
    balls = [cs.Sphere(0.03, p) for p in points]
    agree(robot, cs.Scene([cs.PointCloud(points, radius=0.03)]), cs.Scene(balls), q)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_tree_of_many_obstacles_finds_what_parts_of_the_scene_find(seed):
    rng, robot = np.random.default_rng(seed), random_robot(seed)
    q = robot.random_configuration(200, rng=seed, reach=1.0)
    boxes = [cs.Box(rng.uniform(0.02, 0.1, 3), random_pose(rng, 1.5), name=f"box_{k}") for k in range(300)]
    boxes.append(cs.HalfSpace([0.0, 0.0, 1.0], -1.5, name="floor"))
    scene, parts = cs.Scene(boxes), [cs.Scene(boxes[k::7]) for k in range(7)]
    touching = np.any([robot.collides(q, part) for part in parts], axis=0)
    np.testing.assert_array_equal(robot.collides(q, scene), touching)
    for row, touches in zip(q[:40], touching, strict=False):
        assert robot.collides(row, scene) == touches
        end = row + 0.1 * (q[-1] - row)
        edge = robot.edge(row, end, scene)
        verdicts = [robot.edge(row, end, part).verdict for part in parts]
        assert bool(edge) == all(v == "free" for v in verdicts) or "undecided" in [edge.verdict, *verdicts]
    near = np.min([robot.clearance(q[:20], part).distance for part in parts], axis=0)
    np.testing.assert_array_equal(robot.clearance(q[:20], scene).distance, near)


def test_a_robot_inside_a_closed_surface_is_free_and_inside_its_solid_touches():
    robot = cs.load_robot("ur5e", geometry="skeleton")
    q = np.radians([0, -60, 60, -90, -90, 0])
    assert not robot.collides(q)
    vertices, faces = box_mesh([4.0, 4.0, 4.0])
    inner = box_mesh([3.0, 3.0, 3.0])[0]
    surface = cs.Mesh(vertices, faces, solid=False, name="room")
    solid = cs.Mesh(vertices, faces, name="block")
    walls = cs.Mesh(
        np.concatenate([vertices, inner]),
        np.concatenate([faces, faces[:, ::-1] + len(vertices)]),
        name="walls",
    )
    assert not robot.collides(q, cs.Scene([surface]))
    assert not robot.collides(q, cs.Scene([walls]))
    assert robot.edge(q, q + 0.1, cs.Scene([walls]))
    assert robot.collides(q, cs.Scene([solid]))
    assert robot.contact(q, cs.Scene([solid]))[1] == "block"
    assert robot.clearance(q, cs.Scene([solid])).distance < -1.0
    assert robot.collides(q, cs.Scene([walls]), margin=1.0)


def test_paths_are_planned_around_meshes_and_clouds():
    robot = cs.load_robot("planar_2r").with_spheres(
        {name: [[x, 0, 0, 0.04] for x in np.linspace(0.0, 1.0, 12)] for name in ("link_1", "link_2")}
    )
    start, goal = np.array([-1.2, 0.3]), np.array([1.2, -0.3])
    vertices, faces = box_mesh([0.3, 0.3, 1.0])
    rng = np.random.default_rng(0)
    wall = rng.uniform(-0.1, 0.1, (5000, 3)) + np.array([1.2, 0.0, 0.0])
    for obstacle in (cs.Mesh(vertices, faces, [1.2, 0.0, 0.0]), cs.PointCloud(wall, radius=0.01)):
        scene = cs.Scene([obstacle])
        assert not robot.edge(start, goal, scene)
        plan = cs.plan(robot, start, goal, scene, rng=1)
        assert plan
        for a, b in zip(plan.path[:-1], plan.path[1:], strict=True):
            assert robot.edge(a, b, scene)


@pytest.mark.parametrize("seed", SEEDS)
def test_solids_are_the_same_beside_a_mesh_out_of_reach(seed):
    """Scenes of solids alone are packed in the core, others by arrays; a mounted base counts."""
    rng = np.random.default_rng(seed)
    robot = random_robot(seed).with_base(random_pose(rng, 0.5))
    solids = [
        cs.Box(rng.uniform(0.1, 0.5, 3), random_pose(rng, 1.2)),
        cs.Sphere(0.2, rng.uniform(-1, 1, 3)),
        cs.Capsule(0.1, 0.4, random_pose(rng, 1.2)),
        cs.Cylinder(0.15, 0.5, random_pose(rng, 1.2)),
        cs.HalfSpace(rng.normal(size=3), -1.0, random_pose(rng, 0.2)),
    ]
    vertices, faces = box_mesh([0.1, 0.1, 0.1])
    scene = cs.Scene(solids)
    beside = scene.add(cs.Mesh(vertices, faces, [500.0, 0.0, 0.0]))
    q = robot.random_configuration(200, rng=seed, reach=1.0)
    np.testing.assert_array_equal(robot.collides(q, scene), robot.collides(q, beside))
    np.testing.assert_array_equal([robot.collides(row, scene) for row in q], robot.collides(q, scene))
    found, again = robot.clearance(q, scene), robot.clearance(q, beside)
    np.testing.assert_array_equal(found.distance, again.distance)
    assert found.pair == again.pair
