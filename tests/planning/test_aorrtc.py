"""AORRTC: costs fall with the budget towards that of a shortest path."""

import heapq
from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace.planning import AORRTC, ArmSpace, RRTConnect
from oracles import collision as oracle
from planning.test_rrt_connect import cell, judge_path


def planar_arm():
    """Two links with joints that stop, so that no way leads around by wrapping."""
    tree = cs.load_robot("planar_2r").description
    joints = [
        replace(joint, type="revolute", lower=-2.8, upper=2.8) if joint.moving else joint
        for joint in tree.joints
    ]
    rows = [[x, 0, 0, 0.03] for x in np.linspace(0, 1, 31)]
    return cs.Robot(replace(tree, joints=tuple(joints))).with_spheres({"link_1": rows, "link_2": rows})


def shortest_on_grid(robot, scene, start, goal, n):
    """The cost of a shortest path over a grid whose steps go to 48 neighbours, a few percent too long."""
    lower, upper = robot.limits.lower, robot.limits.upper
    axes = [np.linspace(low, high, n) for low, high in zip(lower, upper, strict=True)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    free = ~robot.collides(places, scene)
    ends = [
        tuple(int(np.argmin(np.abs(axis - x))) for axis, x in zip(axes, q, strict=True))
        for q in (start, goal)
    ]
    steps = [(i, j) for i in range(-3, 4) for j in range(-3, 4) if (i, j) != (0, 0)]
    costs, todo = {ends[0]: 0.0}, [(0.0, ends[0])]
    while todo:
        cost, at = heapq.heappop(todo)
        if at == ends[1]:
            return cost
        if cost > costs[at]:
            continue
        for i, j in steps:
            to = (at[0] + i, at[1] + j)
            if not (0 <= to[0] < n and 0 <= to[1] < n and free[to]):
                continue
            further = cost + float(np.linalg.norm(places[to] - places[at]))
            if further < costs.get(to, np.inf) and robot.edge(places[at], places[to], scene, resolution=0.02):
                costs[to] = further
                heapq.heappush(todo, (further, to))
    return np.inf


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_costs_approach_that_of_a_grid(seed):
    robot = planar_arm()
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-2.0, 2.0, 3)
    reach = rng.uniform(1.2, 1.8, 3)
    scene = cs.Scene(
        [cs.Sphere(0.15, [r * np.cos(a), r * np.sin(a), 0]) for r, a in zip(reach, angles, strict=True)]
    )
    q = robot.random_configuration(200, rng=seed)
    free = q[~robot.collides(q, scene, margin=0.05)]
    apart = np.argmax(np.linalg.norm(free - free[0], axis=1))
    best = shortest_on_grid(robot, scene, free[0], free[apart], 61)
    space = ArmSpace(robot, scene)
    costs = [AORRTC(improve=n).plan(space, free[0], free[apart]).cost for n in (0, 1000, 30000)]
    assert costs[0] >= costs[1] >= costs[2]
    if np.isfinite(best):
        assert costs[2] <= 1.05 * best
        assert costs[2] >= np.linalg.norm(free[apart] - free[0]) - 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_better_paths_are_free_and_proved(seed):
    robot, scene, free = cell(seed)
    for a, b in zip(free[:6:2], free[1:6:2], strict=False):
        first = cs.plan(robot, a, b, scene, edges=20000)
        plan = cs.plan(robot, a, b, scene, planner="aorrtc", edges=20000, improve=500)
        assert plan.status == first.status
        if not plan:
            continue
        assert plan.certified
        assert plan.cost <= first.cost
        assert plan.stats["improvements"] > 0 or plan.cost == first.cost
        assert judge_path(robot, scene, plan.path) > -oracle.BAND
        np.testing.assert_array_equal(plan.path[0], a)
        again = cs.plan(robot, a, b, scene, planner="aorrtc", edges=20000, improve=500)
        np.testing.assert_array_equal(again.path, plan.path)


def test_without_a_budget_it_is_rrt_connect():
    robot, scene, free = cell(0)
    space = ArmSpace(robot, scene)
    one = AORRTC(improve=0, edges=3000).plan(space, free[0], free[1])
    other = RRTConnect(edges=3000).plan(space, free[0], free[1])
    np.testing.assert_array_equal(one.path, other.path)
