"""Grid search: costs beside those of a slow search over the same grid, limits, wraps, and failures."""

import heapq
import itertools
from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from collision.cells import random_robot, random_scene
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.planning import PLANNERS, ArmSpace, GridSearch
from oracles import collision as oracle
from planning.test_rrt_connect import judge_path, wall_arm

ORDERS = (
    {},
    {"method": "dijkstra"},
    {"method": "breadth_first"},
    {"method": "best_first"},
    {"heuristic": "potential"},
    {"heuristic": "potential", "weight": 1.0},
    {"heuristic": "potential", "scale": 0.9, "weight": 3.0},
    {"method": "best_first", "heuristic": "potential"},
)


def few_joints(seed, n):
    """A random robot with at most n joints in a random scene, and free configurations."""
    for attempt in range(200):
        rng = np.random.default_rng([seed, attempt])
        robot = random_robot(1000 * seed + attempt, n=n, spheres=3)
        if not np.isfinite(robot.limits.lower[list(robot.collision.prismatic)]).all():
            continue
        scene = random_scene(rng, 6)
        q = robot.random_configuration(200, rng=seed, reach=1.0)
        free = q[~robot.collides(q, scene, margin=0.01)]
        if 1 <= robot.dof <= 3 and 8 <= len(free) <= 190:
            return robot, scene, free
    raise AssertionError("no random scene leaves room")


def limited_arm(n=2, bound=2.8):
    """Links of a metre with joints that stop."""
    tree = cs.load_robot(f"planar_{n}r").description
    joints = [
        replace(joint, type="revolute", lower=-bound, upper=bound) if joint.moving else joint
        for joint in tree.joints
    ]
    rows = [[x, 0, 0, 0.03] for x in np.linspace(0, 1, 31)]
    robot = cs.Robot(replace(tree, joints=tuple(joints)))
    return robot.with_spheres({f"link_{k + 1}": rows for k in range(n)})


def balls(seed, count=3):
    """Spheres around the base."""
    rng = np.random.default_rng(seed)
    angles, radii = rng.uniform(-np.pi, np.pi, count), rng.uniform(0.9, 1.9, count)
    return cs.Scene(
        [cs.Sphere(0.15, [r * np.cos(a), r * np.sin(a), 0]) for r, a in zip(radii, angles, strict=True)]
    )


class SlowGrid:
    """The same grid and its edges, written again: nodes by tuples, every edge by the robot's own check."""

    def __init__(self, space, cells, start, goal, reach=1):
        self.space, self.start, self.goal = space, start, goal
        self.counts = [n if w else n + 1 for n, w in zip(cells, space.wraps, strict=True)]
        self.axes = [
            low + (high - low) / n * np.arange(count)
            for low, high, n, count in zip(space.lower, space.upper, cells, self.counts, strict=True)
        ]
        self.sides = (space.upper - space.lower) / np.array(cells)
        span = range(-reach, reach + 1)
        self.moves = [m for m in itertools.product(*[span] * space.dof) if np.gcd.reduce(m) == 1]
        self.known = {}

    def row(self, node):
        if node == "start":
            return self.start
        if node == "goal":
            return self.goal
        q = np.array([axis[i] for axis, i in zip(self.axes, node, strict=True)])
        return np.clip(q, self.space.lower, self.space.upper)

    def shift(self, node, by):
        moved = []
        for i, d, count, wraps in zip(node, by, self.counts, self.space.wraps, strict=True):
            to = (i + d) % count if wraps else i + d
            if not 0 <= to < count:
                return None
            moved.append(to)
        return tuple(moved)

    def corners(self, q):
        low = tuple(
            min(max(int(np.floor((x - axis[0]) / side)), 0), count - 1)
            for x, axis, side, count in zip(q, self.axes, self.sides, self.counts, strict=True)
        )
        found = [self.shift(low, by) for by in itertools.product((0, 1), repeat=self.space.dof)]
        return {node for node in found if node is not None}

    def neighbours(self, node):
        if node == "start":
            return [*self.corners(self.start), "goal"]
        near = [to for by in self.moves if (to := self.shift(node, by)) is not None]
        return [*near, "goal"] if node in self.corners(self.goal) else near

    def is_free(self, a, b):
        key = frozenset((a, b))
        if key not in self.known:
            self.known[key] = bool(self.space.edge(self.row(a), self.row(b)))
        return self.known[key]

    def least_cost(self, hops=False):
        costs, todo = {"start": 0.0}, [(0.0, 0, "start")]
        done, number = set(), 0
        while todo:
            cost, _, at = heapq.heappop(todo)
            if at == "goal":
                return cost
            if at in done:
                continue
            done.add(at)
            for to in self.neighbours(at):
                further = cost + (1.0 if hops else self.space.distance(self.row(at), self.row(to)))
                if further < costs.get(to, np.inf) and self.is_free(at, to):
                    costs[to] = further
                    number += 1
                    heapq.heappush(todo, (further, number, to))
        return np.inf


def cell_ends(q, wraps):
    """The same configuration with joints that wrap between −π and π."""
    return np.where(wraps.astype(bool), q - 2 * np.pi * np.round(q / (2 * np.pi)), q)


@pytest.mark.parametrize("seed", range(6))
def test_costs_are_those_of_a_slow_search_over_the_same_grid(seed):
    robot, scene, free = few_joints(seed, 2 if seed % 2 else 3)
    space = ArmSpace(robot, scene)
    cells = [9, 7, 5][: robot.dof]
    ends = cell_ends(free, space.wraps)
    for a, b in zip(ends[:6:2], ends[1:6:2], strict=False):
        slow = SlowGrid(space, cells, a, b)
        best = slow.least_cost()
        plans = [GridSearch(cells=cells, simplify=False, **each).plan(space, a, b) for each in ORDERS]
        if not np.isfinite(best):
            assert all(plan.status == "undetermined" and "holds no path" in plan.reason for plan in plans)
            continue
        assert all(plans)
        costs = [plan.cost for plan in plans]
        np.testing.assert_allclose(costs[:2], best, rtol=1e-6)
        assert costs[5] == pytest.approx(best, rel=1e-6)
        assert min(costs) >= best * (1 - 1e-6)
        assert costs[4] <= 1.5 * best * (1 + 1e-6)
        assert costs[6] <= 3.0 * best * (1 + 1e-6)
        assert len(plans[2]) - 1 == slow.least_cost(hops=True)
        assert plans[0].stats["expansions"] <= plans[1].stats["expansions"]


@pytest.mark.parametrize("seed", range(6))
def test_paths_are_free_and_end_as_told(seed):
    robot, scene, free = few_joints(seed, 3)
    space = ArmSpace(robot, scene)
    found = 0
    for a, b in zip(free[:8:2], free[1:8:2], strict=False):
        for options in ORDERS:
            plan = GridSearch(step=0.4, **options).plan(space, a, b)
            if not plan:
                assert plan.status == "undetermined"
                continue
            found += 1
            assert plan.certified
            np.testing.assert_array_equal(plan.path[0], a)
            turns = (plan.path[-1] - b) / (2 * np.pi)
            np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
            assert plan.cost <= plan.stats["grid_cost"] * (1 + 1e-12)
        assert not plan or judge_path(robot, scene, plan.path) > -oracle.BAND
    assert found


@pytest.mark.parametrize("seed", range(4))
def test_costs_approach_the_exact_path_of_two_joints(seed):
    robot = limited_arm()
    scene = balls(seed)
    exact = cs.configuration_space(robot, scene, link_radius=0.03)
    q = robot.random_configuration(300, rng=seed)
    free = q[~robot.collides(q, scene, margin=0.02)]
    begin = free[0]
    goal = max(
        (one for one in free if exact.connected(begin, one)), key=lambda one: np.linalg.norm(one - begin)
    )
    taut = exact.path(begin, goal).length
    space = ArmSpace(robot, scene)
    costs = [GridSearch(step=h, reach=3).plan(space, begin, goal).cost for h in (0.4, 0.1, 0.05, 0.02)]
    raw = GridSearch(step=0.02, reach=3, simplify=False).plan(space, begin, goal).cost
    assert np.isfinite(costs[2:]).all()
    assert costs[3] <= 1.005 * taut
    assert costs[3] <= 1.01 * min(costs)
    assert raw <= 1.02 * taut
    assert costs[3] >= space.distance(begin, goal)


def test_a_path_that_passes_one_ball_is_the_taut_one():
    robot = limited_arm()
    scene = cs.Scene([cs.Sphere(0.2, [1.6, 0.0, 0.0])])
    begin, goal = np.array([-0.7, 0.2]), np.array([0.7, 0.2])
    # Spheres 1/30 m apart lie inside the capsule of their radius and around the one of their intersections.
    inner = np.sqrt(0.03**2 - (1 / 60) ** 2)
    wide, narrow = (
        cs.configuration_space(robot, scene, link_radius=r).path(begin, goal).length for r in (0.03, inner)
    )
    space = ArmSpace(robot, scene)
    costs = [GridSearch(step=h, reach=5).plan(space, begin, goal).cost for h in (0.2, 0.05, 0.0125)]
    assert narrow * (1 - 1e-6) <= costs[2] <= 1.002 * wide
    assert costs[2] <= costs[0]


@pytest.mark.parametrize("name", ["planar_2r", "planar_3r"])
def test_joints_without_limits_close_the_grid(name):
    robot = cs.load_robot(name)
    space = ArmSpace(robot, cs.Scene([cs.Sphere(0.2, [2.2, 0.0, 0.0])]))
    rest = [0.4] * (robot.dof - 1)
    for options in ORDERS:
        plan = GridSearch(step=0.3, **options).plan(space, [3.0, *rest], [-3.0, *rest])
        assert plan.cost == pytest.approx(2 * np.pi - 6.0)
        assert plan.path[-1, 0] == pytest.approx(2 * np.pi - 3.0)


def test_a_grid_without_a_path_says_so_and_the_exact_space_proves_it():
    robot = limited_arm()
    cage = cs.Scene([cs.Sphere(0.1, [0.8 * np.cos(t), 0.8 * np.sin(t), 0]) for t in (0.7, -0.7)])
    begin, goal = np.array([0.0, 0.0]), np.array([2.0, 0.0])
    assert cs.configuration_space(robot, cage, link_radius=0.03).connected(begin, goal).status == "separate"
    for options in ORDERS:
        plan = GridSearch(step=0.1, **options).plan(ArmSpace(robot, cage), begin, goal)
        assert (plan.status, len(plan)) == ("undetermined", 0)
        assert "the grid of 56 × 56 cells holds no path: no open node is left after" in plan.reason
        assert "the search came within" in plan.reason
        assert "blocked" in plan.reason


def test_several_starts_and_goals_are_alternatives():
    robot = limited_arm()
    scene = balls(1)
    q = robot.random_configuration(60, rng=3)
    free = q[~robot.collides(q, scene)][:6]
    space = ArmSpace(robot, scene)
    planner = GridSearch(step=0.2, simplify=False)
    plan = planner.plan(space, free[:3], free[3:])
    each = [[planner.plan(space, a, b).cost for b in free[3:]] for a in free[:3]]
    assert plan.cost == pytest.approx(np.min(each), rel=1e-9)
    assert each[plan.start][plan.goal] == pytest.approx(plan.cost, rel=1e-9)


def test_many_plans_are_those_of_each_alone():
    robot, scene, free = few_joints(3, 3)
    starts, goals = free[:4], free[4:8]
    options = {"planner": "grid_search", "step": 0.4, "heuristic": "potential"}
    alone = [cs.plan(robot, a, b, scene, **options) for a, b in zip(starts, goals, strict=True)]
    for threads in (1, 2):
        many = cs.plan_many(robot, starts, goals, scene, threads=threads, **options)
        assert many.status == tuple(plan.status for plan in alone)
        for one, other in zip(many, alone, strict=True):
            np.testing.assert_array_equal(one.path, other.path)
            assert one.stats["expansions"] == other.stats["expansions"]


def test_sampled_edges_that_fail_their_proof_are_left_out():
    robot = limited_arm()
    thin = cs.Scene([cs.Capsule(0.002, 0.4, cs.pose([1.5, 0.0, 0.0]), name="rod")])
    space = ArmSpace(robot, thin)
    plan = GridSearch(step=0.5, search="sampled", resolution=0.5).plan(space, [-0.4, 0.0], [0.4, 0.0])
    assert plan.certified
    assert plan.stats["removed"] > 0
    assert judge_path(robot, thin, plan.path) > -oracle.BAND


def test_budgets_are_heeded():
    robot = limited_arm()
    space = ArmSpace(robot, balls(2))
    free = [q for q in robot.random_configuration(60, rng=5) if not robot.collides(q, space.scene)]
    far = max(free, key=lambda q: np.linalg.norm(q - free[0]))
    few = GridSearch(method="dijkstra", edges=50).plan(space, free[0], far)
    assert (few.status, few.stats["edges"]) == ("undetermined", 50)
    assert "edge budget was used up" in few.reason
    late = GridSearch(method="dijkstra", step=0.002, time_limit=0.01).plan(space, free[0], far)
    assert late.status == "undetermined"
    assert "time limit was reached" in late.reason


BAD = {
    "joints": ("ur5", {}, InputError, "ur5 has 6 joints, and a grid takes one to 3; choose another planner"),
    "nodes": ("planar_3r", {"step": 0.01}, InputError, "larger step= or fewer cells="),
    "shape": ("planar_2r", {"cells": [3, 4, 5]}, InputError, r"cells has shape \(3,\)"),
    "half": ("planar_2r", {"cells": 2.5}, InputError, "whole and positive"),
    "none": ("planar_2r", {"cells": 0}, InputError, "whole and positive"),
    "words": ("planar_2r", {"cells": "many"}, InputTypeError, "cells"),
    "method": ("planar_2r", {"method": "astar"}, UnknownNameError, "did you mean 'a_star'"),
    "heuristic": ("planar_2r", {"heuristic": "none"}, UnknownNameError, "distance"),
    "step": ("planar_2r", {"step": -1.0}, InputError, "step is -1"),
    "weight": ("planar_2r", {"weight": 0.5}, InputError, "weight is 0.5"),
    "reach": ("planar_2r", {"reach": 0}, InputError, "reach is 0"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_options_get_an_error_that_names_them(name):
    arm, options, kind, message = BAD[name]
    robot = cs.load_robot(arm)
    q = np.zeros(robot.dof)
    with pytest.raises(kind, match=message):
        cs.plan(robot, q, q, planner="grid_search", **options)


def test_start_and_goal_may_be_the_same_or_touch():
    robot = wall_arm()
    same = cs.plan(robot, [1.0, 0.0], [1.0, 0.0], planner="grid_search")
    assert (same.cost, len(same)) == (0.0, 2)
    ball = cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0], name="ball")])
    with pytest.raises(InputError, match="start: link_2 touches ball"):
        cs.plan(robot, [0, 0], [2, 0], ball, planner="grid_search")
    assert PLANNERS["grid_search"].name == "grid_search"
