"""Roadmaps of arms: paths against Dijkstra on the edges that are free, files, one roadmap in many scenes."""

import heapq
import signal
import time

import numpy as np
import pytest

import cspace as cs
from collision.motion_bench import problems, published_robot
from cspace.errors import InputError, InputTypeError, RoadmapError
from cspace.planning import PRM, ArmSpace, LazyPRM, PRMStar, Roadmap, find_planner
from oracles import collision as oracle
from planning.test_aorrtc import planar_arm, shortest_on_grid
from planning.test_rrt_connect import cell, judge_path, wall_arm

PLANNERS = ("prm", "lazy_prm", "prm_star")
WIDEST_SEARCH = 16
"""An end is joined to free nodes among so many times the neighbours."""


def dijkstra_on(roadmap, space, start, goal):
    """The cost of the shortest way from start to goal over edges of a roadmap that are proved free."""
    nodes = [*roadmap.nodes, np.asarray(start), np.asarray(goal)]
    ends = len(nodes) - 2, len(nodes) - 1
    near = {k: [] for k in range(len(nodes))}
    for a, b in roadmap.edges.tolist():
        near[a].append(b)
        near[b].append(a)
    free = ~space.robot.collides(roadmap.nodes, space.scene)
    for end in ends:
        far = np.array([space.distance(nodes[end], q) for q in roadmap.nodes])
        order = np.argsort(far, kind="stable")[: WIDEST_SEARCH * roadmap.neighbours]
        for k in order[free[order]][: roadmap.neighbours].tolist():
            near[end].append(k)
            near[k].append(end)
    near[ends[0]].append(ends[1])
    costs, todo, done = {ends[0]: 0.0}, [(0.0, ends[0])], set()
    while todo:
        cost, at = heapq.heappop(todo)
        if at == ends[1]:
            return cost
        if at in done:
            continue
        done.add(at)
        for to in near[at]:
            further = cost + space.distance(nodes[at], nodes[to])
            if further < costs.get(to, np.inf) and space.edge(nodes[at], nodes[to]):
                costs[to] = further
                heapq.heappush(todo, (further, to))
    return np.inf


@pytest.mark.slow
@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("seed", range(6))
def test_a_path_is_free_and_begins_and_ends_as_told(seed, planner):
    robot, scene, free = cell(seed)
    found = 0
    for a, b in zip(free[:6:2], free[1:6:2], strict=False):
        plan = cs.plan(robot, a, b, scene, planner=planner, samples=400, edges=20000)
        assert plan.status in ("found", "undetermined")
        if not plan:
            assert "used up" in plan.reason or "the roadmap joins the start with" in plan.reason
            continue
        found += 1
        assert plan.certified
        np.testing.assert_array_equal(plan.path[0], a)
        turns = (plan.path[-1] - b) / (2 * np.pi)
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
        assert plan.cost == pytest.approx(np.linalg.norm(np.diff(plan.path, axis=0), axis=1).sum(), rel=1e-6)
        assert judge_path(robot, scene, plan.path) > -oracle.BAND
        fresh = Roadmap(robot, samples=400, neighbours=None if planner == "prm_star" else 15)
        again = cs.plan(robot, a, b, scene, planner=planner, roadmap=fresh, edges=20000)
        np.testing.assert_array_equal(again.path, plan.path)
        assert again.stats["edges"] == plan.stats["edges"]
    assert found


@pytest.mark.parametrize("seed", range(6))
def test_lazy_and_full_roadmaps_find_the_shortest_way_over_free_edges(seed):
    robot, scene, free = cell(seed)
    space, roadmap = ArmSpace(robot, scene), Roadmap(robot, samples=200, neighbours=6, rng=seed)
    lazy, full = LazyPRM(roadmap=roadmap, simplify=False), PRM(roadmap=roadmap, simplify=False)
    for a, b in zip(free[:8:2], free[1:8:2], strict=False):
        one, other = lazy.plan(space, a, b), full.plan(space, a, b)
        assert one.status == other.status
        np.testing.assert_array_equal(one.path, other.path)
        best = dijkstra_on(roadmap, space, a, b)
        if np.isfinite(best):
            assert one.cost == pytest.approx(best, rel=1e-5)
        else:  # trees from an end that sees no node may lead there all the same
            assert not one or one.stats["samples"] > 0
        assert one.stats["edges"] <= other.stats["edges"]


@pytest.mark.parametrize("seed", range(4))
def test_edges_are_free_of_self_collision_over_their_whole_length(seed):
    robot, _, _ = cell(seed)
    roadmap = Roadmap(robot, samples=150, neighbours=5, rng=seed, threads=1)
    nodes, edges, space = roadmap.nodes, roadmap.edges, ArmSpace(robot)
    assert not robot.collides(nodes).any()
    assert len(nodes) == len(roadmap)
    assert (edges[:, 0] > edges[:, 1]).all()
    assert len(np.unique(edges, axis=0)) == len(edges)
    parts = list(range(len(nodes)))
    for a, b in edges.tolist():
        assert space.edge(nodes[a], nodes[b])
        old, new = parts[a], parts[b]
        parts = [new if part == old else part for part in parts]
    assert roadmap.components == len(set(parts))
    joined = {frozenset(pair) for pair in edges.tolist()}
    for k in range(0, len(nodes), 10):
        far = np.array([space.distance(nodes[k], q) for q in nodes])
        for other in np.argsort(far, kind="stable")[1:6].tolist():
            assert (frozenset((k, other)) in joined) == bool(
                space.edge(nodes[max(k, other)], nodes[min(k, other)])
            )
    many = Roadmap(robot, samples=150, neighbours=5, rng=seed, threads=2)
    np.testing.assert_array_equal(many.nodes, nodes)
    np.testing.assert_array_equal(many.edges, edges)
    assert f"{len(nodes)} of 150 samples" in repr(roadmap)
    assert "components" in roadmap._repr_html_()


def test_an_extended_roadmap_is_the_one_made_at_once():
    robot, _, _ = cell(1)
    for neighbours in (7, None):
        whole = Roadmap(robot, samples=500, neighbours=neighbours, rng=3)
        extended = Roadmap(robot, samples=120, neighbours=neighbours, rng=3).extend(180).extend(200)
        np.testing.assert_array_equal(extended.nodes, whole.nodes)
        np.testing.assert_array_equal(extended.edges, whole.edges)
        assert (extended.samples, extended.neighbours) == (whole.samples, whole.neighbours)


def test_a_saved_roadmap_is_the_same_bits(tmp_path):
    robot, scene, free = cell(0)
    for neighbours, planner in ((8, LazyPRM), (None, PRMStar)):
        made = Roadmap(robot, samples=300, neighbours=neighbours, margin=0.001, rng=2**64 - 1)
        path = tmp_path / "map.roadmap"
        made.save(path)
        read = Roadmap.load(path, robot)
        for name in ("nodes", "edges"):
            np.testing.assert_array_equal(getattr(read, name), getattr(made, name))
        names = ("samples", "neighbours", "margin", "seed", "components", "robot", "is_star")
        assert [getattr(read, name) for name in names] == [getattr(made, name) for name in names]
        one = cs.plan(robot, free[0], free[1], scene, planner=planner(roadmap=made))
        for given in (read, str(path)):
            other = cs.plan(robot, free[0], free[1], scene, planner=planner(roadmap=given))
            np.testing.assert_array_equal(one.path, other.path)
        read.save(tmp_path / "again.roadmap")
        assert (tmp_path / "again.roadmap").read_bytes() == path.read_bytes()
        np.testing.assert_array_equal(read.extend(50).edges, made.extend(50).edges)


def test_files_that_are_no_roadmap_of_the_robot_are_refused(tmp_path):
    robot, path, bad = wall_arm(), tmp_path / "map.roadmap", tmp_path / "bad.roadmap"
    Roadmap(robot, samples=40, rng=1).save(path)
    data = path.read_bytes()
    rng = np.random.default_rng(0)
    for size in {*rng.integers(0, len(data), 60).tolist(), 0, len(data) - 1}:
        bad.write_bytes(data[:size])
        with pytest.raises(RoadmapError, match=r"bad\.roadmap: .*(incomplete|damaged|no roadmap)"):
            Roadmap.load(bad, robot)
    for at in rng.integers(0, len(data), 200).tolist():
        changed = bytearray(data)
        changed[at] ^= 1 << rng.integers(8)
        bad.write_bytes(bytes(changed))
        with pytest.raises(RoadmapError):
            Roadmap.load(bad, robot)
    bad.write_bytes(data + b"\0")
    with pytest.raises(RoadmapError, match="incomplete"):
        Roadmap.load(bad, robot)
    with pytest.raises(RoadmapError, match="no such file"):
        Roadmap.load(tmp_path / "none.roadmap", robot)
    with pytest.raises(InputTypeError, match="by the path of its file"):
        Roadmap.load(5, robot)
    with pytest.raises(InputError, match="cannot be written"):
        Roadmap(robot, samples=4).save(tmp_path)
    thick = robot.with_spheres({"link_1": [[0.5, 0, 0, 0.1]], "link_2": [[0.5, 0, 0, 0.1]]})
    six = cs.load_robot("ur5e", geometry="skeleton")
    for other, words in ((thick, "other joints, limits or spheres"), (six, "6 joints")):
        with pytest.raises(RoadmapError, match=words):
            Roadmap.load(path, other)
    with pytest.raises(RoadmapError, match="planar_2r with 2 joints"):
        cs.plan(six, np.zeros(6), np.ones(6), planner="lazy_prm", roadmap=str(path))


@pytest.mark.parametrize("planner", [LazyPRM, PRM])
def test_a_roadmap_used_in_other_scenes_plans_as_a_fresh_one(planner):
    robot, _, free = cell(2)
    used = Roadmap(robot, samples=200, rng=4)
    rng = np.random.default_rng(0)
    for _ in range(12):
        place = rng.uniform(-0.6, 0.6, 3)
        scene = cs.Scene([cs.Sphere(rng.uniform(0.02, 0.2), place, name="ball")])
        open_rows = free[~robot.collides(free, scene)]
        if len(open_rows) < 2:
            continue
        for a, b in ((open_rows[0], open_rows[-1]), (open_rows[-1], open_rows[0])):
            space = ArmSpace(robot, scene, margin=0.0)
            one = planner(roadmap=used).plan(space, a, b)
            other = planner(roadmap=Roadmap(robot, samples=200, rng=4)).plan(space, a, b)
            np.testing.assert_array_equal(one.path, other.path)
            assert (one.status, one.stats["edges"]) == (other.status, other.stats["edges"])


def test_what_a_robot_carries_is_checked_against_its_links():
    robot = wall_arm()
    roadmap = Roadmap(robot, samples=300)
    rod = cs.Scene([cs.Capsule(0.05, 0.8, name="rod")]).attach(
        "rod", "link_2", cs.pose([0.0, 0.4, 0.0]), touch=["link_2"]
    )
    space = ArmSpace(robot, rod)
    nodes = roadmap.nodes
    free = ~robot.collides(nodes, rod)
    assert 0 < free.sum() < len(nodes)
    for a, b in zip(nodes[free][:20:2], nodes[free][1:20:2], strict=True):
        plan = LazyPRM(roadmap=roadmap).plan(space, a, b)
        assert plan
        assert judge_clearance(space, plan) > -oracle.BAND


def judge_clearance(space, plan):
    """The least distance at samples a hundred times as dense as those of a search."""
    return space.clearance(plan.sample(1.0 / 3200.0)).distance.min()


@pytest.mark.slow
def test_paths_of_prm_star_approach_the_shortest():
    robot = planar_arm()
    costs, best = [], []
    for seed in range(4):
        rng = np.random.default_rng(seed)
        angles, reach = rng.uniform(-2.0, 2.0, 3), rng.uniform(1.2, 1.8, 3)
        scene = cs.Scene(
            [cs.Sphere(0.15, [r * np.cos(a), r * np.sin(a), 0]) for r, a in zip(reach, angles, strict=True)]
        )
        q = robot.random_configuration(200, rng=seed)
        free = q[~robot.collides(q, scene, margin=0.05)]
        apart = free[np.argmax(np.linalg.norm(free - free[0], axis=1))]
        grid = shortest_on_grid(robot, scene, free[0], apart, 61)
        if not np.isfinite(grid):
            continue
        space = ArmSpace(robot, scene)
        row = [
            PRMStar(samples=n, simplify=False).plan(space, free[0], apart).cost for n in (150, 1200, 10000)
        ]
        costs.append(row)
        best.append(grid)
    rows = np.array(costs)
    finite = np.isfinite(rows).all(axis=1)
    means = rows[finite].mean(axis=0)
    assert finite.any()
    assert means[0] >= means[1] >= means[2]
    assert (rows[:, 2] <= 1.05 * np.array(best)).all()


def test_joints_without_limits_take_the_short_way():
    robot = wall_arm()
    plan = cs.plan(robot, [3.0, 0.5], [-3.0, 0.5], planner="lazy_prm", samples=100)
    np.testing.assert_allclose(plan.path[-1], [2 * np.pi - 3.0, 0.5])
    scene = cs.Scene([cs.Sphere(0.3, [-1.9, 0.0, 0.0])])
    around = cs.plan(robot, [2.4, 0.1], [-2.4, 0.1], scene, planner="lazy_prm", samples=300)
    assert around
    assert around.path[-1][0] == pytest.approx(2 * np.pi - 2.4) or around.path[-1][0] == -2.4
    assert judge_path(robot, scene, around.path) > -oracle.BAND


@pytest.mark.parametrize("planner", PLANNERS)
def test_several_starts_and_goals_are_alternatives(planner):
    robot = wall_arm()
    scene = cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0])])
    starts, goals = [[1.0, 0.0], [2.0, 0.0]], [[0.0, 0.0], [2.5, 0.2], [-1.0, 0.3]]
    plan = cs.plan(robot, starts, goals, scene, planner=planner, samples=200)
    assert plan
    assert (plan.start, plan.goal) == (1, 1)
    target = robot.fk([-1.2, 0.9])
    pose = cs.plan(robot, [1.0, 0.0], target, scene, planner=planner, samples=200)
    np.testing.assert_allclose(robot.fk(pose.path[-1]), target, atol=1e-9)
    many = cs.plan_many(robot, starts, [target, [2.5, 0.2]], scene, planner=planner, samples=200, threads=2)
    for k, goal in enumerate((target, [2.5, 0.2])):
        alone = cs.plan(robot, starts[k], goal, scene, planner=planner, samples=200)
        np.testing.assert_array_equal(many[k].path, alone.path)


def shut_in():
    """The planar arm between two balls that it cannot pass, with a way only inside one sector."""
    cage = [cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0], name=f"ball_{t}") for t in (0.5, 1.5)]
    return wall_arm(), cs.Scene(cage)


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_failure_says_how_far_the_roadmap_leads(planner):
    robot, scene = shut_in()
    space, ends = ArmSpace(robot, scene), ([1.0, 0.0], [-2.0, 0.0])
    plan = find_planner(planner, {"samples": 200}).plan(space, *ends)
    assert plan.status == "undetermined"
    assert "the roadmap joins the start with" in plan.reason
    assert "they come within" in plan.reason
    assert "more samples (samples=) may join them" in plan.reason
    assert "blocked" in plan.reason
    for edges in (0, 1, 7):
        few = find_planner(planner, {"samples": 200, "edges": edges}).plan(space, *ends)
        assert few.status == "undetermined"
        assert f"the edge budget was used up after {edges} motions" in few.reason
    assert cs.plan(robot, [2.0, 0.0], [2.5, 0.0], scene, planner=planner, samples=1)
    for make in (
        lambda: Roadmap(robot, samples=0),
        lambda: cs.plan(robot, [2.0, 0.0], [2.5, 0.0], scene, planner=planner, samples=0),
    ):
        with pytest.raises(InputError, match="samples is 0; it must be 1 to"):
            make()


def test_an_end_that_sees_no_node_is_joined_by_trees():
    """The goal is in a tunnel, where no sample lies and no sample sees it."""
    robot = planar_arm()
    walls = [cs.Box([0.3, 0.02, 0.2], [2.0, y, 0.0], name=f"wall_{y}") for y in (-0.07, 0.07)]
    space, goal = ArmSpace(robot, cs.Scene(walls)), [0.0, 0.0]
    roadmap = Roadmap(robot, samples=40, neighbours=4)
    assert not any(space.edge(goal, q) for q in roadmap.nodes)
    for start, end in (([1.5, 1.0], goal), (goal, [1.5, 1.0])):
        lazy, full = (
            kind(roadmap=roadmap, simplify=False).plan(space, start, end) for kind in (LazyPRM, PRM)
        )
        assert lazy
        assert lazy.stats["samples"] > 0
        np.testing.assert_array_equal(lazy.path, full.path)
        assert judge_path(robot, space.scene, lazy.path) > -oracle.BAND


def test_time_limits_and_interrupts_are_heeded():
    robot, scene = shut_in()
    roadmap = Roadmap(robot, samples=20000)
    for planner in (PRM, LazyPRM):
        begin = time.perf_counter()
        plan = planner(roadmap=roadmap, time_limit=0.002).plan(
            ArmSpace(robot, scene), [1.0, 0.0], [-2.0, 0.0]
        )
        assert time.perf_counter() - begin < 1.0
        assert not plan
        assert "time limit" in plan.reason
    six = cs.load_robot("ur5e", geometry="skeleton")
    begin = time.perf_counter()
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            Roadmap(six, samples=1 << 18)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    assert time.perf_counter() - begin < 2.0


BAD = {
    "samples": (lambda r, s: Roadmap(r, samples=-1), InputError, "samples is -1"),
    "neighbours": (lambda r, s: Roadmap(r, neighbours=0), InputError, "neighbours is 0"),
    "margin": (lambda r, s: Roadmap(r, margin=-1.0), InputError, "margin is -1"),
    "whole": (lambda r, s: Roadmap(r, samples=1.5), InputTypeError, "whole number"),
    "bare": (lambda r, s: Roadmap(cs.load_robot("ur3")), InputError, "collision geometry"),
    "more": (lambda r, s: Roadmap(r, samples=4).extend(-1), InputError, "samples is -1"),
    "option": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner="prm", samples=-1),
        InputError,
        "samples is",
    ),
    "kind": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner="prm", roadmap=5),
        InputTypeError,
        "roadmap is given by the path",
    ),
    "robot": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner="prm", roadmap=Roadmap(thicker(r), samples=9)),
        InputError,
        "roadmap is of planar_2r, and the plan is of planar_2r with other joints",
    ),
    "gap": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner="prm", margin=0.01, roadmap=Roadmap(r, samples=9)),
        InputError,
        r"the margin 0 m, and the plan needs 0\.01 m",
    ),
    "star": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner="prm_star", roadmap=Roadmap(r, samples=9)),
        InputError,
        "make it with neighbours=None",
    ),
    "start": (
        lambda r, s: cs.plan(r, [0, 0], [2, 0], s, planner="lazy_prm", samples=9),
        InputError,
        "touches",
    ),
}


def thicker(robot):
    """The planar arm with other spheres."""
    return robot.with_spheres({"link_1": [[0.5, 0, 0, 0.1]], "link_2": [[0.5, 0, 0, 0.1]]})


@pytest.mark.parametrize("name", BAD)
def test_bad_input_gets_an_error_that_names_it(name):
    call, kind, message = BAD[name]
    with pytest.raises(kind, match=message):
        call(wall_arm(), cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0], name="ball")]))


@pytest.mark.data
def test_one_roadmap_serves_published_problems():
    robot, _ = published_robot("panda")
    roadmap = Roadmap(robot, samples=2000)
    solved = valid = 0
    for k, (_, _, scene, start, goals) in enumerate(problems("panda")):
        if k % 25:
            continue
        plan = LazyPRM(roadmap=roadmap).plan(ArmSpace(robot, scene), start, goals)
        if plan.status.startswith("invalid"):
            continue
        valid += 1
        solved += bool(plan)
        if plan:
            assert robot.clearance(plan.sample(1.0 / 320.0), scene).distance.min() > -oracle.BAND
    assert solved >= 0.8 * valid
