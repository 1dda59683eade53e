"""Volumes against volumes in closed form, and their intervals against the statistics that they promise."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from planning.joint_space.cases import draw_case, gantry

HALF = np.array([0.3, 0.2, 0.4])
RADIUS = 0.15


def grown_box(half, r):
    """The volume of a box grown by a ball: Steiner's formula."""
    a, b, c = 2 * half
    surface, edges = 2 * (a * b + b * c + c * a), a + b + c
    return a * b * c + surface * r + np.pi * edges * r**2 + 4 / 3 * np.pi * r**3


def test_a_ball_on_three_slides_among_boxes_has_a_volume_in_closed_form():
    robot = gantry(RADIUS)
    space = cs.configuration_space(robot, cs.Scene([cs.Box(2 * HALF, [0.1, -0.2, 0.1], "box")]))
    true = 1 - grown_box(HALF, RADIUS) / 8
    found = [space.volume(4000, rng=seed) for seed in range(200)]
    inside = np.mean([v.interval[0] <= true <= v.interval[1] for v in found])
    assert 0.90 < inside < 0.99
    shares = np.array([v.share for v in found])
    assert abs(shares.mean() - true) < 4 * found[0].standard_error / np.sqrt(200)
    assert np.std(shares) == pytest.approx(found[0].standard_error, rel=0.2)
    one = found[0]
    assert one.size == 8
    assert one.limit_share == 1
    assert one.free_size == 8 * one.share
    assert one.self_share == 0
    assert one.obstacle_share == pytest.approx(1 - one.share)


def test_the_slice_of_a_ball_on_slides_is_a_rounded_rectangle():
    space = cs.configuration_space(gantry(RADIUS), cs.Scene([cs.Box(2 * HALF, [0.1, -0.2, 0.1], "box")]))
    part = space.slice((0, 1), at=[0, 0, 0.1], size=512)
    a, b = 2 * HALF[:2]
    true = 1 - (a * b + 2 * (a + b) * RADIUS + np.pi * RADIUS**2) / 4
    low, high = part.free_bounds
    assert low < true < high
    assert high - low < 0.02
    assert part.units == ("m", "m")
    projected = space.project((0, 1), size=64, samples=200)
    x, y = projected.cells
    outside = np.maximum(np.abs(x[:, None] - 0.1) - HALF[0], 0), np.maximum(np.abs(y + 0.2) - HALF[1], 0)
    reach = np.sqrt(np.maximum(RADIUS**2 - outside[0] ** 2 - outside[1] ** 2, 0))
    under = (outside[0] ** 2 + outside[1] ** 2) < RADIUS**2
    share = np.where(under, 1 - (HALF[2] + reach), 1.0)  # of z, whose range is 2
    low, high = projected.interval
    assert ((low <= share) & (share <= high)).mean() > 0.9


def test_nothing_in_the_way_is_all_free():
    volume = cs.configuration_space(gantry(0.1)).volume(5000)
    assert volume.share == 1.0
    assert volume.interval[1] == 1.0
    assert 0.999 < volume.interval[0] < 1.0
    assert volume.standard_error == 0.0


@pytest.mark.parametrize("seed", range(6))
def test_the_parts_add_up_and_obstacles_only_take_away(seed):
    robot, scene, space, *_ = draw_case(seed)
    kept = [cs.planning.JointSpace(robot, s, margin=space.margin) for s in (None, scene)]
    kept.append(
        cs.planning.JointSpace(robot, scene.add(cs.Sphere(0.4, [0.4, 0, 0.4], "more")), margin=space.margin)
    )
    volumes = [each.volume(3000, rng=seed) for each in kept]
    for volume in volumes:
        assert volume.share + volume.self_share + volume.obstacle_share == pytest.approx(1)
        assert volume.interval[0] <= volume.share <= volume.interval[1]
        assert volume.self_share == volumes[0].self_share
    assert volumes[0].obstacle_share == 0
    assert volumes[0].share >= volumes[1].share >= volumes[2].share
    rows = np.random.default_rng(seed).uniform(space.lower, space.upper, (3000, space.dof))
    assert volumes[1].share == pytest.approx(1 - robot.collides(rows, scene, margin=space.margin).mean())


def test_intervals_solve_the_equation_of_wilson():
    space = cs.configuration_space(gantry(RADIUS), cs.Scene([cs.Box(2 * HALF, name="box")]))
    for n in (10, 100, 5000):
        volume = space.volume(n, rng=n)
        for bound in volume.interval:
            if 0 < bound < 1:
                spread = np.sqrt(bound * (1 - bound) / n)
                assert abs(volume.share - bound) / spread == pytest.approx(1.959963984540054)


def test_limits_leave_a_share_of_the_turns():
    T = np.eye(4)
    T[0, 3] = 1.0
    arm = cs.Robot.from_screws(
        np.eye(3), np.zeros((3, 3)), T, lower=[-np.pi / 2, -1, -9], upper=[np.pi / 2, 1, 9]
    ).with_spheres({"tip": [[0, 0, 0, 0.1]]})
    volume = cs.configuration_space(arm).volume(100)
    assert volume.limit_share == pytest.approx(0.5 / np.pi)
    assert volume.size == pytest.approx(np.pi * 2 * 18)
    assert cs.configuration_space(arm, limits=False).volume(100).limit_share == 1.0


def test_threads_change_nothing_and_the_time_ends_it():
    *_, space, _, _, _ = draw_case(3)
    one, several = (space.volume(30_000, threads=n, rng=2) for n in (1, 3))
    assert one == several
    hurried = space.volume(10**9, time_limit=0.05)
    assert not hurried.complete
    assert hurried.samples < 10**9
    again = space.volume(hurried.samples)
    assert (again.share, again.self_share) == (hurried.share, hurried.self_share)
    assert "touch" in repr(hurried)
