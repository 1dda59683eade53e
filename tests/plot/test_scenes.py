"""Robots among obstacles and planned motions: everything is where it is, and nothing hides the arm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.collision import clearance
from cspace.errors import InputError, InputTypeError
from cspace.planning import ArmSpace
from cspace.plot import colors
from cspace.plot.obstacles import MOST_FACES, MOST_POINTS, Blockers, bodies_of, plate_of
from cspace.plot.plans import equal_steps
from cspace.plot.raytrace.solids import Facets, Solid
from cspace.plot.raytrace.view import look_along
from cspace.plot.skeleton import make_skeleton
from cspace.shapes import HeightField, Hull, Mesh, PointCloud
from plot import arms

plt = pytest.importorskip("matplotlib.pyplot")

GREY = np.full(3, 0.5)
AROUND = np.array([[-1.0] * 3, [1.0] * 3])
UP = np.radians([0, -120, 60, -90, -90, 0])


@pytest.fixture(scope="module")
def ur5e() -> cs.Robot:
    return cs.load_robot("ur5e", geometry="skeleton")


def table(*more) -> cs.Scene:
    return cs.Scene([cs.Box([0.8, 1.2, 0.04], [0.6, 0.0, -0.1], name="table"), *more])


def solids_in(artists: list) -> list:
    return [body for group in artists[0].scene.groups for body in group.solids]


def random_place(rng: np.random.Generator) -> np.ndarray:
    return cs.pose(rng.uniform(-0.5, 0.5, 3), rpy=rng.uniform(-3, 3, 3))


def torus(n: int = 24, m: int = 12) -> tuple[np.ndarray, list[list[int]]]:
    u, v = np.meshgrid(*(np.linspace(0, 2 * np.pi, k, endpoint=False) for k in (n, m)), indexing="ij")
    reach = 0.3 + 0.1 * np.cos(v)
    vertices = np.stack([reach * np.cos(u), reach * np.sin(u), 0.1 * np.sin(v)], axis=-1).reshape(-1, 3)
    faces = []
    for i in range(n):
        for j in range(m):
            a, b, c, d = (((i + k) % n) * m + (j + h) % m for k, h in ((0, 0), (1, 0), (1, 1), (0, 1)))
            faces += [[a, b, c], [a, c, d]]
    return vertices, faces


SHAPES = {
    "box": lambda T, rng: cs.Box(rng.uniform(0.1, 0.6, 3), T),
    "sphere": lambda T, rng: cs.Sphere(0.2, T),
    "capsule": lambda T, rng: cs.Capsule(0.1, 0.4, T),
    "cylinder": lambda T, rng: cs.Cylinder(0.1, 0.4, T),
    "hull": lambda T, rng: Hull(rng.uniform(-0.3, 0.3, (12, 3)), T),
    "mesh": lambda T, rng: Mesh(*torus(), T),
    "cloud": lambda T, rng: PointCloud(rng.uniform(-0.3, 0.3, (30, 3)), T, radius=0.05),
    "field": lambda T, rng: HeightField(rng.uniform(0, 0.2, (5, 7)), [0.5, 0.6], T, bottom=-0.1),
}


def surface_points(body) -> np.ndarray:
    """Points on a body: corners and middles of its facets, or around its ends."""
    if isinstance(body, Facets):
        return np.concatenate([[*corners, corners.mean(axis=0)] for corners in body.polygons])
    axis = body.b - body.a
    length = np.linalg.norm(axis)
    axis = axis / length if length else np.array([0.0, 0.0, 1.0])
    aside = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    aside /= np.linalg.norm(aside)
    return np.array([body.a + body.radius_a * aside, body.b - body.radius_b * aside])


@pytest.mark.parametrize("kind", SHAPES)
def test_bodies_lie_on_the_surface_of_their_shape(kind):
    rng = np.random.default_rng(4)
    for _ in range(3):
        shape = SHAPES[kind](random_place(rng), rng)
        points = np.concatenate([surface_points(body) for body in bodies_of(shape, GREY, AROUND)])
        away = shape.distance(points)
        assert np.abs(away).max() < 1e-9 if kind != "cloud" else away.max() < 1e-9


def test_facets_face_outwards():
    rng = np.random.default_rng(5)
    for kind in ("box", "hull", "mesh", "field"):
        shape = SHAPES[kind](random_place(rng), rng)
        for corners in bodies_of(shape, GREY, AROUND)[0].polygons:
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            outside = corners.mean(axis=0) + 1e-4 * normal / np.linalg.norm(normal)
            assert shape.distance(outside) > 0


@pytest.mark.slow
def test_large_shapes_are_thinned():
    rng = np.random.default_rng(6)
    assert len(bodies_of(PointCloud(rng.normal(size=(20000, 3))), GREY, AROUND)) == MOST_POINTS
    [hull] = bodies_of(Mesh(*torus(80, 40)), GREY, AROUND)
    assert len(hull.polygons) < MOST_FACES < 2 * 80 * 40
    [field] = bodies_of(HeightField(rng.uniform(size=(300, 300)), [1, 1]), GREY, AROUND)
    assert len(field.polygons) < 1.2 * MOST_FACES
    vertices, faces = torus()
    [sheet] = bodies_of(Mesh(vertices, faces[:40], solid=False), GREY, AROUND)
    assert len(sheet.polygons) == 80, "an open surface has two sides"


def test_a_half_space_is_the_floor_or_a_plate():
    floor = cs.HalfSpace(offset=-0.3)
    assert bodies_of(floor, GREY, AROUND) == []
    artists = plot.scene(cs.Scene([floor]), arms.elbow_arm(), np.zeros(6))
    assert artists[0].scene.floor.center[2] == -0.3
    wall = cs.HalfSpace([1.0, 0.5, 0.2], -0.7)
    corners = plate_of(wall, AROUND)
    np.testing.assert_allclose(wall.distance(corners), 0.0, atol=1e-12)
    assert np.cross(corners[1] - corners[0], corners[2] - corners[0]) @ wall.plane[:3] > 0


def test_hidden_points_are_those_that_rays_say():
    rng = np.random.default_rng(7)
    shapes = [cs.Box(rng.uniform(0.1, 0.6, 3), random_place(rng)) for _ in range(4)]
    points = rng.uniform(-1, 1, (60, 3))
    for elevation, azimuth in rng.uniform([10, -180], [50, 180], (5, 2)):
        eye = look_along(elevation, azimuth)[2]
        along = points[:, None] + np.linspace(0, 4, 4001)[:, None] * eye
        deep = np.array([shape.distance(along).min(axis=1) for shape in shapes])
        hides = Blockers(shapes).hide(points, eye)
        sure = np.abs(deep) > 2e-3
        assert (hides == (deep < 0))[sure].all()
        assert Blockers(shapes).hidden_share(points, eye) == pytest.approx(hides.any(axis=0).mean())


def test_a_view_is_chosen_from_which_the_arm_is_seen(ur5e):
    walls = [cs.Box([0.05, 3.0, 2.0], [1.3, 0, 0.7]), cs.Box([3.0, 0.05, 2.0], [0, -1.3, 0.7])]
    artists = plot.scene(cs.Scene(walls), ur5e, UP)
    ax = artists[0].axes
    eye = look_along(ax.elev, ax.azim)[2]
    assert Blockers(walls).hide(make_skeleton(ur5e, UP).points, eye).mean() < 0.1


def test_obstacles_that_hide_the_arm_are_transparent(ur5e):
    cage = [
        cs.Box(2.0 - 1.95 * np.abs(side), 1.0 * np.array(side) + [0, 0, 0.5])
        for side in ([1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1])
    ]
    groups = plot.scene(cs.Scene(cage), ur5e, UP)[0].scene.groups
    assert any(group.opacity < 1 for group in groups)
    assert all(isinstance(group.solids[0], Facets) for group in groups if group.opacity < 1)
    assert all(group.opacity == 1 for group in plot.scene(table(), ur5e, UP)[0].scene.groups)


def test_carried_objects_move_with_their_frame(ur5e):
    T = cs.pose([0.02, 0.0, 0.2], rpy=[0.3, 0.2, 0.1])
    scene = table(cs.Sphere(0.0321, name="ball")).attach("ball", "tool0", T)
    place = (ur5e.fk(UP) @ T)[:3, 3]
    found = [b for b in solids_in(plot.scene(scene, ur5e, UP)) if getattr(b, "radius_a", 0) == 0.0321]
    assert len(found) == 1
    np.testing.assert_allclose(found[0].a, place, atol=1e-12)


@pytest.mark.parametrize("name", ["ur5e", "panda", "fetch"])
def test_shapes_are_those_of_the_checks(name):
    rng = np.random.default_rng(9)
    robot = cs.load_robot(name).with_base(random_place(rng))
    geometry = replace(robot.collision, pairs=np.empty((0, 2), dtype=np.int64), _kept={})
    for q in robot.random_configuration(4, rng=rng):
        groups = [g for g in plot.collision(robot, q)[0].scene.groups if g.opacity < 1]
        plt.close("all")
        assert len(groups) == len(geometry.links)
        assert sum(len(group.solids) for group in groups) == len(geometry)
        points = np.array([end for g in groups for b in g.solids for end in (b.a, b.b)])
        radii = np.array([r for g in groups for b in g.solids for r in (b.radius_a, b.radius_b)])
        normal = rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        low = (points @ normal - radii).min()  # a plane is as far from the drawn bodies as the checks say
        plane = cs.Scene([cs.HalfSpace(normal, low - 0.3)])
        assert clearance(geometry, q, plane).distance == pytest.approx(0.3, abs=1e-9)


def test_arms_are_drawn_by_the_shapes_of_the_checks():
    robot = cs.load_robot("ur5e")
    drawn = [
        [body for body in solids_in(draw()) if isinstance(body, Solid) and body.round]
        for draw in (lambda: plot.scene(table(), robot, UP), lambda: plot.collision(robot, UP, table()))
    ]
    radii = [{round(body.radius_a, 9) for body in bodies} for bodies in drawn]
    checked = {round(shape.radius, 9) for own in robot.collision.link_shapes.values() for shape in own}
    assert checked <= radii[0]
    assert checked <= radii[1]
    without = cs.load_robot("ur10")
    assert not without.collision
    assert solids_in(plot.scene(table(), without, np.zeros(6)))


def test_a_base_without_shapes_is_drawn(ur5e):
    shapes = ur5e.collision.link_shapes
    assert "base_link" not in shapes
    bodies = solids_in(plot.scene(table(), ur5e, UP))
    shoulder = shapes["shoulder_link"]
    assert len(bodies) > sum(map(len, shapes.values()))
    assert shoulder


def test_a_mounted_arm_stands_on_its_base(ur5e):
    T = cs.pose([0.4, 0.3, 0.7], rpy=[0, 0, 0.5])
    here, there = make_skeleton(ur5e, UP), make_skeleton(ur5e.with_base(T), UP)
    assert there.length == pytest.approx(here.length)
    np.testing.assert_allclose(there.points, here.points @ T[:3, :3].T + T[:3, 3], atol=1e-9)
    np.testing.assert_allclose(there.joints, here.joints @ T[:3, :3].T + T[:3, 3], atol=1e-9)
    scene = plot.robot(ur5e.with_base(T), UP)[0].scene
    stand = scene.groups[0].solids[0]
    np.testing.assert_allclose([stand.a, stand.b], [[0.4, 0.3, 0], [0.4, 0.3, 0.7]], atol=1e-12)


@pytest.fixture(scope="module")
def wall_plan(ur5e):
    scene = cs.Scene([cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35]), cs.HalfSpace(offset=-0.25)])
    start, goal = np.radians([-60, -80, 90, -100, -90, 0]), np.radians([60, -80, 90, -100, -90, 0])
    return cs.plan(ur5e, start, goal, scene)


def test_a_plan_is_drawn_from_start_to_goal(ur5e, wall_plan):
    artists = plot.plan(wall_plan, poses=5)
    groups = artists[0].scene.groups
    ghosts = [group for group in groups if group.opacity < 1]
    assert len(ghosts) == 4
    tube = groups[-1].solids
    tip = ur5e.fk(wall_plan.path)[:, :3, 3]
    np.testing.assert_allclose([tube[0].a, tube[len(tube) - len(tip) - 1].b], tip[[0, -1]], atol=1e-9)
    np.testing.assert_allclose([body.a for body in tube[-len(tip) :]], tip, atol=1e-12)
    last = [
        shape.moved(ur5e.fk(wall_plan.path[-1], name)).bounds
        for name, shapes in ur5e.collision.link_shapes.items()
        for shape in shapes
    ]
    opaque = np.array([[*body.a, *body.b] for body in groups[-2].solids]).reshape(-1, 3)
    inside = (np.min(last, axis=(0, 1)) <= opaque) & (opaque <= np.max(last, axis=(0, 1)))
    assert inside[-2 * len(last) :].all(), "the goal is opaque"


def is_obstacle(body) -> bool:
    return isinstance(body, Facets) or body.radius_a == 0.3


def test_a_failed_descent_is_drawn_to_where_it_stopped():
    arm = cs.load_robot("planar_2r")
    obstacles = [
        cs.Box([0.5, 0.5, 0.5], [1.2, 1.3, 0], name="box"),
        cs.Sphere(0.3, [-1.4, 0.6, 0], name="ball"),
    ]
    found = cs.plan(arm, [0.2, 0.3], [1.8, 0.8], cs.Scene(obstacles), planner="potential_field")
    assert found.status == "local_minimum"
    groups = plot.plan(found, poses=4)[0].scene.groups
    stop = groups[-1].solids[-1]
    np.testing.assert_allclose(stop.a, arm.fk(found.stats["rest"].q)[:3, 3], atol=1e-9)
    obstacle_colors = {tuple(body.color) for group in groups for body in group.solids if is_obstacle(body)}
    assert obstacle_colors == {colors.PUSHING, colors.OBSTACLE}, "the box pushes"


def test_poses_are_at_equal_distances():
    rng = np.random.default_rng(8)
    path = rng.normal(size=(6, 4))
    rows = equal_steps(path, 50)
    np.testing.assert_array_equal(rows[[0, -1]], path[[0, -1]])
    long = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    assert np.linalg.norm(np.diff(rows, axis=0), axis=1).max() <= long / 49 + 1e-12
    for q in rows:
        a, b = path[:-1], path[1:]
        share = np.clip(((q - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0, 1)[:, None]
        assert np.linalg.norm(a + share * (b - a) - q, axis=1).min() < 1e-12, "on the path"
    assert (equal_steps(np.zeros((2, 3)), 4) == 0).all(), "a path without a length"


def test_a_planar_arm_is_drawn_in_space():
    arm = cs.load_robot("planar_2r", geometry="skeleton")
    plan = cs.plan(arm, [-1, 0.3], [1, 0.2], cs.Scene([cs.Box([0.3, 0.1, 0.3], [1.2, 0, 0])]))
    assert plot.plan(plan)[0].axes.name == "3d"


@pytest.mark.parametrize(
    ("draw", "error", "message"),
    [
        (lambda robot, plan: plot.scene(robot, robot, UP), InputTypeError, r"cspace\.Scene"),
        (lambda robot, plan: plot.scene(table(), robot), InputError, "q is missing"),
        (lambda robot, plan: plot.scene(table(), robot, UP[:5]), InputError, "shape"),
        (lambda robot, plan: plot.scene(table(), robot, [UP, UP]), InputError, "one configuration"),
        (lambda robot, plan: plot.collision(cs.load_robot("ur10"), UP), InputError, "with_spheres"),
        (lambda robot, plan: plot.collision(robot, UP, "table"), InputTypeError, r"cspace\.Scene"),
        (lambda robot, plan: plot.plan(robot), InputTypeError, r"cs\.plan"),
        (lambda robot, plan: plot.plan(plan, poses=1), InputError, "poses is 1"),
        (lambda robot, plan: plot.plan(plan, ax=plt.figure().add_subplot()), InputError, "3-D axes"),
        (
            lambda robot, plan: plot.plan(cs.plan(robot, UP, {"position": [9, 9, 9]})),
            InputError,
            "no path to draw",
        ),
        (
            lambda robot, plan: plot.plan(plan.planner.plan(ArmSpace(robot.collision), UP, UP)),
            InputTypeError,
            "RobotGeometry",
        ),
    ],
)
def test_bad_input_is_refused(ur5e, wall_plan, draw, error, message):
    with pytest.raises(error, match=message):
        draw(ur5e, wall_plan)
