"""IK solutions that touch nothing."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError


def arm():
    return cs.load_robot("ur5e", geometry="skeleton")


@pytest.mark.parametrize("seed", range(5))
def test_free_keeps_exactly_the_solutions_that_touch_nothing(seed):
    robot = arm()
    scene = cs.Scene(
        [cs.HalfSpace(offset=-0.3, name="floor"), cs.Box([0.2, 0.2, 0.8], [0.5, 0, 0.3], name="post")]
    )
    T = robot.fk(robot.random_configuration(rng=seed))
    solutions = robot.ik(T).within(robot.limits)
    free = solutions.free(scene)
    touching = robot.collides(solutions.q, scene)
    np.testing.assert_array_equal(free.q, solutions.q[~touching])
    np.testing.assert_array_equal(free.q, solutions.free(scene, robot=robot).q)
    assert len(solutions.free(scene, margin=0.05)) <= len(free)
    assert bool(free) == (not touching.all())


def test_none_free_says_what_is_touched():
    robot = arm()
    T = robot.fk(np.radians([0, -90, 90, -90, -90, 0]))
    inside = cs.Scene([cs.Sphere(0.3, T[:3, 3], name="ball")])
    free = robot.ik(T).free(inside)
    assert not free
    assert "every solution touches something" in free.reason
    assert "ball" in free.reason


def test_a_solver_without_a_robot_needs_one():
    robot = arm()
    solver = cs.ik.Solver(robot.chain, robot.limits)
    solutions = solver.solve(robot.fk(np.full(6, 0.5)))
    with pytest.raises(InputError, match=r"robot="):
        solutions.free(cs.Scene())
    assert len(solutions.free(cs.Scene(), robot=robot)) <= len(solutions)
    with pytest.raises(InputError, match="no collision geometry"):
        cs.load_robot("ur10").ik(robot.fk(np.full(6, 0.5))).free(cs.Scene())
