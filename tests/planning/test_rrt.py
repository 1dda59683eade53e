"""RRT, RRT* and informed RRT*: paths are free, costs fall with the budget, and each failure has its cause."""

import itertools
import time

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.planning import AORRTC, PLANNERS, RRT, ArmSpace, InformedRRTStar, RRTStar, find_planner
from oracles import collision as oracle
from planning.test_aorrtc import planar_arm, shortest_on_grid
from planning.test_rrt_connect import cell, judge_path, wall_arm

TREES = ("rrt", "rrt_star", "informed_rrt_star")
STARS = (RRTStar, InformedRRTStar)


def planner_of(name, **options):
    """A planner that improves its path a little, if it can."""
    found = PLANNERS[name].with_options(options)
    return found.with_options({"improve": 400}) if isinstance(found, RRTStar) else found


def arm_among_balls(seed):
    """A planar arm among three balls, and two free configurations far apart."""
    robot = planar_arm()
    rng = np.random.default_rng(seed)
    angles, reach = rng.uniform(-2.0, 2.0, 3), rng.uniform(1.2, 1.8, 3)
    balls = [cs.Sphere(0.15, [r * np.cos(a), r * np.sin(a), 0]) for r, a in zip(reach, angles, strict=True)]
    scene = cs.Scene(balls)
    q = robot.random_configuration(200, rng=seed)
    free = q[~robot.collides(q, scene, margin=0.05)]
    return robot, scene, free[0], free[np.argmax(np.linalg.norm(free - free[0], axis=1))]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", TREES)
def test_a_path_is_free_and_begins_and_ends_as_told(name, seed):
    robot, scene, free = cell(seed)
    space, planner = ArmSpace(robot, scene), planner_of(name, edges=5000)
    found = 0
    for a, b in zip(free[:6:2], free[1:6:2], strict=False):
        plan = planner.plan(space, a, b, rng=seed)
        assert plan.status in ("found", "undetermined")
        if not plan:
            assert "used up" in plan.reason
            continue
        found += 1
        assert plan.certified
        np.testing.assert_array_equal(plan.path[0], a)
        turns = (plan.path[-1] - b) / (2 * np.pi)
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
        assert plan.cost == pytest.approx(np.linalg.norm(np.diff(plan.path, axis=0), axis=1).sum(), rel=1e-6)
        assert judge_path(robot, scene, plan.path) > -oracle.BAND
        np.testing.assert_array_equal(planner.plan(space, a, b, rng=seed).path, plan.path)
    assert found


@pytest.mark.parametrize("name", TREES)
def test_many_plans_are_those_of_each_alone(name):
    robot, scene, free = cell(1)
    options = {"planner": planner_of(name), "edges": 1000}
    starts, goals = free[:6], free[6:12]
    alone = [cs.plan(robot, a, b, scene, **options) for a, b in zip(starts, goals, strict=True)]
    for threads in (1, 2, 0):
        many = cs.plan_many(robot, starts, goals, scene, threads=threads, **options)
        assert many.status == tuple(p.status for p in alone)
        for one, other in zip(many, alone, strict=True):
            np.testing.assert_array_equal(one.path, other.path)
            assert one.stats["edges"] == other.stats["edges"]


@pytest.mark.slow
@pytest.mark.parametrize("star", STARS)
@pytest.mark.parametrize("seed", range(3))
def test_costs_approach_those_of_a_grid_and_of_aorrtc(star, seed):
    robot, scene, start, goal = arm_among_balls(seed)
    space = ArmSpace(robot, scene)
    costs = [star(improve=n).plan(space, start, goal).cost for n in (0, 300, 3000, 30000)]
    assert all(a >= b for a, b in itertools.pairwise(costs))
    best = shortest_on_grid(robot, scene, start, goal, 61)
    if np.isfinite(best):
        assert costs[-1] <= 1.05 * best
    assert costs[-1] >= np.linalg.norm(goal - start) - 1e-6
    assert costs[-1] == pytest.approx(AORRTC(improve=30000).plan(space, start, goal).cost, rel=0.03)


@pytest.mark.parametrize("star", STARS)
def test_raw_paths_of_rrt_star_approach_the_shortest_too(star):
    """Without shortcuts it is the tree alone that shortens the path."""
    for seed in range(3):
        robot, scene, start, goal = arm_among_balls(seed)
        space = ArmSpace(robot, scene)
        best = AORRTC(improve=30000).plan(space, start, goal).cost
        raw = star(improve=30000, simplify=False).plan(space, start, goal)
        assert 0.99 * best <= raw.cost <= 1.06 * best
        assert raw.stats["improvements"] > 0 or raw.cost <= 1.01 * best


def test_rrt_star_is_cheaper_than_rrt():
    ratios = []
    for seed in range(4):
        robot, scene, free = cell(seed)
        space = ArmSpace(robot, scene)
        for a, b in zip(free[:8:2], free[1:8:2], strict=False):
            plain = RRT(edges=4000, simplify=False).plan(space, a, b)
            for star in STARS:
                better = star(edges=4000, improve=4000, simplify=False).plan(space, a, b)
                if plain and better:
                    ratios.append(better.cost / plain.cost)
    assert len(ratios) >= 10
    assert np.mean(ratios) < 0.95
    assert max(ratios) < 1.05


@pytest.mark.parametrize("name", TREES)
def test_what_cannot_be_reached_says_why(name):
    robot = wall_arm()
    cage = cs.Scene([cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0]) for t in (0.5, 1.5)])
    shut = find_planner(name, {"edges": 1000}).plan(ArmSpace(robot, cage), [1.0, 0.0], [-2.0, 0.0])
    assert shut.status == "undetermined"
    assert "the edge budget was used up after" in shut.reason
    assert "the tree came within" in shut.reason
    assert "of a goal" in shut.reason
    assert "blocked" in shut.reason
    none = cs.plan(robot, [1.0, 0.0], [1.5, 0.0], planner=name, edges=0)
    assert (none.status, none.stats["edges"]) == ("undetermined", 0)
    with pytest.raises(InputError, match="start: link_2 touches ball"):
        cs.plan(robot, [0, 0], [2, 0], cs.Scene([cs.Sphere(0.2, [2.0, 0, 0], name="ball")]), planner=name)


@pytest.mark.parametrize("name", TREES)
def test_joints_without_limits_take_the_short_way(name):
    robot = wall_arm()
    plan = cs.plan(robot, [3.0, 0.5], [-3.0, 0.5], planner=name)
    assert plan.cost == pytest.approx(2 * np.pi - 6.0)
    np.testing.assert_allclose(plan.path[-1], [2 * np.pi - 3.0, 0.5])
    bar = cs.Scene([cs.Box([0.1, 0.1, 1.0], [-1.5, 0.0, 0.0], name="bar")])
    around = cs.plan(robot, [2.5, 0.5], [-2.5, -0.5], bar, planner=planner_of(name))
    assert around
    assert judge_path(robot, bar, around.path) > -oracle.BAND


@pytest.mark.parametrize("name", TREES)
def test_several_starts_and_goals_are_alternatives(name):
    robot = wall_arm()
    scene = cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0])])
    plan = cs.plan(robot, [[1.0, 0.0], [2.0, 0.0]], [[0.0, 0.0], [2.5, 0.2]], scene, planner=name)
    assert plan.goal == 1
    np.testing.assert_array_equal(plan.path[-1], [2.5, 0.2])
    if name != "rrt":
        assert plan.start == 1
    pose = robot.fk([1.2, 0.9])
    np.testing.assert_allclose(
        robot.fk(cs.plan(robot, [0.3, -1.0], pose, planner=name).path[-1]), pose, atol=1e-9
    )


def test_of_several_goals_the_cheapest_is_reached_in_the_end():
    """Around a wall, where the nearest goal in a straight line is not that of the shortest path."""
    robot, scene, start, _ = arm_among_balls(2)
    space = ArmSpace(robot, scene)
    q = robot.random_configuration(200, rng=5)
    goals = q[~robot.collides(q, scene, margin=0.05)][:4]
    best = min(AORRTC(improve=10000).plan(space, start, goal).cost for goal in goals)
    for star in STARS:
        assert star(improve=20000).plan(space, start, goals).cost <= 1.03 * best


@pytest.mark.parametrize("name", TREES)
def test_a_time_limit_is_heeded(name):
    robot = wall_arm()
    cage = cs.Scene([cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0]) for t in (0.5, 1.5)])
    begin = time.perf_counter()
    plan = cs.plan(robot, [1.0, 0.0], [-2.0, 0.0], cage, planner=name, time_limit=0.05)
    assert plan.status == "undetermined"
    assert "time limit" in plan.reason
    assert time.perf_counter() - begin < 5.0


def test_a_motion_whose_proof_fails_is_removed_with_what_hangs_on_it():
    """Samples far apart miss thin obstacles; the search goes on until all motions are proved."""
    removed = 0
    for seed, name in itertools.product(range(4), TREES):
        robot, scene, free = cell(seed)
        planner = planner_of(name, search="sampled", resolution=1.0, range=9.0, edges=2000)
        for a, b in zip(free[:10:2], free[1:10:2], strict=False):
            plan = planner.plan(ArmSpace(robot, scene), a, b, rng=seed)
            removed += plan.stats["removed"]
            if plan and plan.stats["removed"]:
                assert plan.certified
                assert judge_path(robot, scene, plan.path) > -oracle.BAND
    assert removed > 0


@pytest.mark.parametrize("option", [{"goal_bias": 1.5}, {"range": 0.0}, {"improve": -1}])
def test_options_out_of_range_are_refused(option):
    with pytest.raises(InputError, match=next(iter(option))):
        RRTStar(**option)
