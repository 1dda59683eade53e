"""Boxes, cylinders and capsules of robots are exact, whatever spheres cover them."""

import itertools

import numpy as np
import pytest

import cspace as cs
from cspace.model import from_urdf

BAND = 5e-6
"""Distance [m] within which checks may count as touching what is free: rounding to float."""

URDF = """<robot name="r">
  <link name="base"/>
  {links}
</robot>"""

JOINT = """<link name="l{k}">{collision}</link>
  <joint name="j{k}" type="revolute"><parent link="{parent}"/><child link="l{k}"/>
    <origin xyz="{x} {y} {z}" rpy="{r} {p} {w}"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>"""


def random_solid(rng):
    """A collision element, and the same as a shape in the frame of its link."""
    size, xyz, rpy = rng.uniform(0.02, 0.15, 3), rng.uniform(-0.1, 0.1, 3), rng.uniform(-3, 3, 3)
    kind = rng.choice(["box", "cylinder"])
    pose = cs.pose(xyz, rpy=rpy)
    if kind == "box":
        inner = f'<box size="{size[0]} {size[1]} {size[2]}"/>'
        shape = cs.Box(size, pose)
    else:
        inner = f'<cylinder radius="{size[0]}" length="{size[1]}"/>'
        shape = cs.Cylinder(size[0], size[1], pose)
    place = " ".join(map(str, xyz)), " ".join(map(str, rpy))
    xml = f'<collision><origin xyz="{place[0]}" rpy="{place[1]}"/><geometry>{inner}</geometry></collision>'
    return xml, shape


def random_arm(rng, n=3):
    """A robot whose links are a solid or two each, and these by link."""
    links, shapes, parent = [], {}, "base"
    for k in range(n):
        solids = [random_solid(rng) for _ in range(rng.integers(1, 3))]
        x, y, z = rng.uniform(-0.3, 0.3, 3)
        r, p, w = rng.uniform(-3, 3, 3)
        collision = "".join(xml for xml, _ in solids)
        links.append(JOINT.format(k=k, parent=parent, collision=collision, x=x, y=y, z=z, r=r, p=p, w=w))
        shapes[f"l{k}"] = [shape for _, shape in solids]
        parent = f"l{k}"
    return cs.Robot(from_urdf(URDF.format(links="\n".join(links)))), shapes


def farthest(shape, directions):
    """The places (n, 3) of a box or cylinder that are farthest in directions (n, 3)."""
    R, t = shape.pose[:3, :3], shape.pose[:3, 3]
    d = directions @ R
    if isinstance(shape, cs.Box):
        return (np.sign(d) * shape.size / 2) @ R.T + t
    rim = shape.radius * d[:, :2] / np.hypot(d[:, 0], d[:, 1])[:, None]
    return np.column_stack([rim, np.sign(d[:, 2]) * shape.length / 2]) @ R.T + t


def separation(a, b, rng):
    """The largest gap between two solids along a direction: their distance, below zero inside."""

    def climb(n):
        n /= np.linalg.norm(n, axis=1)[:, None]
        gaps = np.einsum("nk,nk->n", farthest(a, -n) - farthest(b, n), n)
        return gaps.max(), n[np.argmax(gaps)]

    best, at = climb(rng.normal(size=(2000, 3)))
    for step in 0.2 * 0.8 ** np.arange(90):
        found, n = climb(at + step * rng.normal(size=(60, 3)))
        if found > best:
            best, at = found, n
    return best


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_the_clearance_is_that_of_the_solids(seed):
    rng = np.random.default_rng(seed)
    robot, shapes = random_arm(rng)
    assert robot.collision.excess == 0.0
    for _ in range(6):
        q = robot.random_configuration(rng=rng)
        obstacle = random_solid(rng)[1].moved(cs.pose(rng.uniform(-0.5, 0.5, 3))).renamed("thing")
        scene = cs.Scene([obstacle]).allow("l0", "l2")
        placed = {name: [s.moved(robot.fk(q, name)) for s in own] for name, own in shapes.items()}
        expected = min(separation(s, obstacle, rng) for own in placed.values() for s in own)
        found = robot.clearance(q, scene)
        assert found.distance == pytest.approx(expected, abs=2e-6)
        if abs(expected) > BAND:
            assert robot.collides(q, scene) == (expected < 0)
            assert robot.collides(np.tile(q, (9, 1)), scene).tolist() == [expected < 0] * 9


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_covers_do_not_change_the_answer(seed):
    rng = np.random.default_rng(100 + seed)
    robot, _ = random_arm(rng, 5)
    fine = robot.with_spheres(cover=0.003)
    shapes = [random_solid(rng)[1].moved(cs.pose(rng.uniform(-0.6, 0.6, 3))) for _ in range(6)]
    scene = cs.Scene([shape.renamed(f"s{k}") for k, shape in enumerate(shapes)])
    q = robot.random_configuration(300, rng=rng)
    near = np.abs(robot.clearance(q, scene).distance) < BAND
    np.testing.assert_array_equal(robot.collides(q, scene)[~near], fine.collides(q, scene)[~near])
    np.testing.assert_allclose(
        robot.clearance(q, scene).distance, fine.clearance(q, scene).distance, atol=1e-7
    )
    assert robot.collision.pairs.tolist() == fine.collision.pairs.tolist()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_no_configuration_of_a_proved_edge_touches(seed):
    rng = np.random.default_rng(200 + seed)
    robot, _ = random_arm(rng, 5)
    shapes = [random_solid(rng)[1].moved(cs.pose(rng.uniform(-0.6, 0.6, 3))) for _ in range(4)]
    scene = cs.Scene([shape.renamed(f"s{k}") for k, shape in enumerate(shapes)])
    q = robot.random_configuration(400, rng=rng)
    free = q[~robot.collides(q, scene)][:40]
    proved = undecided = 0
    for a, b in itertools.pairwise(free):
        edge = robot.edge(a, b, scene)
        rows = a + np.linspace(0, 1, 2001)[:, None] * (b - a)
        distance = robot.clearance(rows[::40], scene).distance
        if edge:
            proved += 1
            assert not robot.collides(rows, scene).any()
            assert distance.min() > 0
        undecided += edge.reason.startswith("undecided")
    assert not undecided
    assert len(free) < 10 or proved


def test_a_box_slides_over_a_table_at_a_tenth_of_a_millimetre():
    """The direction of the motion counts, or an edge along a surface would need a thousand proofs."""
    robot = cs.load_robot("planar_2r")
    tip = robot.tip
    floor = cs.Box([6, 6, 0.1], [0, 0, -0.35 - 1e-4], name="table")
    scene = cs.Scene([floor, cs.Box([0.2, 0.2, 0.6], name="tool")])
    scene = scene.attach("tool", tip, np.eye(4), touch=list(robot.collision.links))
    assert robot.clearance([0.2, 0.5], scene).distance == pytest.approx(1e-4, abs=1e-9)
    assert robot.edge([0.2, 0.5], [1.2, 1.4], scene)
    lower = cs.Scene([floor.moved(cs.pose([0, 0, 2e-4])), scene["tool"]])
    lower = lower.attach("tool", tip, np.eye(4), touch=list(robot.collision.links))
    assert not robot.edge([0.2, 0.5], [1.2, 1.4], lower)
