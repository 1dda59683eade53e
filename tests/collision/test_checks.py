"""Checks of robots against slow checks in plain numpy, and the laws that hold between checks."""

import itertools

import numpy as np
import pytest

import cspace as cs
from collision.cells import random_robot, random_scene
from cspace.errors import CspaceError, InputError, InputTypeError, UnknownNameError
from model.random_robots import random_pose
from oracles import collision as oracle

SEEDS = range(8)


def cell(seed, n=10):
    rng = np.random.default_rng([seed, 1])
    robot, scene = random_robot(seed), random_scene(rng, n)
    return robot, scene, robot.random_configuration(60, rng=seed, reach=1.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_checks_agree_with_plain_distances(seed):
    robot, scene, q = cell(seed)
    found = robot.collides(q, scene)
    for row, touches in zip(q, found, strict=True):
        least, nearest = oracle.clearance(robot, row, scene)
        if abs(least) > oracle.BAND:
            assert touches == (least < 0)
        assert robot.collides(row, scene) == touches
        pair = robot.contact(row, scene)
        assert (pair is not None) == touches
        exact = robot.clearance(row, scene)
        assert exact.distance == pytest.approx(least, abs=1e-9)
        assert frozenset(exact.pair) in nearest


@pytest.mark.parametrize("seed", SEEDS)
def test_batches_threads_and_shapes_give_the_same(seed):
    robot, scene, q = cell(seed)
    single = np.array([robot.collides(row, scene) for row in q])
    for threads in (1, 2, 0, None):
        np.testing.assert_array_equal(robot.collides(q, scene, threads=threads), single)
    np.testing.assert_array_equal(
        robot.collides(q.reshape(3, 20, -1), scene, threads=1), single.reshape(3, 20)
    )
    assert robot.collides(q[:0], scene).shape == (0,)
    together = robot.clearance(q[:6].reshape(2, 3, -1), scene)
    assert together.gradient.shape == (2, 3, robot.dof)
    np.testing.assert_array_equal(
        together.distance.ravel(), [robot.clearance(row, scene).distance for row in q[:6]]
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_the_gradient_is_that_of_the_distance(seed):
    robot, scene, q = cell(seed)
    step, compared = 1e-6, 0
    for row in q[:20]:
        at = robot.clearance(row, scene)
        if at.crease:
            continue
        ends = [row + sign * step * e for e in np.eye(robot.dof) for sign in (1, -1)]
        try:
            around = [robot.clearance(end, scene) for end in ends]
        except InputError:  # a prismatic joint at its limit
            continue
        if all(near.pair == at.pair for near in around):
            slopes = [
                (a.distance - b.distance) / (2 * step) for a, b in zip(*[iter(around)] * 2, strict=True)
            ]
            if np.abs(np.array(slopes) - at.gradient).max(initial=0.0) < 1e-4:
                compared += 1
            else:  # the nearest sphere of the pair changes within the step
                assert any(abs(near.distance - at.distance) > 0 for near in around)
    assert compared >= 15


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_proved_edges_are_free_and_blocked_ones_touch(seed):
    robot, scene, q = cell(seed, 5)
    free = 0
    for a, b in itertools.pairwise(q):
        b = a + 0.3 * (b - a)
        found = robot.edge(a, b, scene)
        back = robot.edge(b, a, scene)
        assert (found.verdict, bool(found)) == (back.verdict, bool(back))
        samples = a + np.linspace(0, 1, 101)[:, None] * (b - a)
        least = min(oracle.clearance(robot, row, scene)[0] for row in samples[:: 1 if found else 10])
        if found:
            free += 1
            assert found.proved
            assert least > -oracle.BAND
            middle = a + 0.5 * (b - a)
            assert robot.edge(a, middle, scene)
            assert robot.edge(middle, b, scene)
            assert robot.edge(a, b, scene, resolution=0.05)
        elif found.verdict == "blocked":
            at = oracle.clearance(robot, a + found.at * (b - a), scene)[0]
            assert at < oracle.BAND
            assert found.pair[0] in robot.collision.links
            assert found.pair[1] in found.reason
    assert free > 0 or all(robot.collides(q, scene))


@pytest.mark.parametrize("seed", SEEDS)
def test_fewer_obstacles_and_margins_only_free(seed):
    robot, scene, q = cell(seed)
    touching = robot.collides(q, scene)
    for name in scene.names:
        assert not (robot.collides(q, scene.remove(name)) & ~touching).any()
    wide, wider = (robot.collides(q, scene, margin=m) for m in (0.02, 0.1))
    assert not (touching & ~wide).any()
    assert not (wide & ~wider).any()
    everything = scene
    for link in robot.collision.links:
        for name in scene.names:
            everything = everything.allow(link, name)
    np.testing.assert_array_equal(robot.collides(q, everything), robot.collides(q))
    order = cs.Scene(list(scene)[::-1])
    np.testing.assert_array_equal(robot.collides(q, order), touching)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_robot_and_a_scene_moved_together_change_nothing(seed):
    robot, scene, q = cell(seed)
    before = robot.clearance(q[:10], scene).distance
    for T in (random_pose(np.random.default_rng(seed)), cs.pose([1e4, -2e4, 50])):
        moved = cs.Scene([shape.moved(T) for shape in scene])
        there = robot.with_base(T)
        np.testing.assert_allclose(there.clearance(q[:10], moved).distance, before, atol=1e-9)
        sure = np.abs(robot.clearance(q, scene).distance) > oracle.BAND
        np.testing.assert_array_equal(there.collides(q, moved)[sure], robot.collides(q, scene)[sure])


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_an_attached_object_counts_as_a_part_of_the_robot(seed):
    robot, scene, q = cell(seed)
    rng = np.random.default_rng(seed)
    T = random_pose(rng, 0.2)
    ball = cs.Sphere(0.15, T, name="ball")
    held = scene.add(ball).attach("ball", robot.tip, T)
    touching = robot.collides(q, held)
    assert not (robot.collides(q, scene) & ~touching).any()
    tip_body = robot.collision.frames[robot.tip][0] + 1
    others = [
        name
        for name, body in zip(robot.collision.links, robot.collision.link_bodies, strict=True)
        if body != tip_body
    ]
    for row, touches in zip(q, touching, strict=True):
        center = (robot.fk(row) @ T)[:3, 3]
        centers, radii, links = oracle.sphere_places(robot, row)
        gaps = [shape.distance(center) - 0.15 for shape in scene]
        gaps += [
            np.linalg.norm(c - center) - r - 0.15
            for c, r, link in zip(centers, radii, links, strict=True)
            if link in others
        ]
        least = min(oracle.clearance(robot, row, scene)[0], *gaps)
        if abs(least) > oracle.BAND:
            assert touches == (least < 0)
    np.testing.assert_array_equal(
        robot.collides(q, held.detach("ball").remove("ball")), robot.collides(q, scene)
    )
    free = scene.add(ball).attach("ball", robot.tip, T, touch=[*scene.names, *others])
    np.testing.assert_array_equal(robot.collides(q, free), robot.collides(q, scene))


def test_two_attached_objects_are_checked_against_each_other():
    robot = cs.load_robot("planar_2r").with_spheres({})
    assert not robot.collision
    one, two = robot.frames[1], robot.tip
    scene = cs.Scene([cs.Sphere(0.1, name="left"), cs.Sphere(0.1, name="right")])
    held = scene.attach("left", robot.base, [0.4, 0, 0]).attach("right", two, [0, 0, 0])
    robot = robot.with_spheres({one: [[0, 0, 5, 0.01]]})
    tip = robot.fk([0.0, 0.0])[:3, 3]
    near = held.attach("left", robot.base, tip + np.array([0, 0.15, 0]))
    assert robot.contact([0.0, 0.0], near) == ("left", "right")
    assert not robot.collides([0.0, 0.0], near.allow("left", "right"))
    assert not robot.collides([0.0, 0.0], near.attach("right", two, [0, 0, 0], touch=["left"]))
    assert not robot.collides([2.0, 0.0], near)


def small_arm():
    return cs.load_robot("planar_2r").with_spheres({cs.load_robot("planar_2r").tip: [[0, 0, 0, 0.05]]})


BAD = {
    "no geometry": (lambda r, s: cs.load_robot("ur16e").collides(np.zeros(6), s), InputError, "with_spheres"),
    "shape": (lambda r, s: r.collides([0.0], s), InputError, "q has shape"),
    "nan": (lambda r, s: r.collides([0.0, np.nan], s), InputError, "nan at index"),
    "text": (lambda r, s: r.collides("home", s), InputTypeError, "q"),
    "huge": (lambda r, s: r.collides([0.0, 1e300], s), InputError, "largest allowed"),
    "scene": (lambda r, s: r.collides([0.0, 0.0], [cs.Sphere(1.0)]), InputTypeError, "cspace.Scene"),
    "margin": (lambda r, s: r.collides([0.0, 0.0], s, margin=-0.1), InputError, "margin is -0.1"),
    "margin nan": (lambda r, s: r.collides([0.0, 0.0], s, margin=float("nan")), InputError, "margin"),
    "margin text": (lambda r, s: r.collides([0.0, 0.0], s, margin="wide"), InputTypeError, "margin"),
    "threads": (lambda r, s: r.collides([[0.0, 0.0]], s, threads=-1), InputError, "threads is -1"),
    "batch": (lambda r, s: r.edge([[0.0, 0.0]], [0.0, 0.0], s), InputError, "start has shape"),
    "resolution": (lambda r, s: r.edge([0, 0], [0, 1], s, resolution=0), InputError, "resolution"),
    "link": (lambda r, s: r.collides([0, 0], s.allow("ball", "tipp")), UnknownNameError, "tipp"),
    "frame": (
        lambda r, s: r.collides([0, 0], s.attach("ball", "tool9", [0, 0, 0])),
        UnknownNameError,
        "tool9",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_gets_an_error_that_names_it(name):
    call, kind, message = BAD[name]
    scene = cs.Scene([cs.Sphere(0.1, [9, 9, 9], name="ball")])
    with pytest.raises(CspaceError, match=message) as caught:
        call(small_arm(), scene)
    assert isinstance(caught.value, kind)


def test_edges_of_length_zero_and_of_a_micrometre():
    robot, scene, q = cell(0)
    for row in q[:20]:
        touches = robot.collides(row, scene)
        for other in (row, row + 1e-7):
            found = robot.edge(row, other, scene)
            assert bool(found) == (not touches) or found.verdict == "undecided"


def test_many_turns_of_a_joint_do_not_change_a_check():
    robot = small_arm()
    scene = cs.Scene([cs.Box([0.5, 0.5, 0.5], [1.0, 0.6, 0.0])])
    q = robot.random_configuration(100, rng=1)
    found = robot.collides(q, scene)
    assert found.any()
    assert not found.all()
    for turns in (1, -3, 1000):
        np.testing.assert_array_equal(robot.collides(q + 2 * np.pi * turns, scene), found)
