"""Two joints: a proof that no way leads from a start to a goal, and none where there is a way."""

import itertools

import numpy as np
import pytest

import cspace as cs
from cspace.model import Description, Geometry, Joint, Link
from cspace.model.values import from_rpy
from cspace.plan_motion.separation import Separation
from cspace.planning import ArmSpace


def arm(seed):
    """Two joints of random types and ranges, some of which turn around."""
    rng = np.random.default_rng(seed)
    bar = Geometry("box", (0.8, 0.06, 0.06), from_rpy((0.5, 0, 0), (0, 0, 0)))
    joints = []
    for k, kind in enumerate(rng.choice(["revolute", "revolute", "continuous", "prismatic"], 2)):
        limits = {"lower": -float(rng.uniform(0.5, 3)), "upper": float(rng.uniform(0.5, 3))}
        axis = (0, 1, 0) if kind == "prismatic" else tuple(rng.choice([(0, 0, 1), (0, 1, 0)]).tolist())
        place = from_rpy((1.0 * k, 0, 0.1 * k), (0, 0, float(rng.uniform(-3, 3))))
        given = {} if kind == "continuous" else limits
        joints.append(Joint(f"j{k}", str(kind), f"l{k}", f"l{k + 1}", place, axis, **given))
    links = (Link("l0"), Link("l1", collision=(bar,)), Link("l2", collision=(bar,)))
    return cs.Robot(Description("two", links, tuple(joints)), tip="l2")


def cell(seed, robot, size):
    rng = np.random.default_rng([seed, 1])
    places = robot.fk(robot.random_configuration(8, rng=rng))[:, :3, 3] * rng.uniform(0.2, 1.0, (8, 1))
    return cs.Scene([cs.Box(rng.uniform(0.05, size, 3), cs.pose(p)) for p in places])


@pytest.mark.parametrize("size", [0.3, 0.9])
@pytest.mark.parametrize("seed", range(12))
def test_what_a_plan_joins_is_not_divided_and_what_is_divided_no_plan_joins(seed, size):
    robot = arm(seed)
    scene = cell(seed, robot, size)
    q = robot.random_configuration(400, rng=seed)
    q = q[~robot.collides(q, scene)][:24]
    if len(q) < 2:
        pytest.skip("hardly anything is free")
    proof = Separation(ArmSpace(robot, scene))
    grid = cs.planning.GridSearch(cells=64)
    space = ArmSpace(robot, scene)
    for a, b in itertools.pairwise(q):
        ways = [cs.planning.RRTConnect(edges=3000).plan(space, a, b), grid.plan(space, a, b)]
        divides = proof.divides(a[None], b[None])
        assert not (divides and any(ways))
        assert divides == proof.divides(b[None], a[None])


def test_walls_divide_the_circle_of_a_joint():
    robot = cs.load_robot("planar_2r")
    walls = cs.Scene([cs.Box([3.0, 0.1, 1.0], [1.9 * side, 0, 0]) for side in (-1, 1)])
    up, down, near = [np.pi / 2, 0.0], [-np.pi / 2, 0.0], [0.9, 0.3]
    budgets = {
        "rrt_connect": {},
        "rrt": {"edges": 9000},
        "lazy_prm": {"edges": 9000},
        "grid_search": {"cells": 40},
    }
    for planner, budget in budgets.items():
        plan = cs.plan(robot, up, down, walls, planner=planner, **budget)
        assert plan.status == "unreachable"
        assert "proves" in plan.reason
    assert cs.plan(robot, up, near, walls)
    assert cs.plan(robot, up, [down, near], walls).goal == 1
    half = cs.Scene([cs.Box([3.0, 0.1, 1.0], [1.9, 0, 0])])  # the other way round is free
    assert cs.plan(robot, up, down, half)
    position = {"position": robot.fk(down)[:3, 3]}
    many = cs.plan_many(robot, [up, up, near], [down, near, down], walls, edges=9000)
    assert list(many.status) == ["unreachable", "found", "unreachable"]
    assert cs.plan_many(robot, up, [position, near], walls, edges=9000)[0].status == "unreachable"


def test_short_time_limits_leave_no_time_for_a_proof_alone_or_among_many():
    robot = cs.load_robot("planar_2r")
    walls = cs.Scene([cs.Box([3.0, 0.1, 1.0], [1.9 * side, 0, 0]) for side in (-1, 1)])
    up, down = [np.pi / 2, 0.0], [-np.pi / 2, 0.0]
    alone = cs.plan(robot, up, down, walls, time_limit=0.02)
    many = cs.plan_many(robot, [up], [down], walls, time_limit=0.02)
    assert alone.status == many[0].status == "undetermined"
    assert "time limit" in alone.reason
    assert "time limit" in many[0].reason
