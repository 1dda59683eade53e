"""Slices against brute force, signed distances in plain numpy, and the exact space of two joints."""

from __future__ import annotations

import pickle
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import cspace as cs
from oracles.collision import BAND, clearance
from planning.joint_space.cases import draw_case, many_joints

WRIST = ("wrist_1_link", "wrist_2_link", "wrist_3_link")
SEEDS = many_joints(range(24))


def within_cells(part, rng):
    """A random configuration in each cell (n1, n2, dof), on its rim more often than not."""
    q = part.configurations()
    half = (part.upper - part.lower) / part.bitmap.shape / 2
    away = np.clip(rng.uniform(-1.5, 1.5, (*part.bitmap.shape, 2)), -1, 1) * half
    here = q[..., list(part.joints)] + away
    q[..., list(part.joints)] = np.clip(here, part.lower, part.upper)
    return q


@pytest.mark.parametrize("seed", SEEDS)
def test_a_slice_is_brute_force_at_the_centres(seed):
    robot, scene, space, joints, at, _ = draw_case(seed)
    part = space.slice(joints, at=at, size=(37, 51))
    q = part.configurations()
    np.testing.assert_array_equal(part.bitmap, robot.collides(q, scene, margin=space.margin))
    np.testing.assert_array_equal(space.free(q), ~part.bitmap)
    others = [k for k in range(space.dof) if k not in joints]
    assert (q[..., others] == at[others]).all()
    assert part.bitmap.shape == part.is_proved.shape == (37, 51)
    low, high = part.free_bounds
    assert low <= part.free_share <= high
    assert high - low == pytest.approx(1 - part.proved)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_proved_cell_is_as_its_centre_all_over(seed):
    robot, scene, space, joints, at, rng = draw_case(seed)
    part = space.slice(joints, at=at, size=48)
    for _ in range(12):
        found = robot.collides(within_cells(part, rng), scene, margin=space.margin)
        np.testing.assert_array_equal(found[part.is_proved], part.bitmap[part.is_proved])
    places = np.argwhere(part.is_proved)
    q = within_cells(part, rng)
    for i, j in places[rng.permutation(len(places))[:8]]:
        distance = clearance(robot, q[i, j], scene)[0] - space.margin
        assert distance < BAND if part.bitmap[i, j] else distance > -BAND


@pytest.mark.parametrize("seed", SEEDS)
def test_finer_cells_are_proved_more(seed):
    *_, space, joints, at, _ = draw_case(seed)
    coarse, fine = (space.slice(joints, at=at, size=n).proved for n in (16, 256))
    assert fine >= coarse
    assert fine > 0.8


def test_obstacles_are_named_that_touch_alone():
    robot, scene, space, *_ = draw_case(3)
    no_pairs = np.empty((0, 2), dtype=np.int64)
    among = replace(robot.collision, pairs=no_pairs, _kept={})  # touches obstacles alone
    named = 0
    for seed in range(6):
        rng = np.random.default_rng(seed)
        joints = tuple(int(k) for k in rng.permutation(space.dof)[:2])
        part = space.slice(joints, at=rng.uniform(space.lower, space.upper), size=40)
        found, q = part.obstacle_map, part.configurations()
        np.testing.assert_array_equal(found >= 0, part.bitmap)
        for k, name in enumerate(part.obstacles):
            who, alone = (robot, None) if name == "self" else (among, cs.Scene([scene[name]]))
            if (here := found == k).any():
                assert cs.collision.collides(who, q[here], alone, margin=space.margin).all()
                assert space.blocked_by(q[here][0]) == name
                named += 1
        q = q[part.bitmap]
        by_obstacles = cs.collision.collides(among, q, scene, margin=space.margin)
        np.testing.assert_array_equal(found[part.bitmap] < len(part.obstacles) - 1, by_obstacles)
    assert named > 6


@pytest.mark.parametrize("seed", range(8))
def test_planar_arms_have_the_bitmap_of_their_exact_space(seed):
    """Balls cover a link of radius 0.04 m by at most 0.01 m more: the slice lies between both exact ones."""
    rng = np.random.default_rng(seed)
    arm = cs.load_robot("planar_2r")

    def place():
        bearing = rng.uniform(0, 7)
        xy = rng.uniform(0.5, 1.9) * np.array([np.cos(bearing), np.sin(bearing)])
        return cs.pose([*xy, 0.0], rotvec=[0.0, 0.0, rng.uniform(0, 7)])

    scene = cs.Scene(
        [
            *(cs.Box([*rng.uniform(0.1, 0.5, 2), 2.0], place()) for _ in range(3)),
            cs.Cylinder(0.2, 2.0, place()),
            cs.Sphere(0.2, place()),
        ]
    )
    part = cs.configuration_space(arm, scene, exact=False).slice((0, 1), size=200)
    thin, thick = (
        cs.configuration_space(arm, scene, link_radius=radius).bitmap(200)
        for radius in (0.04 - 1e-5, 0.04 + arm.collision.excess + 1e-5)
    )
    assert not (thin & ~part.bitmap).any()
    assert not (part.bitmap & ~thick).any()
    assert (thick ^ thin).mean() < 0.05
    # a straight arm lies on itself where it folds back, which the exact space does not count
    assert cs.configuration_space(arm, scene).obstacles == part.obstacles[:-1]


def test_the_order_of_the_joints_transposes_the_picture():
    *_, space, joints, at, _ = draw_case(5)
    one, other = space.slice(joints, at=at, size=64), space.slice(joints[::-1], at=at, size=64)
    np.testing.assert_array_equal(one.bitmap, other.bitmap.T)
    assert one.joint_names == other.joint_names[::-1]
    by_name = space.slice([space.joint_names[k] for k in joints], at=at, size=64)
    np.testing.assert_array_equal(one.bitmap, by_name.bitmap)
    from_end = space.slice([k - space.dof for k in joints], at=at, size=64)
    np.testing.assert_array_equal(one.bitmap, from_end.bitmap)


@pytest.mark.parametrize("size", [1, 2, 17, (1, 300), (97, 3)])
def test_grids_of_every_shape(size):
    robot, scene, space, joints, at, _ = draw_case(3)
    part = space.slice(joints, at=at, size=size)
    np.testing.assert_array_equal(part.bitmap, robot.collides(part.configurations(), scene, margin=0.01))
    first, second = part.cells
    assert part.bitmap.shape == (len(first), len(second))


def test_threads_change_nothing_and_a_time_limit_only_the_proofs():
    *_, space, joints, at, _ = draw_case(9)
    whole = space.slice(joints, at=at, size=400)
    several = space.slice(joints, at=at, size=400, threads=3)
    np.testing.assert_array_equal(whole.bitmap, several.bitmap)
    np.testing.assert_array_equal(whole.is_proved, several.is_proved)
    np.testing.assert_array_equal(whole.obstacle_map, several.obstacle_map)
    hurried = space.slice(joints, at=at, size=400, time_limit=1e-9)
    np.testing.assert_array_equal(whole.bitmap, hurried.bitmap)
    assert hurried.proved == 0.0 < whole.proved


@pytest.mark.parametrize("seed", SEEDS[:8])
def test_obstacles_and_margins_only_add_blocked_cells(seed):
    robot, scene, _, joints, at, rng = draw_case(seed)
    spaces = [
        cs.planning.JointSpace(robot),
        cs.planning.JointSpace(robot, scene),
        cs.planning.JointSpace(robot, scene.add(cs.Sphere(0.3, rng.uniform(-0.8, 0.8, 3), "more"))),
    ]
    spaces.append(cs.planning.JointSpace(robot, spaces[-1].scene, margin=0.05))
    maps = [space.slice(joints, at=at, size=32).bitmap for space in spaces]
    for less, more in pairwise(maps):
        assert not (less & ~more).any()


def test_limits_give_way_to_whole_turns():
    robot = cs.load_robot("panda")
    space = cs.planning.JointSpace(robot, limits=False)
    assert space.wraps.all()
    np.testing.assert_array_equal([space.lower, space.upper], np.pi * np.array([-np.ones(7), np.ones(7)]))
    assert space.blocked_by(np.full(7, 100.0)) != "limit"
    limited = cs.planning.JointSpace(robot)
    assert limited.blocked_by(robot.limits.upper + 0.1) == "limit"
    assert not limited.free(robot.limits.upper + 0.1)


def test_what_is_carried_counts_as_the_robot():
    robot = cs.load_robot("ur5e", geometry="skeleton")
    long = cs.Capsule(0.03, 0.8, [0, 0, 5.0], name="rod")
    scene = cs.Scene([long, cs.Sphere(0.1, [5, 0, 0], "far")]).attach(
        "rod", "tool0", cs.pose([0, 0, 0.5]), touch=WRIST
    )
    at = [-0.65, 3.95, 2.57, 5.39, -1.72, -1.62]
    bare, carrying = (cs.configuration_space(robot, s).slice((2, 4), at=at, size=64) for s in (None, scene))
    assert carrying.bitmap.sum() > bare.bitmap.sum()
    assert carrying.obstacles == ("far", "self")
    assert set(np.unique(carrying.obstacle_map)) == {-1, 1}


def test_a_base_that_touches_blocks_everything():
    robot = cs.load_robot("panda")
    space = cs.configuration_space(robot, cs.Scene([cs.Sphere(0.3, [0, 0, 0], "stone")]))
    part = space.slice((0, 1), size=16)
    assert part.bitmap.all()
    assert part.proved == 1.0
    assert (part.obstacle_map == 0).all()
    assert space.volume(1000).share == 0.0


def test_spaces_and_slices_are_pickled_and_described():
    *_, space, joints, at, _ = draw_case(3)
    part = space.slice(joints, at=at, size=20)
    again = pickle.loads(pickle.dumps(part))
    np.testing.assert_array_equal(again.obstacle_map, part.obstacle_map)
    assert "cells" in repr(again)
    same = pickle.loads(pickle.dumps(space))
    np.testing.assert_array_equal(same.slice(joints, at=at, size=20).bitmap, part.bitmap)
    assert repr(same) == repr(space)


def test_the_exact_space_and_the_other_answer_the_same_questions():
    arm = cs.load_robot("planar_2r")
    scene = cs.Scene([cs.Box([0.4, 0.3, 1.0], [1.2, 0.6, 0.0], "post")])
    exact, other = (cs.configuration_space(arm, scene, exact=is_exact) for is_exact in (None, False))
    assert type(exact) is cs.planning.ConfigurationSpace
    assert type(other) is cs.planning.JointSpace
    for space in (exact, other):
        assert space.dof == 2
        assert space.joint_names == arm.joint_names
        assert space.wraps.all()
        assert space.blocked_by([0.46, 0.0]) == "post"
        assert not space.free([0.46, 0.0])
        np.testing.assert_array_equal(space.free([[0.46, 0.0], [3.0, 0.0]]), [False, True])
    np.testing.assert_array_equal(exact.lower, other.lower)
    with_mesh = cs.Scene([cs.HeightField(np.zeros((3, 3)), (1, 1), [1.5, 0, -0.5])])
    assert cs.configuration_space(arm, with_mesh, exact=False).slice((0, 1), size=8).bitmap.any() is not None
