"""What given spheres leave outside of the shapes of a robot."""

import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.model import from_urdf

WAYS = {
    "box": '<box size="0.2 0.1 0.3"/>',
    "cylinder": '<cylinder radius="0.1" length="0.3"/>',
    "sphere": '<sphere radius="0.15"/>',
}
URDF = """<robot name="r"><link name="base"/>
  <link name="hand"><collision><origin xyz="0.1 0 0.2"/><geometry>{}</geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


def farthest_outside(shape, rows, rng):
    """The depth of the deepest of many places of a shape outside of spheres (n, 4): a lower bound."""
    low, high = shape.bounds
    places = rng.uniform(low, high, size=(60_000, 3))
    places = places[np.asarray(shape.distance(places)) <= 0]
    gaps = np.linalg.norm(places[:, None] - rows[:, :3], axis=-1) - rows[:, 3]
    return max(gaps.min(axis=1).max(), 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("kind", WAYS)
def test_deficits_bound_what_is_outside(kind):
    robot = cs.Robot(from_urdf(URDF.format(WAYS[kind])))
    assert robot.collision.deficits == {}
    place = [0.1, 0.0, 0.2]
    shape = {
        "box": cs.Box([0.2, 0.1, 0.3], place),
        "cylinder": cs.Cylinder(0.1, 0.3, place),
        "sphere": cs.Sphere(0.15, place),
    }[kind]
    rng = np.random.default_rng(1)
    whole = robot.with_spheres({"hand": [[*place, 0.25]]})
    assert whole.collision.deficits == {"hand": 0.0}
    for _ in range(3):
        rows = np.column_stack([place + rng.uniform(-0.1, 0.1, (4, 3)), rng.uniform(0.03, 0.12, 4)])
        given = robot.with_spheres({"hand": rows})
        found, least = given.collision.deficits["hand"], farthest_outside(shape, rows, rng)
        assert least <= found <= least + 0.02  # of places inside; polygons around circles are wider
        again = pickle.loads(pickle.dumps(given))
        assert again.collision.deficits == given.collision.deficits
        assert given.with_base(cs.pose([1, 0, 0])).collision.deficits["hand"] == pytest.approx(found)


def test_a_link_without_spheres_is_all_outside():
    robot = cs.load_robot("planar_2r")
    given = robot.with_spheres({"link_1": [[0.5, 0, 0, 1.2]]})
    assert given.collision.deficits == {"link_1": 0.0, "link_2": np.inf}
