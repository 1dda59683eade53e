"""The collision geometry of robots: what it is made from, which pairs are checked, and what is missing."""

import json
import pickle

import numpy as np
import pytest

import cspace as cs
from collision.cells import random_robot
from collision.motion_bench import ROBOTS, published_robot
from cspace.errors import CspaceError, InputError, UnknownNameError
from cspace.model import Description, Geometry, Joint, Link
from cspace.model.values import from_rpy
from model.random_robots import random_pose


def arm(*shapes, fingers=True):
    """Two links with these shapes on each, and two fingers off the chain."""
    links = [Link("base", collision=shapes), Link("upper", collision=shapes), Link("hand", collision=shapes)]
    joints = [
        Joint("shoulder", "revolute", "base", "upper", from_rpy((0, 0, 0.5), (0, 0, 0)), lower=-2, upper=2),
        Joint("elbow", "revolute", "upper", "hand", from_rpy((0.6, 0, 0), (1, 0, 0)), lower=-2, upper=2),
    ]
    if fingers:
        links += [Link("left", collision=shapes), Link("right")]
        slide = {"lower": 0.0, "upper": 0.1}
        joints += [
            Joint(
                "left_joint",
                "prismatic",
                "hand",
                "left",
                from_rpy((0.1, 0, 0), (0, 0, 0)),
                (0, 1, 0),
                **slide,
            )
        ]
        joints += [Joint("right_joint", "fixed", "hand", "right")]
    return Description("arm", tuple(links), tuple(joints))


SHAPES = {
    "box": Geometry("box", (0.1, 0.2, 0.05), random_pose(np.random.default_rng(0), 0.1)),
    "sphere": Geometry("sphere", (0.1,), random_pose(np.random.default_rng(1), 0.1)),
    "cylinder": Geometry("cylinder", (0.05, 0.3), random_pose(np.random.default_rng(2), 0.1)),
    "capsule": Geometry("capsule", (0.05, 0.3), random_pose(np.random.default_rng(3), 0.1)),
}


@pytest.mark.parametrize("kind", SHAPES)
def test_spheres_cover_the_shapes_of_links(kind):
    rng = np.random.default_rng(5)
    for cover in (0.01, 0.03):
        robot = cs.Robot(arm(SHAPES[kind]), tip="hand", cover=cover)
        geometry = robot.collision
        assert geometry.links == ("base", "upper", "hand", "left")
        assert geometry.excess <= cover
        solid = cs.collision.link_shapes.solid_of(SHAPES[kind])
        for number, name in enumerate(geometry.links):
            own = geometry.spheres[geometry.sphere_links == number]
            T_body_link = geometry.frames[name][1]
            points = rng.uniform(-0.4, 0.4, (20000, 3))
            inside = points[solid.distance(points) <= 0]
            assert len(inside) > 20
            places = inside @ T_body_link[:3, :3].T + T_body_link[:3, 3]
            gaps = np.linalg.norm(places[:, None] - own[:, :3], axis=-1) - own[:, 3]
            assert gaps.min(axis=1).max() <= 1e-12


def test_links_off_the_chain_count_at_their_locked_values():
    finger = cs.Robot(arm(SHAPES["sphere"]), tip="hand", locked={"left_joint": 0.08}).collision
    closed = cs.Robot(arm(SHAPES["sphere"]), tip="hand").collision
    apart = finger.spheres - closed.spheres
    moved = np.array(finger.links)[finger.sphere_links] == "left"
    np.testing.assert_allclose(np.linalg.norm(apart[moved, :3], axis=1), 0.08, atol=1e-12)
    np.testing.assert_array_equal(apart[~moved], 0)
    assert finger.link_bodies.tolist() == [0, 1, 2, 2]


def test_pairs_of_neighbours_and_pairs_that_always_touch_are_allowed():
    robot = cs.Robot(arm(SHAPES["sphere"]), tip="hand")
    reasons = {frozenset((a, b)): why for a, b, why in robot.collision.allowed}
    assert reasons[frozenset(("base", "upper"))] == "adjacent"
    assert reasons[frozenset(("upper", "hand"))] == "adjacent"
    checked = {frozenset(robot.collision.links[k] for k in pair) for pair in robot.collision.pairs}
    assert checked == {frozenset(pair) for pair in (("base", "hand"), ("base", "left"), ("upper", "left"))}
    huge = robot.with_spheres({name: [[0, 0, 0, 5.0]] for name in ("base", "upper", "hand", "left")})
    reasons = {frozenset((a, b)): why for a, b, why in huge.collision.allowed}
    assert "random configurations" in reasons[frozenset(("base", "hand"))]
    assert not huge.collides([0.0, 0.0])
    told = Description(
        "arm",
        *(getattr(arm(SHAPES["sphere"]), f) for f in ("links", "joints")),
        allowed_pairs=(("hand", "base", "Never"),),
    )
    assert ("base", "hand", "Never") in cs.Robot(told, tip="hand").collision.allowed


def cell(**welded):
    """Two links of 0.9 m that turn about vertical axes, and boxes welded to the base or to a link."""
    bar = Geometry("box", (0.9, 0.05, 0.05), from_rpy((0.5, 0, 0), (0, 0, 0)))
    links = [Link("base"), Link("l1", collision=(bar,)), Link("l2", collision=(bar,))]
    turn = {"axis": (0, 0, 1), "lower": -3.14, "upper": 3.14}
    joints = [
        Joint("j1", "revolute", "base", "l1", from_rpy((0, 0, 0), (0, 0, 0)), **turn),
        Joint("j2", "revolute", "l1", "l2", from_rpy((1, 0, 0), (0, 0, 0)), **turn),
    ]
    for name, (parent, size, place) in welded.items():
        links.append(Link(name, collision=(Geometry("box", size),)))
        joints.append(Joint(f"{name}_weld", "fixed", parent, name, from_rpy(place, (0, 0, 0))))
    return cs.Robot(Description("cell", tuple(links), tuple(joints)), tip="l2")


@pytest.mark.parametrize("between", [0, 1, 2])
def test_what_is_welded_to_a_link_is_checked_against_those_that_its_joints_carry(between):
    post = {"post": ("base", (0.1, 0.1, 1), [0.6, 0, 0])}
    for k in range(between):  # more welds between the base and the post change nothing
        post = {f"plate{k}": ("base", (0.01, 0.01, 0.01), [0, 0, -2.0 - k])} | post
    robot = cell(**post)
    assert robot.contact([0.0, 1.5])[:2] == ("post", "l1")
    assert robot.contact([1.5, 0.5]) is None
    assert not robot.edge([-1, 0], [1, 0])
    hooked = cell(hook=("l2", (0.1, 0.1, 0.1), [0.7, 0, 0]))
    assert hooked.contact([1.5, 3.1])[:2] == ("l1", "hook")
    assert hooked.contact([1.5, 2.0]) is None


@pytest.mark.parametrize("seed", range(4))
def test_files_of_spheres_give_what_a_mapping_gives(seed, tmp_path):
    robot = random_robot(seed)
    rows = {
        link.name: [[*g.origin[:3, 3].tolist(), *g.size] for g in link.collision]
        for link in robot.description.links
        if link.collision
    }
    flat = [{"link": n, "center": r[:3], "radius": r[3]} for n, own in rows.items() for r in own]
    (tmp_path / "a.json").write_text(json.dumps(rows))
    (tmp_path / "b.json").write_text(json.dumps({"spheres": flat}))
    (tmp_path / "c.toml").write_text("\n".join(f"{name} = {own}" for name, own in rows.items()))
    robot.to_urdf(tmp_path / "d.urdf")
    wanted = robot.collision
    for name in ("a.json", "b.json", "c.toml", "d.urdf"):
        found = robot.with_spheres(tmp_path / name).collision
        assert found.links == wanted.links
        np.testing.assert_allclose(found.spheres, wanted.spheres, atol=1e-14)
        np.testing.assert_array_equal(found.pairs, wanted.pairs)
    again = pickle.loads(pickle.dumps(robot))
    np.testing.assert_array_equal(again.collision.spheres, wanted.spheres)


def test_a_robot_without_geometry_says_so_and_has_a_skeleton_on_request():
    robot = cs.load_robot("ur16e")
    assert not robot.collision
    assert "the catalogue has no collision geometry for ur16e" in robot.collision.reason
    assert "empty" in repr(robot.collision)
    thin = cs.load_robot("ur16e", geometry="skeleton")
    assert thin.collision
    assert thin.collision.source == "capsules of the skeleton"
    scene = cs.Scene([cs.HalfSpace(name="floor", offset=-0.2)])
    assert not thin.collides(thin.named_poses["home"], scene) or thin.contact(thin.named_poses["home"], scene)
    assert thin.collides(np.zeros(6), cs.Scene([cs.Box([0.2, 0.2, 0.2], thin.fk(np.zeros(6))[:3, 3])]))
    with pytest.raises(UnknownNameError, match="skeleton"):
        cs.load_robot("ur5e", geometry="skeletton")


BAD = {
    "link": ({"hnd": [[0, 0, 0, 1]]}, "hnd"),
    "shape": ({"hand": [[0, 0, 1]]}, "spheres of link 'hand'"),
    "radius": ({"hand": [[0, 0, 0, 0.1], [0, 0, 0, 0.0]]}, "sphere 1 of link 'hand' has the radius 0"),
    "nan": ({"hand": [[0, np.nan, 0, 1.0]]}, "hand"),
    "no file": ("missing.json", "missing.json"),
    "suffix": ("spheres.yaml", "suffix '.yaml'"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_spheres_get_an_error_that_names_them(name):
    spheres, message = BAD[name]
    robot = cs.Robot(arm(SHAPES["sphere"]), tip="hand")
    with pytest.raises(CspaceError, match=message):
        robot.with_spheres(spheres)


@pytest.mark.parametrize("text", ["[]", '{"spheres": [{"link": "hand"}]}', '{"spheres": [1]}', "{", "[[1]]"])
def test_files_with_other_content_are_refused(text, tmp_path):
    (tmp_path / "x.json").write_text(text)
    robot = cs.Robot(arm(SHAPES["sphere"]), tip="hand")
    with pytest.raises(CspaceError, match=r"x\.json"):
        robot.with_spheres(tmp_path / "x.json")


def test_geometry_that_checks_cannot_use_is_named():
    free = arm(SHAPES["sphere"])
    floating = cs.Robot(free, tip="hand", floating=True)
    assert not floating.collision
    assert "floating" in floating.collision.reason
    endless = Description(
        "gantry",
        (Link("a"), Link("b", collision=(SHAPES["sphere"],))),
        (Joint("rail", "prismatic", "a", "b"),),
    )
    with pytest.raises(InputError, match="'rail' of gantry has no limits"):
        cs.Robot(endless).collides([0.0])
    short = Description("gantry", endless.links, (Joint("rail", "prismatic", "a", "b", lower=0, upper=1),))
    with pytest.raises(InputError, match="'rail' is at 2 m"):
        cs.Robot(short).collides([[0.5], [2.0]])
    with pytest.raises(InputError, match="cover is 0"):
        assert cs.Robot(free, tip="hand", cover=0.0).collision
    mesh = cs.model.Geometry("mesh", mesh=cs.model.Mesh("missing.stl"))
    turn = (Joint("j", "revolute", "a", "b"),)
    lost = cs.Robot(Description("m", (Link("a"), Link("b", collision=(mesh,))), turn))
    with pytest.raises(CspaceError, match=r"collision geometry of link 'b'.*missing"):
        assert lost.collision


@pytest.mark.data
@pytest.mark.parametrize("name", ROBOTS)
def test_published_robots_have_the_pairs_that_their_files_leave(name):
    robot, data = published_robot(name)
    geometry = robot.collision
    assert len(geometry) == len(data["spheres"])
    checked = {frozenset(geometry.links[k] for k in pair) for pair in geometry.pairs}
    assert checked == {frozenset(pair) for pair in data["self_pairs_checked_by_vamp"]}
