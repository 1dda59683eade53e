"""Plans of many problems: each is that of plan alone, on any number of threads, whenever it is read."""

import pickle
import signal
import sys
import time

import numpy as np
import pytest

import cspace as cs
from cspace._core import set_deadline
from cspace.planning import (
    ArmPlanner,
    ArmSpace,
    LazyPRM,
    Plan,
    Plans,
    PotentialField,
    Region,
    Roadmap,
    RRTConnect,
    RRTStar,
)
from planning.test_rrt_connect import wall_arm

SEEDS = range(4)
SCENE = cs.Scene([cs.Box([0.2, 0.6, 1.0], [1.3, 0.75, 0], name="wall"), cs.Sphere(0.2, [-1.2, 0.3, 0])])
PLANNERS = {
    "rrt_connect": RRTConnect(edges=3000),
    "rrt_star": RRTStar(edges=500, improve=50),
    "lazy_prm": LazyPRM(samples=300, edges=3000),
    "potential_field": PotentialField(),
}
TIMES = ("search_seconds", "simplify_seconds", "proof_seconds", "improve_seconds")
LATE = 0.3
"""What a limited call may take in all [s]: without a limit each takes several times as long."""


def draw_problems(robot, count, seed):
    """Starts that are free and one that is not, and goals of all kinds: some in the wall or out of reach."""
    rng = np.random.default_rng(seed)
    q = robot.random_configuration(20 * count, rng=rng)
    free = q[~robot.collides(q, SCENE)]
    starts, ends = free[:count].copy(), q[-count:]
    starts[count // 2] = q[robot.collides(q, SCENE)][0]
    kinds = [
        lambda end: end,
        lambda end: np.array([end, *q[:2]]),
        robot.fk,
        lambda end: {"position": robot.fk(end)[:3, 3]},
        lambda end: Region(box=([0.4, 0.4, 0.1], robot.fk(end)[:3, 3])),
        lambda end: {"position": [5.0, 0.0, 0.0]},
    ]
    return starts, [kinds[k % len(kinds)](end) for k, end in enumerate(ends)]


def plan_alone(robot, start, goal, **options):
    """The plan of one problem; where the start or goal is refused, the reason instead."""
    try:
        return cs.plan(robot, start, goal, SCENE, **options)
    except cs.errors.InputError as error:
        return str(error)


def agree(one, other):
    """Whether two plans are the same but for the seconds that they took. What a roadmap knows of a scene
    already saves blocks, and a failure names what blocked the rest."""
    knows = isinstance(one.planner, LazyPRM)
    for name in ("status", "cost", "start", "goal", "certified", "planner"):
        assert getattr(one, name) == getattr(other, name), name
    assert one.reason == other.reason or (knows and not one)
    np.testing.assert_array_equal(one.path, other.path)
    rest = [each.stats.get("rest") for each in (one, other)]
    assert (rest[0] is None) == (rest[1] is None)
    if rest[0] is not None:
        assert repr(rest[0]) == repr(rest[1])
    varied = {*TIMES, "rest", *(("blocks",) if knows else ())}
    counts = [{k: v for k, v in p.stats.items() if k not in varied} for p in (one, other)]
    assert counts[0] == counts[1]
    return True


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", PLANNERS)
def test_each_plan_is_the_one_that_is_found_alone(name, seed):
    robot, planner = wall_arm(), PLANNERS[name]
    starts, goals = draw_problems(robot, 12, seed)
    alone = [plan_alone(robot, a, b, planner=planner, rng=seed) for a, b in zip(starts, goals, strict=True)]
    for threads in (1, 2, 3):
        many = cs.plan_many(robot, starts, goals, SCENE, planner=planner, rng=seed, threads=threads)
        for k, one in enumerate(alone):
            if isinstance(one, str):
                assert many.status[k] in ("invalid_start", "invalid_goal")
                assert one.startswith(many[k].reason)
                assert not len(many[k])
            else:
                assert agree(many[k], one)
    assert len(set(many.status)) > 2


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_arrays_of_configurations_are_planned_as_a_list_is(threads):
    robot = wall_arm()
    starts, goals = robot.random_configuration(2 * 20, rng=5).reshape(2, 20, 2)
    options = {"edges": 2000, "threads": threads}
    as_array = cs.plan_many(robot, starts, goals, SCENE, **options)
    as_list = cs.plan_many(robot, starts.tolist(), list(goals), SCENE, **options)
    assert as_array.status == as_list.status
    assert all(map(agree, as_array, as_list))
    one_start = cs.plan_many(robot, starts[0], goals, SCENE, **options)
    repeated = cs.plan_many(robot, np.tile(starts[0], (20, 1)), goals, SCENE, **options)
    assert all(map(agree, one_start, repeated))


@pytest.mark.parametrize("name", ["panda", "ur5e"])
def test_arrays_of_poses_are_planned_as_each_alone(name):
    """Of poses on a table, in it, below it and out of reach: solved at once, on threads."""
    robot = cs.load_robot(name, geometry="skeleton")
    scene = cs.Scene([cs.Box([1.0, 2.0, 0.3], [0.6, 0.0, 0.1], name="table")])
    q = robot.random_configuration(300, rng=7)
    start = q[~robot.collides(q, scene)][0]
    T = robot.fk(q)
    low = T[T[:, 2, 3] < 0.2][:15]
    far = T[:2] @ cs.pose([0, 0, 5.0])
    poses = np.concatenate([T[:25], low, far])
    options = {"edges": 2000, "rng": 3}
    alone = [cs.plan(robot, start, pose, scene, **options) for pose in poses]
    for threads in (1, 2, 3):
        many = cs.plan_many(robot, start, poses, scene, threads=threads, **options)
        assert all(map(agree, many, alone))
    assert {"found", "unreachable"} <= set(many.status)
    wrong = poses.copy()
    wrong[5, :3, :3] *= 2.0
    with pytest.raises(cs.errors.InputError, match="goal"):
        cs.plan_many(robot, start, wrong, scene)


def made_plans(plans):
    """How many plans were made so far."""
    return sum(each is not None for each in plans._source._plans)


@pytest.mark.parametrize("seed", SEEDS)
def test_plans_read_late_and_in_any_order_are_those_read_at_once(seed):
    robot = wall_arm()
    starts, goals = draw_problems(robot, 12, seed)
    ends = np.array([end if np.shape(end) == (2,) else [0.5, 0.5] for end in goals])
    for wanted in (ends, goals):
        given = np.array(starts), np.array(wanted) if wanted is ends else wanted
        lazy = cs.plan_many(robot, *given, SCENE, edges=2000)
        eager = Plans(list(cs.plan_many(robot, starts, wanted, SCENE, edges=2000)))
        before = made_plans(lazy)
        assert before < len(lazy)
        assert lazy.status == eager.status
        for name in ("cost", "corners", "found", "path"):
            np.testing.assert_array_equal(getattr(lazy, name), getattr(eager, name))
        assert repr(lazy) == repr(eager)
        assert lazy._repr_html_() == eager._repr_html_()
        assert len(lazy) == len(eager) == 12
        given[0][:] = np.nan  # what is read later does not depend on the arrays that were given
        if wanted is ends:
            given[1][:] = np.nan
            assert made_plans(lazy) == 0
        for k in np.random.default_rng(seed).permutation(range(-12, 12)):
            assert agree(lazy[k], eager[k])
            assert lazy[k] is lazy[int(k) % 12]
        assert all(map(agree, lazy, eager))


def test_slices_are_plans_of_the_same_problems():
    robot = wall_arm()
    starts, goals = draw_problems(robot, 12, 0)
    plans = cs.plan_many(robot, starts, goals, SCENE, edges=2000)
    for part in (slice(2, 7), slice(None, None, -3), slice(9, 2, -2), slice(5, 5), slice(-4, 100)):
        some, numbers = plans[part], range(12)[part]
        assert isinstance(some, Plans)
        assert some.status == tuple(plans.status[k] for k in numbers)
        np.testing.assert_array_equal(some.cost, plans.cost[part])
        np.testing.assert_array_equal(some.found, plans.found[part])
        most = max((plans.corners[k] for k in numbers), default=0)
        np.testing.assert_array_equal(some.path, plans.path[part][:, :most])
        assert [some[n] is plans[k] for n, k in enumerate(numbers)] == [True] * len(numbers)
        assert [some[1:][n] is plans[k] for n, k in enumerate(numbers[1:])] == [True] * len(numbers[1:])
    assert len(list(reversed(plans))) == 12
    assert plans[3] in plans
    assert plans.index(plans[3]) == 3
    for wrong in (12, -13):
        with pytest.raises(IndexError):
            plans[wrong]
    with pytest.raises(TypeError):
        plans["status"]


@pytest.mark.parametrize("name", PLANNERS)
def test_plans_are_pickled_with_their_spaces(name):
    robot = wall_arm()
    starts, goals = draw_problems(robot, 8, 1)
    plans = cs.plan_many(robot, starts, goals, SCENE, planner=PLANNERS[name])
    again = pickle.loads(pickle.dumps(plans))
    assert all(map(agree, again, plans))
    assert again.status == plans.status
    found = int(np.flatnonzero(plans.found)[0])
    assert again[found].clearance == pytest.approx(plans[found].clearance, abs=1e-12)
    assert again[0].space is again[1].space
    with_map = LazyPRM(roadmap=Roadmap(robot, samples=50))
    plan = pickle.loads(pickle.dumps(cs.plan(robot, [2.5, 0.1], [2.0, 0.2], SCENE, planner=with_map)))
    np.testing.assert_array_equal(plan.planner.roadmap.nodes, with_map.roadmap.nodes)
    np.testing.assert_array_equal(plan.planner.roadmap.edges, with_map.roadmap.edges)


class Straight(ArmPlanner):
    """A planner of a user: the straight motion."""

    def plan(self, space, starts, goals, *, rng=0):
        """See ArmPlanner."""
        path = np.array([np.atleast_2d(starts)[0], np.atleast_2d(goals)[0]])
        cost = float(np.linalg.norm(path[1] - path[0]))
        return Plan("found", "straight", path, cost, 0, 0, False, {}, space, self)


def test_planners_of_users_plan_many():
    robot = wall_arm()
    starts, goals = draw_problems(robot, 12, 2)
    plans = cs.plan_many(robot, starts, goals, SCENE, planner=Straight())
    assert {"found", "unreachable"} <= set(plans.status)
    np.testing.assert_array_equal(plans[0].path, [starts[0], goals[0]])
    each = Straight().plan_each(ArmSpace(robot, SCENE), [(starts[0], goals[0])] * 3)
    assert [len(plan) for plan in each] == [2, 2, 2]


def test_no_problem_has_no_plans():
    robot = wall_arm()
    for goals in ([], np.empty((0, 2))):
        plans = cs.plan_many(robot, [2.0, 0.0], goals, SCENE)
        assert len(plans) == 0
        assert plans.path.shape == (0, 0, 2)
        assert plans.status == ()
        assert list(plans) == []
        assert "0 problems" in repr(plans)


def hopeless_problem():
    """The planar arm between two balls that it cannot pass: starts inside and outside, and goals outside."""
    cage = [cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0], name=f"ball_{t}") for t in (0.5, 1.5)]
    return wall_arm(), cs.Scene(cage), [1.0, 0.0], np.array([[2.0, 0.0], [-2.0, 0.0], [2.5, 0.1]])


@pytest.mark.skipif(sys.platform == "win32", reason="no timer signals there")
@pytest.mark.parametrize("place", [0, 1, 2])
def test_an_interrupt_ends_the_search_for_the_last_problem_on_any_thread(place):
    robot, scene, inside, goals = hopeless_problem()
    starts = goals[::-1].copy()
    starts[place] = inside
    before = cs.plan_many(robot, starts, goals, scene, edges=500)
    assert before.status[place] == "unreachable"
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        for _ in range(5):
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            begin = time.perf_counter()
            with pytest.raises(KeyboardInterrupt):
                cs.plan_many(robot, starts, goals, scene, edges=1 << 40, threads=2)
            assert time.perf_counter() - begin < LATE
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    assert all(map(agree, cs.plan_many(robot, starts, goals, scene, edges=500), before))


def blocked_goals():
    """A Panda, a scene whose cube holds a region, and a start; the search for goals takes 0.1 s and more."""
    robot = cs.load_robot("panda", geometry="skeleton")
    scene = cs.Scene([cs.Box([0.6, 0.6, 0.6], [0.5, 0.0, 0.5], name="cube")])
    q = robot.random_configuration(100, rng=3)
    start = q[~robot.collides(q, scene)][0]
    region = Region(box=([0.2, 0.2, 0.2], [0.5, 0.0, 0.5]), direction=[0, 0, -1], within=0.3)
    return robot, scene, start, [region, {"position": [0.5, 0.0, 0.5], "direction": [0, 0, -1]}]


def test_the_time_limit_counts_for_configurations_of_goals():
    robot, scene, start, goals = blocked_goals()
    for goal in goals:
        whole = cs.plan(robot, start, goal, scene, time_limit=60.0)
        assert "of 4096 poses" in whole.reason
        begin = time.perf_counter()
        plan = cs.plan(robot, start, goal, scene, time_limit=0.002)
        assert time.perf_counter() - begin < 0.06
        assert plan.status == "undetermined"
        assert "the time limit was used up before a configuration of the goal was found" in plan.reason
    begin = time.perf_counter()
    plans = cs.plan_many(robot, start, [*goals, start + 0.01], scene, time_limit=0.002)
    assert time.perf_counter() - begin < 0.15
    assert plans.status == ("undetermined", "undetermined", "found")
    assert set(plans[k].reason for k in (0, 1)) == {plan.reason}
    assert set_deadline(np.inf) == np.inf  # none is left behind


def test_a_plan_to_a_pose_within_the_limit_is_the_one_without():
    robot, scene, start, _ = blocked_goals()
    q = robot.random_configuration(50, rng=4)
    T = robot.fk(q[~robot.collides(q, scene)][:5])
    free = cs.plan_many(robot, start, T, scene)
    limited = cs.plan_many(robot, start, T, scene, time_limit=60.0)
    for one, other, pose in zip(free, limited, T, strict=True):
        np.testing.assert_array_equal(one.path, other.path)
        assert one.reason == other.reason
        alone = cs.plan(robot, start, pose, scene, time_limit=60.0)
        assert agree(alone, other)
        assert alone.planner.time_limit == 60.0


@pytest.mark.parametrize("planner", ["prm", "lazy_prm", "prm_star"])
def test_the_time_limit_counts_for_making_a_roadmap(planner):
    robot, scene, start, _ = blocked_goals()
    options = {"planner": planner, "samples": 100_000, "time_limit": 0.02}
    begin = time.perf_counter()
    plan = cs.plan(robot, start, start + 0.01, scene, **options)
    plans = cs.plan_many(robot, start, [start + 0.01] * 3, scene, **options)
    assert time.perf_counter() - begin < LATE
    assert plan.status == "undetermined"
    assert "before there was a roadmap" in plan.reason
    assert plans.status == ("undetermined",) * 3
    assert not robot.collision._kept.get("roadmaps")  # none is half made
    assert cs.plan(robot, start, start + 0.01, scene, planner=planner, samples=200, time_limit=60.0)


@pytest.mark.skipif(sys.platform == "win32", reason="no timer signals there")
def test_an_interrupt_ends_the_search_for_configurations_of_goals():
    robot, scene, start, goals = blocked_goals()
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        for limit in (np.inf, 60.0):
            signal.setitimer(signal.ITIMER_REAL, 0.03)
            begin = time.perf_counter()
            with pytest.raises(KeyboardInterrupt):
                cs.plan_many(robot, start, goals * 100, scene, time_limit=limit)
            assert time.perf_counter() - begin < LATE
            assert set_deadline(np.inf) == np.inf
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
