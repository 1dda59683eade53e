"""The mesh judge: exact shapes against spheres and known contacts; paths and their reasons."""

import struct
import sys

import numpy as np
import pytest

import cspace as cs
from cspace.collision import MeshJudge
from cspace.errors import InputError, MissingExtraError, UnknownNameError

pytest.importorskip("coal")

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5
SIDES = ([0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3])
FACES = np.array([[a, b, c] for s in SIDES for a, b, c in (s[:3], (s[0], *s[2:]))])
"""Triangles of a cube, outward."""

LINK = """
  <link name="{name}"><collision><origin xyz="0 0 {middle}"/><geometry>{geometry}</geometry></collision>
  </link>
"""
JOINT = """
  <joint name="j{k}" type="revolute"><parent link="{a}"/><child link="{b}"/><origin xyz="0 0 {z}"/>
  <axis xyz="{axis}"/><limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
"""


def write_cube(path, size):
    """A binary STL file of a box."""
    corners = (CUBE * size)[FACES].astype("<f4")
    rows = b"".join(bytes(12) + triangle.tobytes() + bytes(2) for triangle in corners)
    path.write_bytes(bytes(80) + struct.pack("<I", len(corners)) + rows)


def make_arm(folder, kind, **options):
    """An arm of four joints with links 8 cm wide and 30 cm long, as boxes or as meshes of the same boxes."""
    size, names = [0.08, 0.08, 0.3], ["base", "one", "two", "three", "four"]
    write_cube(folder / "link.stl", size)
    given = {"box": '<box size="0.08 0.08 0.3"/>', "mesh": '<mesh filename="link.stl"/>'}[kind]
    text = "".join(LINK.format(name=name, middle=0.15, geometry=given) for name in names)
    for k, axis in enumerate(("0 0 1", "0 1 0", "0 1 0", "1 0 0")):
        text += JOINT.format(k=k, a=names[k], b=names[k + 1], z=0.32, axis=axis)
    path = folder / f"{kind}.urdf"
    path.write_text(f'<robot name="{kind}_arm">{text}</robot>')
    return cs.load_robot(path, **options)


@pytest.fixture(scope="module")
def arms(tmp_path_factory):
    folder = tmp_path_factory.mktemp("arms")
    return {kind: make_arm(folder, kind) for kind in ("box", "mesh")}


def random_scene(seed):
    """Shapes of all kinds around an arm."""
    rng = np.random.default_rng(seed)
    place = lambda: cs.pose([*rng.uniform(-0.9, 0.9, 2), rng.uniform(0.3, 1.5)], rpy=rng.uniform(-3, 3, 3))  # noqa: E731
    cube = cs.Mesh(CUBE * [0.2, 0.1, 0.3], FACES, place(), name="cube")
    return cs.Scene(
        [
            cs.Box([0.2, 0.3, 0.1], place()),
            cs.Sphere(0.1, place()),
            cs.Capsule(0.05, 0.3, place()),
            cs.Cylinder(0.08, 0.2, place()),
            cs.Hull(rng.normal(size=(12, 3)) * 0.1, place()),
            cube,
            cs.HalfSpace([0, 0, 1], 0.05, name="floor"),
            cs.PointCloud(place()[:3, 3] + rng.normal(size=(40, 3)) * 0.05, radius=0.01),
        ],
        allowed=[("base", "floor"), ("one", "floor")],
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", ["box", "mesh"])
def test_what_is_free_for_spheres_is_free_for_the_shapes_inside_them(arms, kind, seed):
    robot, scene = arms[kind], random_scene(seed)
    q = robot.random_configuration(300, rng=seed)
    exact, spheres = MeshJudge(robot, scene).collides(q), robot.collides(q, scene)
    assert not (exact & ~spheres).any()
    assert exact.any()
    deep = robot.clearance(q, scene).distance < -2 * robot.collision.excess - 0.02
    assert exact.mean() > 0.5 * spheres.mean()
    assert (exact[deep].mean() if deep.any() else 1.0) > 0.9


@pytest.mark.parametrize("seed", range(4))
def test_meshes_of_boxes_are_judged_like_the_boxes(arms, seed):
    scene = random_scene(seed)
    q = arms["box"].random_configuration(300, rng=seed)
    boxes, meshes = (MeshJudge(arms[kind], scene) for kind in ("box", "mesh"))
    differ = boxes.collides(q) != meshes.collides(q)
    assert not differ.any() or np.abs(arms["box"].clearance(q[differ], scene).distance).max() < 0.02
    for row in q[:30]:
        assert (boxes.contact(row) is None) == (meshes.contact(row) is None)


@pytest.mark.parametrize("kind", ["box", "mesh"])
@pytest.mark.parametrize("gap", [-1e-4, 1e-4])
def test_the_surface_is_where_it_is(arms, kind, gap):
    wall = cs.Box([0.2, 1.0, 1.0], [0.04 + gap + 0.1, 0.0, 1.4])  # beside the upright arm, 4 cm from its axis
    judge = MeshJudge(arms[kind], cs.Scene([wall]))
    assert judge.collides(np.zeros(4)) == (gap < 0)
    close = MeshJudge(arms[kind], cs.Scene([wall]), margin=3e-4)
    assert close.collides(np.zeros(4))
    assert judge.collides(np.zeros((2, 3, 4))).shape == (2, 3)


def test_a_thing_inside_a_mesh_is_found(arms):
    ball = cs.Scene([cs.Sphere(0.01, [0, 0, 0.32 * 4 + 0.15], name="seed")])
    assert MeshJudge(arms["mesh"], ball).contact(np.zeros(4)) == ("four", "seed")
    room = cs.Scene([cs.Mesh(CUBE * 9.0, FACES, name="block")])
    assert MeshJudge(arms["mesh"], room).collides(np.zeros(4))
    shell = cs.Scene([cs.Mesh(CUBE * 9.0, FACES, name="block", solid=False)])
    assert not MeshJudge(arms["mesh"], shell).collides(np.zeros(4))


def test_attached_objects_and_allowed_pairs_count(arms):
    robot = arms["mesh"]
    wall = cs.Box([0.2, 1.0, 1.0], [0.4, 0.0, 1.6], name="wall")
    rod = cs.Capsule(0.02, 0.5, name="rod")
    free = cs.Scene([wall, rod.placed([5.0, 0, 0])])
    held = free.attach("rod", "four", cs.pose([0.2, 0, 0.2], rpy=[0, np.pi / 2, 0]))
    assert not MeshJudge(robot, free).collides(np.zeros(4))
    assert MeshJudge(robot, held).contact(np.zeros(4)) == ("rod", "wall")
    assert not MeshJudge(robot, held.allow("rod", "wall")).collides(np.zeros(4))


def test_samples_of_a_path_are_as_close_as_stated(arms):
    robot = arms["box"]
    path = robot.random_configuration(4, rng=3)
    judge = MeshJudge(robot)
    rows, places = judge._sample(path, 0.01)
    assert (np.diff(places) > 0).all()
    assert places[[0, -1]].tolist() == [0.0, 1.0]
    corners = CUBE * [0.08, 0.08, 0.3] + [0, 0, 0.15]
    for name in ("one", "two", "three", "four"):
        T = robot.fk(rows, name)
        points = np.einsum("nij,kj->nki", T[:, :3, :3], corners) + T[:, None, :3, 3]
        assert np.linalg.norm(np.diff(points, axis=0), axis=-1).max() <= 0.01


def test_a_plan_is_verified_or_says_where_it_touches(arms):
    robot = arms["mesh"]
    elbow = robot.fk([0.0, 0.9, 0.4, 0.0], "three")[:3, 3]
    scene = cs.Scene([cs.Box([0.04, 0.04, 0.04], elbow, name="post")])
    start, goal = np.array([-1.2, 0.9, 0.4, 0.0]), np.array([1.2, 0.9, 0.4, 0.0])
    plan = cs.plan(robot, start, goal, scene, verify="mesh")
    assert plan
    assert plan.stats["mesh_samples"] > 100
    assert "with meshes" in plan.reason
    plain = cs.plan(robot, start, goal, scene)
    np.testing.assert_array_equal(plain.path, plan.path)
    thin = robot.with_spheres(
        {name: [[0, 0, 0.15, 0.01]] for name in ("base", "one", "two", "three", "four")}
    )
    assert cs.plan(thin, start, goal, scene)
    spheres = cs.plan(thin, start, goal, scene, verify="mesh")  # these are then its exact shapes
    assert "without meshes" in spheres.reason
    assert "spheres as given" in spheres.reason
    judge = MeshJudge(robot, scene)
    found = cs.plan(thin, start, goal, scene, verify=judge)
    assert found.status == "undetermined"
    assert not len(found.path)
    assert "touches post at" in found.reason
    verdict = judge.judge_path(cs.plan(thin, start, goal, scene).path)
    assert not verdict
    assert verdict.pair[1] == "post"
    assert 0.0 < verdict.at < 1.0


def test_many_plans_are_verified_as_each_alone(arms):
    robot = arms["mesh"]
    elbow = robot.fk([0.0, 0.9, 0.4, 0.0], "three")[:3, 3]
    scene = cs.Scene([cs.Box([0.04, 0.04, 0.04], elbow, name="post")])
    start, goal = np.array([-1.2, 0.9, 0.4, 0.0]), np.array([1.2, 0.9, 0.4, 0.0])
    thin = robot.with_spheres(
        {name: [[0, 0, 0.15, 0.01]] for name in ("base", "one", "two", "three", "four")}
    )
    outside = np.array([3.0, 0.0, 0.0, 0.0])
    goals = [goal, start + 0.1, outside, robot.fk(goal), robot.fk(start + 0.1)]
    for arm in (robot, thin):
        judge = MeshJudge(robot, scene)
        for verify in ("mesh", judge):
            for given in (goals, np.array(goals[:3])):
                many = cs.plan_many(arm, start, given, scene, verify=verify, threads=2)
                assert many.status[2] == "invalid_goal"
                for k, end in enumerate(given):
                    if k == 2:
                        continue
                    alone = cs.plan(arm, start, end, scene, verify=verify)
                    assert (many.status[k], many[k].reason) == (alone.status, alone.reason)
                    assert many.corners[k] == len(alone)
                    assert many.cost[k] == alone.cost
                    np.testing.assert_array_equal(many[k].path, alone.path)
                    assert many[k].stats["mesh_samples"] == alone.stats["mesh_samples"]
    assert many.status[0] == "undetermined"
    assert not many.found[0]
    with pytest.raises(UnknownNameError, match="verification"):
        cs.plan_many(robot, start, goals, scene, verify="spheres")


def test_a_judge_prints_what_it_checks(arms):
    scene = cs.Scene([cs.Sphere(0.1, [9, 9, 9])])
    assert "6 shapes" in repr(MeshJudge(arms["box"], scene))  # five links and a ball


def test_faults_are_named(arms, monkeypatch):
    with pytest.raises(UnknownNameError, match="verification"):
        cs.plan(arms["box"], np.zeros(4), np.ones(4), verify="spheres")
    with pytest.raises(InputError, match="judge of the joints"):
        cs.plan(arms["box"], np.zeros(4), np.ones(4), verify=MeshJudge(cs.load_robot("planar_2r")))
    with pytest.raises(InputError, match="cannot be checked"):
        MeshJudge(cs.load_robot("crx10ia"))
    with pytest.raises(InputError, match="step"):
        MeshJudge(arms["box"]).judge_path(np.zeros((2, 4)), step=0.0)
    monkeypatch.setitem(sys.modules, "coal", None)
    with pytest.raises(MissingExtraError, match=r"cspace\[mesh\]"):
        cs.plan(arms["box"], np.zeros(4), np.ones(4), verify="mesh")
