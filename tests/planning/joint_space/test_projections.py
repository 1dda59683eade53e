"""Projections against brute force over the same samples, and against slices."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from planning.joint_space.cases import draw_case, many_joints

SEEDS = many_joints(range(12))


@pytest.mark.parametrize("seed", SEEDS)
def test_shares_are_means_over_samples_of_the_other_joints(seed):
    robot, scene, space, joints, *_ = draw_case(seed)
    found = space.project(joints, size=(9, 7), samples=25, rng=5)
    rng = np.random.default_rng(5)
    first, second = found.cells
    free = np.zeros((9, 7))
    for _ in range(25):
        q = np.tile(rng.uniform(space.lower, space.upper), (9, 7, 1))
        q[..., joints[0]], q[..., joints[1]] = first[:, None], second
        free += ~robot.collides(q, scene, margin=space.margin)
    np.testing.assert_allclose(found.share, free / 25)
    np.testing.assert_array_equal(found.is_free, free > 0)
    low, high = found.interval
    assert (low <= found.share).all()
    assert (found.share <= high).all()
    assert (high > low).all()
    np.testing.assert_allclose(found.standard_error, np.sqrt(found.share * (1 - found.share) / 25))
    assert found.complete
    assert found.samples == 25


@pytest.mark.parametrize("seed", SEEDS)
def test_a_projection_contains_the_slices_that_it_includes(seed):
    *_, space, joints, at, rng = draw_case(seed)
    more = rng.uniform(space.lower, space.upper, (3, space.dof))
    found = space.project(joints, size=31, samples=3, including=np.vstack([at, more]))
    plain = space.project(joints, size=31, samples=3)
    np.testing.assert_array_equal(found.share, plain.share)
    union = plain.is_free
    for q in (at, *more):
        part = space.slice(joints, at=q, size=31)
        assert not (~part.bitmap & ~found.is_free).any()
        union = union | ~part.bitmap
    np.testing.assert_array_equal(found.is_free, union)


def test_of_two_joints_it_is_the_slice():
    arm = cs.load_robot("planar_2r")
    space = cs.configuration_space(arm, cs.Scene([cs.Sphere(0.3, [1.2, 0.5, 0])]), exact=False)
    found, part = space.project((0, 1), size=40, samples=3), space.slice((0, 1), size=40)
    np.testing.assert_array_equal(found.share, ~part.bitmap)
    np.testing.assert_array_equal(found.is_free, ~part.bitmap)


def test_threads_change_nothing_and_the_time_ends_it():
    *_, space, joints, _, _ = draw_case(3)
    one, several = (space.project(joints, size=64, samples=8, threads=n) for n in (1, 3))
    np.testing.assert_array_equal(one.share, several.share)
    hurried = space.project(joints, size=64, samples=10**6, time_limit=0.02)
    assert not hurried.complete
    assert 1 <= hurried.samples < 10**6
    first = space.project(joints, size=64, samples=hurried.samples)
    np.testing.assert_array_equal(hurried.share, first.share)
    assert "samples" in repr(hurried)


def test_an_obstacle_more_never_frees_a_cell():
    robot, scene, space, joints, *_ = draw_case(3)
    before = space.project(joints, size=24, samples=16)
    more = cs.planning.JointSpace(
        robot, scene.add(cs.Sphere(0.3, [0.3, 0.2, 0.5], "more")), margin=space.margin
    )
    after = more.project(joints, size=24, samples=16)
    assert (after.share <= before.share).all()
    assert (after.share < before.share).any()
