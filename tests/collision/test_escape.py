"""Ways out of collisions end free, within limits, and say so if they do not."""

import numpy as np
import pytest

import cspace as cs
from collision.cells import random_robot, random_scene
from cspace.errors import InputError


def escapes(seed):
    """Random robots in collision, and how they get out."""
    robot, scene = random_robot(seed), random_scene(np.random.default_rng(seed), 14)
    q = robot.random_configuration(60, rng=seed, reach=1.0)
    for row in q[robot.collides(q, scene)][:20]:
        yield robot, scene, row, robot.escape(row, scene, margin=0.01)


def test_an_escape_ends_free_within_limits():
    ended = []
    for robot, scene, row, way in (found for seed in range(8) for found in escapes(seed)):
        np.testing.assert_array_equal(way.path[0], row)
        np.testing.assert_array_equal(way.path[-1], way.q)
        assert ((way.q >= robot.limits.lower) & (way.q <= robot.limits.upper)).all()
        assert np.linalg.norm(np.diff(way.path, axis=0), axis=1).max(initial=0) <= 0.0201
        ended.append(bool(way))
        if way:
            assert not robot.collides(way.q, scene, margin=0.0099)
        else:
            assert "touch" in way.reason
            assert way.distance <= 0.0101
    assert sum(ended) > len(ended) / 3 > 8


def test_a_free_configuration_stays():
    robot = cs.load_robot("ur5e", geometry="skeleton")
    q = np.radians([0, -90, 90, -90, -90, 0])
    way = robot.escape(q)
    assert way
    assert len(way.path) == 1
    np.testing.assert_array_equal(way.q, q)
    assert "Escape" in repr(way)


def test_no_way_out_says_so():
    robot = cs.load_robot("planar_2r").with_spheres({"tip": [[0, 0, 0, 0.05]]})
    way = robot.escape([0.0, 0.0], cs.Scene([cs.HalfSpace(offset=1.0, name="everywhere")]))
    assert not way
    assert "no direction leads out" in way.reason
    assert "everywhere" in way.reason
    deep = robot.escape([0.0, 0.0], cs.Scene([cs.Sphere(0.5, [2.0, 0.1, 0.0], name="ball")]), most=0.05)
    assert "not free after a motion of 0.05" in deep.reason
    with pytest.raises(InputError, match="margin"):
        robot.escape([0.0, 0.0], margin=-1.0)
