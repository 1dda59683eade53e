"""Potential fields: the potential beside a slow sum, descents that are free, and the name of every stop."""

import itertools

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.planning import STATUSES, ArmSpace, PotentialField, potential
from oracles import collision as oracle
from planning.test_grid_search import balls, few_joints, limited_arm
from planning.test_rrt_connect import cell, judge_path

SEEDS = range(8)
TYPED = ("goal", "minimum", "saddle", "crease", "wall", "budget", "time")


def ball_in_plane(obstacles, radius=0.05, side=1.0):
    """The space of a ball that two prismatic joints move along x and y."""
    links = [cs.model.Link(name) for name in ("base", "slide", "ball")]
    joints = [
        cs.model.Joint("x", "prismatic", "base", "slide", axis=(1, 0, 0), lower=-side, upper=side),
        cs.model.Joint("y", "prismatic", "slide", "ball", axis=(0, 1, 0), lower=-side, upper=side),
    ]
    robot = cs.Robot(cs.model.Description("ball_in_plane", links=links, joints=joints))
    return ArmSpace(robot.with_spheres({"ball": [[0, 0, 0, radius]]}), cs.Scene(obstacles))


def slow_potential(space, goal, q, gains):
    """The sum over spheres, obstacles and pairs of links, in numpy."""
    robot, scene = space.robot, space.scene
    geometry = robot.collision
    d = space.distance(q, goal)
    k, k_r, rho_0, cone, rho_links = (gains[name] for name in ("k", "k_r", "rho_0", "cone", "rho_links"))
    value = 0.5 * k * d**2 if d < cone else k * cone * (d - 0.5 * cone)

    def repel(rho, strength, influence):
        near = rho[rho < influence]
        return 0.5 * strength * ((1 / near - 1 / influence) ** 2).sum()

    centers, radii, links = oracle.sphere_places(robot, q)
    links = np.array(links)
    moving = np.array([name not in fixed_links(robot) for name in links], dtype=bool)
    allowed = {frozenset(pair) for pair in scene.allowed}
    for shape in scene.obstacles:
        counted = moving & [frozenset((name, shape.name)) not in allowed for name in links]
        rho = np.asarray(shape.distance(centers[counted])) - radii[counted] - space.margin
        value += repel(rho, k_r, rho_0)
    for a, b in geometry.pairs:
        one, other = links == geometry.links[a], links == geometry.links[b]
        apart = np.linalg.norm(centers[one][:, None] - centers[other][None], axis=-1)
        rho = apart - radii[one][:, None] - radii[other][None] - space.margin
        value += repel(rho.ravel(), k_r * (rho_links / rho_0) ** 3, rho_links)
    return value


def fixed_links(robot):
    """The links that no joint moves."""
    rows = [
        robot.fk(q, frame=name)
        for q in robot.random_configuration(2, rng=1)
        for name in robot.collision.links
    ]
    first, second = rows[: len(rows) // 2], rows[len(rows) // 2 :]
    return {
        name
        for name, a, b in zip(robot.collision.links, first, second, strict=True)
        if np.allclose(a, b, atol=1e-12)
    }


def gains_of(planner, space):
    given = planner._fill_in(space).values
    return {name: given[name] for name in ("k", "k_r", "rho_0", "cone", "rho_links")}


@pytest.mark.parametrize("seed", SEEDS)
def test_the_potential_is_the_sum_over_control_points(seed):
    robot, scene, free = cell(seed)
    margin = 0.005 * (seed % 2)
    space = ArmSpace(robot, scene, margin)
    planner = PotentialField(rho_0=0.3, rho_links=0.1, k=2.0, cone=1.5)
    gains = gains_of(planner, space)
    found = potential(space, free[1], free, **gains)
    for q, value in zip(free[2:8], found.value[2:8], strict=True):
        assert value == pytest.approx(slow_potential(space, free[1], q, gains), rel=1e-6)
    assert found.value.shape == (len(free),)
    assert found.gradient.shape == free.shape


@pytest.mark.parametrize("seed", SEEDS)
def test_the_gradient_is_that_of_differences(seed):
    robot, scene, free = cell(seed)
    space = ArmSpace(robot, scene)
    options = {"rho_0": 0.4, "rho_links": 0.2}
    h, smooth = 1e-6, 0
    for q in free[2:10]:
        inside = np.clip(q, space.lower + 2 * h, space.upper - 2 * h)
        q = np.where(space.wraps, q, inside)
        shifts = h * np.eye(robot.dof)
        ahead, back = potential(space, free[:2], [q + shifts, q - shifts], **options).value
        here = potential(space, free[:2], q, **options)
        slopes = (ahead - back) / (2 * h)
        both = (ahead - here.value) / h, (here.value - back) / h
        scale = 1.0 + np.abs(here.gradient).max()
        if np.abs(both[0] - both[1]).max() > 1e-2 * scale:
            continue  # a crease, or a very stiff place
        smooth += 1
        np.testing.assert_allclose(slopes, here.gradient, atol=2e-5 * scale)
    assert smooth


def test_several_goals_attract_by_the_nearest():
    space = ArmSpace(cs.load_robot("planar_2r"))
    goals = np.array([[1.0, 0.0], [-1.0, 0.5], [3.0, 0.0]])
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (20, 2))
    values = np.stack([potential(space, goal, q, cone=0.7).value for goal in goals])
    np.testing.assert_allclose(potential(space, goals, q, cone=0.7).value, values.min(axis=0), rtol=1e-12)
    near = potential(space, goals, [-3.1, 0.0], k=2.0, cone=1.0)
    turned = 2 * np.pi - 6.1
    assert near.value == pytest.approx(turned**2)
    np.testing.assert_allclose(near.gradient, [2 * turned, 0.0], atol=1e-12)


def check_rest(space, goals, plan):
    """The name of a rest, by the potential alone."""
    rest = plan.stats["rest"]
    assert rest.kind in TYPED
    assert plan.status in STATUSES
    assert (plan.status == "found") == (rest.kind == "goal")
    assert (plan.status == "local_minimum") == (rest.kind in ("minimum", "crease"))
    gains = {name: rest.gains[name] for name in ("k", "k_r", "rho_0", "cone", "rho_links")}
    here = potential(space, goals, rest.q, **gains)
    assert here.value == pytest.approx(rest.values[-1], rel=1e-9)
    if rest.kind not in ("minimum", "crease"):
        return rest.kind
    closed = space.wraps == 0
    offsets = np.random.default_rng(0).normal(size=(200, space.dof))
    for radius in (1e-5, 1e-4):
        around = rest.q + radius * offsets / np.linalg.norm(offsets, axis=1)[:, None]
        around[:, closed] = np.clip(around[:, closed], space.lower[closed], space.upper[closed])
        values = potential(space, goals, around, **gains).value
        assert (values >= here.value - 1e-10 * abs(here.value)).all()
    if rest.kind == "minimum":
        held = closed & ((rest.q <= space.lower) | (rest.q >= space.upper))
        assert np.abs(here.gradient[~held]).max(initial=0.0) == pytest.approx(0.0, abs=1e-2 * gains["k"])
        assert rest.force <= 1e-2 * gains["k"]
    return rest.kind


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_every_stop_has_its_name_and_every_step_is_free(seed):
    robot, scene, free = cell(seed) if seed % 2 else few_joints(seed, 3)
    space = ArmSpace(robot, scene)
    for a, b in zip(free[:8:2], free[1:8:2], strict=False):
        plan = PotentialField().plan(space, a, b)
        kind = check_rest(space, b, plan)
        rest = plan.stats["rest"]
        values = rest.values
        assert len(values) == len(rest.path)
        assert (np.diff(values[: -1 if kind == "goal" else None]) < 0).all()
        assert np.linalg.norm(np.diff(rest.path, axis=0), axis=1).max(initial=0.0) <= 0.1 * (1 + 1e-3)
        for p, q in itertools.pairwise(rest.path[:: max(1, len(rest.path) // 20)]):
            assert len(rest.path) > 60 or space.edge(p, q)
        if plan:
            assert plan.certified
            np.testing.assert_array_equal(plan.path[0], a)
            assert judge_path(robot, scene, plan.path[:40]) > -oracle.BAND
            assert plan.clearance > -oracle.BAND
            turns = (plan.path[-1] - b) / (2 * np.pi)
            np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
        elif rest.kind != "time":
            assert "the descent ended" in plan.reason


@pytest.mark.parametrize("seed", range(20))
def test_planar_arms_come_to_rest_at_goals_and_minima(seed):
    robot = limited_arm(2 + seed % 2)
    scene = balls(seed, 2)
    q = robot.random_configuration(60, rng=seed)
    free = q[~robot.collides(q, scene)]
    space = ArmSpace(robot, scene)
    kinds = [
        check_rest(space, b, PotentialField().plan(space, a, b))
        for a, b in zip(free[:6], free[6:12], strict=True)
    ]
    assert set(kinds) <= {"goal", "minimum"}


def test_a_descent_leaves_the_saddle_before_a_ball():
    space = ball_in_plane([cs.Sphere(0.2, [0, 0, 0], name="post")])
    plan = PotentialField(rho_0=0.2).plan(space, [-0.8, 0.0], [0.8, 0.0])
    assert plan
    assert plan.stats["rest"].saddles >= 1
    assert "saddle" in plan.reason
    assert judge_path(space.robot, space.scene, plan.path) > -oracle.BAND


def test_a_wall_across_the_way_is_a_minimum_that_names_it():
    space = ball_in_plane([cs.Box([0.1, 1.0, 0.2], [0, 0, 0], name="wall")])
    plan = cs.plan(space.robot, [-0.8, 0.1], [0.8, 0.1], space.scene, planner="potential_field", rho_0=0.2)
    assert (plan.status, bool(plan), len(plan)) == ("local_minimum", False, 0)
    rest = plan.stats["rest"]
    assert rest.kind == "minimum"
    assert (rest.pushes[0].link, rest.pushes[0].other) == ("ball", "wall")
    assert "the potential rises in every direction; wall pushes ball from" in plan.reason
    # The attraction k · cone balances k_r (1/ρ − 1/ρ₀)/ρ², one force on one joint.
    rho = -0.05 - rest.q[0] - 0.05
    gains = rest.gains
    assert gains["k_r"] * (1 / rho - 1 / gains["rho_0"]) / rho**2 == pytest.approx(
        gains["k"] * gains["cone"], rel=0.01
    )
    assert rest.pushes[0].distance == pytest.approx(rho, abs=1e-6)


def test_a_notch_of_a_mesh_is_a_crease():
    outline = np.array([(0.4, -0.6), (0.4, 0.6), (-0.2, 0.6), (0.2, 0.0), (-0.2, -0.6)])
    space = ball_in_plane([extrude(outline)], radius=0.03)
    plan = PotentialField(rho_0=0.15).plan(space, [-0.6, 0.013], [0.8, 0.02])
    assert check_rest(space, [0.8, 0.02], plan) == "crease"
    assert "pushes from two sides" in plan.reason
    assert abs(plan.stats["rest"].q[1]) < 1e-3


def extrude(outline):
    """A mesh over a polygon (n, 2) that is star-shaped around (0.3, 0)."""
    n = len(outline)
    ring = np.concatenate([np.column_stack([outline, np.full(n, z)]) for z in (-0.2, 0.2)])
    centers = np.array([[0.3, 0.0, -0.2], [0.3, 0.0, 0.2]])
    vertices = np.concatenate([ring, centers])
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [[i, j, n + j], [i, n + j, n + i], [j, i, 2 * n], [n + i, n + j, 2 * n + 1]]
    return cs.Mesh(vertices, np.array(faces), name="notch")


def test_joints_stop_at_their_limits():
    space = ball_in_plane([cs.Box([0.1, 3.0, 0.2], [0.4, 0.0, 0], name="wall")])
    plan = PotentialField(rho_0=0.3, k_r=0.5).plan(space, [0.0, 0.9], [0.9, 1.0])
    assert plan.status == "local_minimum"
    path = plan.stats["rest"].path
    assert (path >= space.lower).all()
    assert (path <= space.upper).all()
    arm = limited_arm(bound=1.0)
    round_the_back = ArmSpace(arm, cs.Scene([cs.Sphere(0.3, [1.6, 0.6, 0.0], name="ball")]))
    held = PotentialField(rho_0=0.5, k_r=0.2).plan(round_the_back, [-1.0, 0.9], [1.0, 0.9])
    assert check_rest(round_the_back, [1.0, 0.9], held) in ("goal", "minimum")


def test_budgets_have_their_names():
    space = ball_in_plane([cs.Box([0.1, 1.0, 0.2], [0, 0, 0], name="wall")])
    ends = [-0.8, 0.1], [0.8, 0.1]
    few = PotentialField(looks=4).plan(space, *ends)
    assert (few.status, few.stats["rest"].kind) == ("undetermined", "budget")
    assert "a larger looks= gets farther" in few.reason
    late = PotentialField(time_limit=0.0).plan(space, *ends)
    assert (late.status, late.stats["rest"].kind) == ("undetermined", "time")
    assert "time limit" in late.reason


def test_the_start_that_arrives_is_taken():
    space = ball_in_plane([cs.Box([0.1, 1.0, 0.2], [0, 0, 0], name="wall")])
    plan = PotentialField().plan(space, [[-0.3, 0.0], [0.9, 0.5]], [[0.3, 0.0], [-0.9, 0.9]])
    assert (plan.start, plan.goal) == (1, 0)
    np.testing.assert_array_equal(plan.path[[0, -1]], [[0.9, 0.5], [0.3, 0.0]])


def test_many_plans_are_those_of_each_alone():
    robot, scene, free = cell(2)
    starts, goals = free[:6], free[6:12]
    alone = [
        cs.plan(robot, a, b, scene, planner="potential_field") for a, b in zip(starts, goals, strict=True)
    ]
    for threads in (1, 2):
        many = cs.plan_many(robot, starts, goals, scene, planner="potential_field", threads=threads)
        assert many.status == tuple(plan.status for plan in alone)
        for one, other in zip(many, alone, strict=True):
            np.testing.assert_array_equal(one.path, other.path)
            np.testing.assert_array_equal(one.stats["rest"].path, other.stats["rest"].path)


def test_options_are_in_force():
    space = ball_in_plane([cs.Sphere(0.2, [0, 0.05, 0], name="post")])
    ends = [-0.8, 0.0], [0.8, 0.0]
    long = PotentialField().plan(space, *ends)
    short = PotentialField(simplify=True).plan(space, *ends)
    assert long
    assert short.cost < long.cost
    assert short.certified
    wide = PotentialField(rho_0=0.3).plan(space, *ends)
    assert wide.clearance > PotentialField(rho_0=0.05).plan(space, *ends).clearance
    fine = PotentialField(step=0.01).plan(space, *ends)
    assert len(fine) > len(long)
    same = PotentialField().plan(space, [0.5, 0.0], [0.5, 0.0])
    assert same.cost == 0.0


BAD = {
    "k": (lambda s: PotentialField(k=0.0), InputError, "k is 0"),
    "rho_0": (lambda s: PotentialField(rho_0=-1.0), InputError, "rho_0 is -1"),
    "looks": (lambda s: PotentialField(looks=0), InputError, "looks is 0"),
    "type": (lambda s: PotentialField(step="long"), InputTypeError, "step"),
    "shape": (lambda s: potential(s, [0.0, 0.0], [0.0, 0.0, 0.0]), InputError, "q has shape"),
    "goals": (lambda s: potential(s, [0.0], [0.0, 0.0]), InputError, "goals has shape"),
    "nan": (lambda s: potential(s, [0.0, np.nan], [0.0, 0.0]), InputError, "nan"),
    "start": (
        lambda s: cs.plan(s.robot, [0, 0], [0.9, 0], s.scene, planner="potential_field"),
        InputError,
        "ball touches post",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_gets_an_error_that_names_it(name):
    call, kind, message = BAD[name]
    space = ball_in_plane([cs.Sphere(0.2, [0, 0, 0], name="post")])
    with pytest.raises(kind, match=message):
        call(space)
