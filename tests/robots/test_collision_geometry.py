"""The collision geometry of the catalogue: where it is, what it covers, and what it leaves free."""

import itertools
import json

import numpy as np
import pytest

from cspace.collision.link_pairs import adjacent_pairs
from cspace.model import from_toml, to_toml
from cspace.robots import load_description, load_robot, rows
from cspace.spatial.poses import transform_points
from data import shared_data

GIVEN = [row.name for row in rows() if "collision" not in row.missing]
SELF_FREE = {"Universal Robots": 0.38}
"""Share of random configurations without self-collision, by maker: the meshes of UR5e have 0.63, since its
joints turn twice around and the upper arm passes the base by millimetres; of Panda 0.91, of iiwa 14 0.997."""
MOSTLY_FREE = 0.8
"""That of the others."""
NEAR = 0.03
"""How far [m] the solids of links may be apart that a joint connects."""


def world_spheres(robot, q):
    """Per link the spheres (n, 4) at q, centres in the base frame."""
    geometry, found = robot.collision, {}
    for k, link in enumerate(geometry.links):
        rows = geometry.spheres[geometry.sphere_links == k].copy()
        T = robot.fk(q, link) @ np.linalg.inv(geometry.frames[link][1])
        found[link] = np.column_stack([transform_points(T, rows[:, :3]), rows[:, 3]])
    return found


def test_the_arms_that_have_geometry():
    arms = "fetch fetch_torso fr3 gen3 iiwa14 panda planar_2r planar_3r puma560 so101"
    arms += " ur10e ur3e ur5 ur5e xarm7"
    assert set(GIVEN) >= set(arms.split())
    for row in rows():
        description = load_description(row.name)
        has = any(link.collision for link in description.links)
        assert has == (row.name in GIVEN), row.name
        assert has == ("collision" in description.provenance.sources), row.name
        assert bool(load_robot(row.name).collision) == has, row.name


@pytest.mark.parametrize("name", GIVEN)
def test_every_link_that_moves_is_covered(name):
    robot = load_robot(name)
    assert set(range(1, robot.dof + 1)) <= set(robot.collision.link_bodies.tolist())


@pytest.mark.parametrize("name", GIVEN)
def test_named_poses_and_most_configurations_are_free(name):
    robot = load_robot(name)
    for pose, q in robot.named_poses.items():
        assert robot.contact(q) is None, pose
    q = robot.random_configuration(2000, rng=5)
    least = SELF_FREE.get(robot.description.provenance.vendor, MOSTLY_FREE)
    assert 1.0 - robot.collides(q).mean() > least


@pytest.mark.parametrize("name", GIVEN)
def test_pairs_that_are_not_checked_are_listed_with_their_reason(name):
    robot = load_robot(name)
    geometry = robot.collision
    every = {
        frozenset((geometry.links[a], geometry.links[b]))
        for a, b in itertools.combinations(range(len(geometry.links)), 2)
        if geometry.link_bodies[a] != geometry.link_bodies[b]
    }
    listed = {frozenset(pair[:2]) for pair in geometry.allowed}
    checked = {frozenset((geometry.links[a], geometry.links[b])) for a, b in geometry.pairs}
    assert listed | checked == every
    assert not listed & checked
    joints = robot.description.joints
    adjacent = adjacent_pairs(geometry.links, {joint.child: joint.parent for joint in joints})
    given = {frozenset(pair[:2]) for pair in robot.description.allowed_pairs} & every
    always = {frozenset(pair[:2]) for pair in geometry.allowed if pair[2].startswith("touch at each of")}
    joined = {frozenset((geometry.links[a], geometry.links[b])) for a, b in adjacent}
    assert listed == given | (joined & every) | always
    assert len(always) <= 1
    assert all(pair[2] for pair in geometry.allowed)


@pytest.mark.parametrize("name", GIVEN)
def test_the_solids_of_joined_links_meet(name):
    """At any configuration, which solids in foreign frames would not."""
    robot = load_robot(name)
    for q in robot.random_configuration(3, rng=6):
        spheres = world_spheres(robot, q)
        for a, b in ((a, b) for a, b, why in robot.collision.allowed if why == "adjacent"):
            gap = np.linalg.norm(spheres[a][:, None, :3] - spheres[b][:, :3], axis=-1)
            assert (gap - spheres[a][:, None, 3] - spheres[b][:, 3]).min() < NEAR, (a, b)


@pytest.mark.parametrize("name", GIVEN)
def test_geometry_and_pairs_survive_toml(name):
    robot = load_description(name)
    again = from_toml(to_toml(robot))
    assert again.allowed_pairs == robot.allowed_pairs
    for one, other in zip(robot.links, again.links, strict=True):
        assert [(g.shape, g.size) for g in one.collision] == [(g.shape, g.size) for g in other.collision]
        for g, h in zip(one.collision, other.collision, strict=True):
            np.testing.assert_array_equal(g.origin, h.origin)


@pytest.mark.data
@pytest.mark.parametrize("name", ["panda", "ur5", "fetch_torso"])
def test_published_spheres_have_their_centres_inside(name):
    """At random configurations, by forward kinematics of the published joints with their own frames."""
    if name not in GIVEN:
        pytest.skip("has no geometry")
    file = shared_data() / "planning" / f"robot_{name.removesuffix('_torso')}.json"
    published = json.loads(file.read_text())
    robot = load_robot(name)
    links = set(robot.collision.links)
    for q in robot.random_configuration(3, rng=8):
        values = dict(zip(robot.joint_names, q, strict=True))
        root = "panda_link0" if name == "panda" else "base_link"
        poses = published_poses(published["joints"], root, values)
        spheres = world_spheres(robot, q)
        for row in published["spheres"]:
            if row["link"] in links:
                center = transform_points(poses[row["link"]], np.array(row["center"], dtype=float)[None])[0]
                own = spheres[row["link"]]
                gap = np.linalg.norm(own[:, :3] - center, axis=1) - own[:, 3]
                assert gap.min() < 1e-6, row


def published_poses(joints, root, values):
    """Link → its pose (4, 4) in the root, by Rodrigues' formula."""
    poses = {root: np.eye(4)}
    for _ in range(len(joints)):
        for joint in joints:
            if joint["parent"] in poses and joint["child"] not in poses:
                T = poses[joint["parent"]] @ placement(joint["xyz"], joint["rpy"])
                value = values.get(joint["name"], 0.0)
                if joint["type"] in ("revolute", "continuous"):
                    T = T @ turn(joint["axis"], value)
                elif joint["type"] == "prismatic":
                    T = T @ placement(value * np.array(joint["axis"]), (0, 0, 0))
                poses[joint["child"]] = T
    return poses


def placement(xyz, rpy):
    T = turn((0, 0, 1), rpy[2]) @ turn((0, 1, 0), rpy[1]) @ turn((1, 0, 0), rpy[0])
    T[:3, 3] = xyz
    return T


def turn(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.eye(4)
    T[:3, :3] += np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    return T
