"""Plans of arms: paths judged at a hundred times the resolution, and failures with their causes."""

import itertools
import json
import time

import numpy as np
import pytest

import cspace as cs
from collision.cells import random_robot, random_scene
from collision.motion_bench import ROBOTS, problems, published_robot
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.planning import PLANNERS, ArmSpace, RRTConnect
from oracles import collision as oracle

SEEDS = range(10)
FINE = 1.0 / 32.0 / 100.0


def judge_path(robot, scene, path):
    """The least clearance of a path at samples, by the oracle in double; sparse where there is room."""
    least = np.inf
    for a, b in itertools.pairwise(path):
        n = max(2, int(np.ceil(np.linalg.norm(b - a) / FINE)))
        rows = a + np.linspace(0, 1, n)[:, None] * (b - a)
        distances = robot.clearance(rows, scene).distance
        least = min(least, distances.min())
        middle = rows[int(np.argmin(distances))]
        by_spheres = oracle.clearance(robot, middle, scene)[0]
        if len(robot.collision.solids):  # spheres only cover them
            assert by_spheres < distances.min() + 1e-9
        else:
            assert by_spheres == pytest.approx(distances.min(), abs=1e-9)
    return least


def cell(seed):
    """A random robot in a random scene, and at least a dozen free configurations."""
    for attempt in range(100):
        rng = np.random.default_rng([seed, attempt])
        robot = random_robot(1000 * seed + attempt, n=7, spheres=2)
        if not np.isfinite(robot.limits.lower[list(robot.collision.prismatic)]).all():
            continue
        scene = random_scene(rng, 10)
        q = robot.random_configuration(400, rng=seed, reach=1.0)
        free = q[~robot.collides(q, scene, margin=0.01)]
        if robot.dof > 1 and 12 <= len(free) <= 300:
            return robot, scene, free
    raise AssertionError("no random scene leaves room")


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_a_path_is_free_and_begins_and_ends_as_told(seed):
    robot, scene, free = cell(seed)
    found = 0
    for a, b in zip(free[:6:2], free[1:6:2], strict=False):
        plan = cs.plan(robot, a, b, scene, edges=20000)
        assert plan.status in ("found", "undetermined")
        if not plan:
            assert "used up" in plan.reason
            continue
        found += 1
        assert plan.certified
        np.testing.assert_array_equal(plan.path[0], a)
        turns = (plan.path[-1] - b) / (2 * np.pi)
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
        assert (plan.start, plan.goal) == (0, 0)
        assert plan.cost == pytest.approx(np.linalg.norm(np.diff(plan.path, axis=0), axis=1).sum(), rel=1e-6)
        assert judge_path(robot, scene, plan.path) > -oracle.BAND
        assert plan.clearance > -oracle.BAND
        for p, q in itertools.pairwise(plan.path):
            assert robot.edge(p, q, scene)
        again = cs.plan(robot, a, b, scene, edges=20000)
        np.testing.assert_array_equal(again.path, plan.path)
    assert found


@pytest.mark.parametrize("gap", [0.01, 0.005, 0.004])
def test_an_arm_finds_its_way_out_of_a_slot(gap):
    """The last link of a planar arm lies between two plates: it has to be pulled straight out."""
    robot, rng = cs.load_robot("planar_3r"), np.random.default_rng(3)
    for _ in range(8):
        while True:
            q, goal = robot.random_configuration(2, rng=rng)
            T = robot.fk_all(q)[-2]
            sides = [T @ cs.pose([0.35, side * (0.06 + gap), 0]) for side in (1, -1)]
            scene = cs.Scene([cs.Box([0.6, 0.02, 0.4], T_side) for T_side in sides])
            if abs(q[2]) < 2 and not robot.collides([q, goal], scene).any():  # a folded one may be shut in
                break
        plan = cs.plan(robot, q, goal, scene)
        assert plan, plan.reason
        assert judge_path(robot, scene, plan.path) > -oracle.BAND


@pytest.mark.parametrize("seed", range(4))
def test_many_plans_are_those_of_each_alone(seed):
    robot, scene, free = cell(seed)
    starts, goals = free[:6], free[6:12]
    alone = [cs.plan(robot, a, b, scene, edges=3000) for a, b in zip(starts, goals, strict=True)]
    for threads in (1, 2, 0):
        many = cs.plan_many(robot, starts, goals, scene, edges=3000, threads=threads)
        assert many.status == tuple(p.status for p in alone)
        for one, other, row in zip(many, alone, many.path, strict=True):
            np.testing.assert_array_equal(one.path, other.path)
            np.testing.assert_array_equal(row[: len(one)], other.path)
            assert np.isnan(row[len(one) :]).all()
    assert len(many[:2]) == 2


def wall_arm():
    """The planar arm with a sphere at the tip and along the links, and a wall that it must pass around."""
    rows = [[x, 0, 0, 0.05] for x in np.linspace(0, 1, 21)]
    return cs.load_robot("planar_2r").with_spheres({"link_1": rows, "link_2": rows})


def test_all_ik_solutions_of_a_pose_are_goals():
    robot = wall_arm()
    scene = cs.Scene([cs.Box([0.2, 0.6, 1.0], [1.3, 0.75, 0], name="wall")])
    start, target = [0.3, -1.0], robot.fk([1.2, 0.9])
    plan = cs.plan(robot, start, target, scene)
    assert plan
    np.testing.assert_allclose(robot.fk(plan.path[-1]), target, atol=1e-9)
    part = cs.plan(robot, start, {"position": target[:3, 3]}, scene)
    np.testing.assert_allclose(robot.fk(part.path[-1])[:3, 3], target[:3, 3], atol=1e-9)
    free = [q for q in robot.ik(position=target[:3, 3]).q if not robot.collides(q, scene)]
    best = min(cs.plan(robot, start, q, scene).cost for q in free)
    assert part.cost <= 1.5 * best


def test_what_cannot_be_reached_says_why():
    robot = wall_arm()
    start = [0.3, -1.0]
    far = cs.plan(robot, start, {"position": [5.0, 0.0, 0.0]})
    assert (far.status, bool(far), len(far)) == ("unreachable", False, 0)
    assert "no IK solution" in far.reason
    goal = [0.0, 1.9, 0.0]
    blocked = cs.plan(robot, start, {"position": goal}, cs.Scene([cs.Sphere(0.1, goal, name="ball")]))
    assert blocked.status == "unreachable"
    assert "IK solutions within limits touch something: link_2 touches ball" in blocked.reason
    six = cs.load_robot("ur5e", geometry="skeleton")
    deep = cs.Scene([cs.Box([0.8, 0.8, 0.8], [0.6, 0.0, 0.6], name="block")])
    open_goal = cs.plan(six, np.radians([180, -90, 90, -90, -90, 0]), {"position": [0.6, 0.0, 0.6]}, deep)
    assert open_goal.status == "undetermined"
    assert "no free configuration was found: of 4096 poses that meet the goal" in open_goal.reason
    assert "touches block" in open_goal.reason
    hard = cs.plan(
        robot, start, [2.5, 0.3], cs.Scene([cs.Box([0.05, 1.0, 1.0], [0.0, 1.3, 0.0], name="bar")]), edges=50
    )
    if not hard:
        assert hard.status == "undetermined"
        assert "used up" in hard.reason
    cage = [cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0]) for t in (0.5, 1.5)]
    shut = RRTConnect(edges=2000).plan(ArmSpace(robot, cs.Scene(cage)), [1.0, 0.0], [-2.0, 0.0])
    assert shut.status == "undetermined"
    assert "the trees came within" in shut.reason
    assert "blocked" in shut.reason


def test_joints_without_limits_take_the_short_way():
    robot = wall_arm()
    plan = cs.plan(robot, [3.0, 0.5], [-3.0, 0.5])
    assert plan.cost == pytest.approx(2 * np.pi - 6.0)
    np.testing.assert_allclose(plan.path[-1], [2 * np.pi - 3.0, 0.5])


def test_several_starts_and_goals_are_alternatives():
    robot = wall_arm()
    scene = cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0])])
    plan = cs.plan(robot, [[1.0, 0.0], [2.0, 0.0]], [[0.0, 0.0], [2.5, 0.2]], scene)
    assert plan
    assert plan.goal == 1
    np.testing.assert_array_equal(plan.path[-1], [2.5, 0.2])
    assert plan.start in (0, 1)


def test_start_and_goal_may_be_the_same():
    robot = wall_arm()
    plan = cs.plan(robot, [1.0, 0.0], [1.0, 0.0])
    assert plan
    assert plan.cost == 0.0
    np.testing.assert_array_equal(plan.path[[0, -1]], [[1.0, 0.0]] * 2)


BAD = {
    "start": (
        lambda r, s: cs.plan(r, [0, 0], [2, 0], s),
        InputError,
        "start: link_2 touches ball, .* mm deep",
    ),
    "goal": (lambda r, s: cs.plan(r, [2, 0], [0, 0], s), InputError, "goal: link_2 touches ball"),
    "shape": (lambda r, s: cs.plan(r, [0, 0, 0], [2, 0], s), InputError, "start has shape"),
    "nan": (lambda r, s: cs.plan(r, [0, 0], [np.nan, 0], s), InputError, "goal holds nan"),
    "word": (lambda r, s: cs.plan(r, [2, 0], "home", s), UnknownNameError, "no named pose .home."),
    "none": (lambda r, s: cs.plan(r, [2, 0], None, s), InputTypeError, "goal is a NoneType"),
    "no start": (lambda r, s: cs.plan(r, None, [2, 0], s), InputError, "start has shape"),
    "ragged": (lambda r, s: cs.plan(r, [2, 0], [[1], [1, 2]], s), InputTypeError, "goal must be numbers"),
    "position": (lambda r, s: cs.plan(r, [2, 0], [1, 0, 0], s), InputError, '{"position": goal}'),
    "poses": (lambda r, s: cs.plan(r, [2, 0], np.tile(np.eye(4), (2, 1, 1, 1)), s), InputTypeError, "poses"),
    "step": (lambda r, s: cs.plan(r, [2, 0], [2, 1], s).sample(0), InputError, "step is 0; it must be"),
    "part": (lambda r, s: cs.plan(r, [2, 0], {"positon": [1, 0, 0]}, s), UnknownNameError, "'position'"),
    "planner": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner="rrt_conect"),
        UnknownNameError,
        "rrt_connect",
    ),
    "class": (
        lambda r, s: cs.plan(r, [2, 0], [2, 1], s, planner=RRTConnect),
        InputTypeError,
        "give an object",
    ),
    "option": (lambda r, s: cs.plan(r, [2, 0], [2, 1], s, rnge=1.0), InputTypeError, "range"),
    "value": (lambda r, s: cs.plan(r, [2, 0], [2, 1], s, range=0.0), InputError, "range is 0"),
    "seed": (lambda r, s: cs.plan(r, [2, 0], [2, 1], s, rng=-1), InputError, "seed"),
    "margin": (lambda r, s: cs.plan(r, [2, 0], [2, 1], s, margin=-1), InputError, "margin"),
    "robot": (lambda r, s: cs.plan("ur5e", [2, 0], [2, 1], s), InputTypeError, "it must be a cspace.Robot"),
    "pose": (lambda r, s: cs.plan(r, [2, 0], np.full((4, 4), np.nan), s), InputError, "nan"),
    "goals": (lambda r, s: cs.plan_many(r, [2, 0], 5, s), InputTypeError, "a list of goals"),
    "one goal of many": (
        lambda r, s: cs.plan_many(r, [[2, 0]] * 2, [2, 1], s),
        InputError,
        "one goal per problem",
    ),
    "space": (lambda r, s: ArmSpace("ur5e"), InputTypeError, "robot is a str; it must be a Robot"),
    "space of a planner": (lambda r, s: RRTConnect().plan(r, [2, 0], [2, 1]), InputTypeError, "ArmSpace"),
    "many": (lambda r, s: cs.plan_many(r, [[2, 0]] * 2, [[2, 1]] * 3, s), InputError, "2 starts and 3 goals"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_gets_an_error_that_names_it(name):
    call, kind, message = BAD[name]
    with pytest.raises(kind, match=message):
        call(wall_arm(), cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0], name="ball")]))


def test_problems_of_a_batch_have_a_status_each():
    robot = wall_arm()
    scene = cs.Scene([cs.Sphere(0.2, [2.0, 0.0, 0.0], name="ball")])
    many = cs.plan_many(robot, [[2, 0], [0, 0], [2, 0]], [[3, 0], [1, 1], {"position": [2, 0, 0]}], scene)
    assert many.status == ("found", "invalid_start", "unreachable")
    assert "link_2 touches ball" in many[1].reason
    np.testing.assert_array_equal(many.found, [True, False, False])
    assert many.corners[0] == 2
    assert np.isinf(many.cost[1])


def test_rows_are_the_same_however_they_are_written():
    space = ArmSpace(random_robot(3))
    row = np.linspace(-0.5, 0.5, space.dof)
    for given in (
        row,
        row.tolist(),
        tuple(row),
        [row],
        [row.tolist()],
        row[None],
        np.asfortranarray([row, row])[:1],
    ):
        found = space.as_rows(given, "start")
        np.testing.assert_array_equal(found, row[None])
        assert found.dtype == np.float64
        assert found.flags.c_contiguous
    whole = [1] * space.dof
    np.testing.assert_array_equal(space.as_rows([whole, whole], "start"), np.ones((2, space.dof)))
    for bad in (
        [np.nan] * space.dof,
        [1e300] * space.dof,
        [[*whole, 1.0]],
        [whole, [1.0]],
        [],
        np.zeros((0, space.dof)),
    ):
        with pytest.raises((InputError, InputTypeError), match="start"):
            space.as_rows(bad, "start")


def test_a_time_limit_is_heeded():
    robot = wall_arm()
    cage = [cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0]) for t in (0.5, 1.5)]
    begin = time.perf_counter()
    plan = cs.plan(robot, [1.0, 0.0], [-2.0, 0.0], cs.Scene(cage), time_limit=0.05)
    assert plan.status == "undetermined"
    assert "time limit" in plan.reason
    assert time.perf_counter() - begin < 5.0


def test_options_are_in_force():
    robot = wall_arm()
    space = ArmSpace(robot, cs.Scene([cs.Sphere(0.3, [1.5, 0.9, 0.0])]))
    raw = PLANNERS["rrt_connect"].with_options({"simplify": False}).plan(space, [-0.5, 0.5], [2.0, 0.5])
    short = RRTConnect().plan(space, [-0.5, 0.5], [2.0, 0.5])
    proved = RRTConnect(search="proved").plan(space, [-0.5, 0.5], [2.0, 0.5])
    assert raw.cost >= short.cost
    assert proved.certified
    assert not RRTConnect(certify=False).plan(space, [-0.5, 0.5], [2.0, 0.5]).certified
    other = RRTConnect().plan(space, [-0.5, 0.5], [2.0, 0.5], rng=7)
    assert other


@pytest.mark.slow
@pytest.mark.data
@pytest.mark.parametrize("name", ROBOTS)
def test_published_problems_are_solved_and_their_paths_are_free(name):
    robot, _ = published_robot(name)
    for k, (group, index, scene, start, goals) in enumerate(problems(name)):
        if k % 25:
            continue
        plan = RRTConnect().plan(ArmSpace(robot, scene), start, goals)
        if plan.status.startswith("invalid"):
            continue
        assert plan, f"{group} {index}: {plan.reason}"
        rows = plan.sample(1.0 / 320.0)
        assert robot.clearance(rows, scene).distance.min() > -oracle.BAND


def test_a_path_is_saved_in_every_format(tmp_path):
    robot = cs.load_robot("ur5e")
    plan = cs.plan(robot, "home", "up")
    for ending in ("json", "yaml", "csv"):
        plan.save(tmp_path / f"way.{ending}")
    found = json.loads((tmp_path / "way.json").read_text(encoding="utf-8"))
    assert found["path"] == plan.path.tolist()
    assert (found["robot"], found["joints"]) == ("ur5e", list(robot.joint_names))
    rows = np.loadtxt(tmp_path / "way.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(rows, plan.path)
    with pytest.raises(InputError, match=r"\.txt'; its name must end with one of \.yaml"):
        plan.save(tmp_path / "way.txt")
    with pytest.raises(InputError, match="no path to save: no IK solution"):
        cs.plan(robot, "home", {"position": [9, 0, 0]}).save(tmp_path / "way.json")


def test_names_of_other_libraries_are_explained():
    plan = cs.plan(cs.load_robot("ur5e"), "home", "up")
    for name, remedy in {"waypoints": "path has", "length": "use cost", "success": "is truthy"}.items():
        with pytest.raises(AttributeError, match=f"'{name}'; .*{remedy}"):
            getattr(plan, name)


def test_errors_of_starts_name_what_helps():
    robot = cs.load_robot("ur5e")
    table = cs.Scene([cs.Box([1.0, 1.0, 0.1], [0.0, 0.0, -0.04], name="table")])
    with pytest.raises(InputError, match=r"no joint moves either; permit it by scene\.allow\('base_link"):
        cs.plan(robot, "up", "home", table)
    assert cs.plan(robot, "up", "home", table.allow("base_link_inertia", "table"))
    with pytest.raises(InputError, match=r"at -90 rad, outside its limits [-0-9. to]+$"):
        cs.plan(robot, [0, -90, 0, 0, 0, 0], "home")
    with pytest.raises(InputError, match=r"closer to .* than the margin of 50 mm; robot\.escape"):
        cs.plan(robot, "home", "up", margin=0.05)
