"""Rays on grids against the intersection of every ray with every cell."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError

maps = cs.maps


def slabs(point, direction, blocked, resolution, origin):
    """Where a ray enters the inside of the first blocked cell, in fractions of nothing but its slabs."""
    walls = np.argwhere(np.pad(blocked, 1, constant_values=True))[:, ::-1] - 1
    with np.errstate(divide="ignore", invalid="ignore"):
        a = (origin + resolution * walls - point) / direction
        b = (origin + resolution * (walls + 1) - point) / direction
    near, far = np.minimum(a, b).max(-1), np.maximum(a, b).min(-1)
    hit = (near < far) & (far > 0)
    return np.maximum(near[hit], 0).min()


@pytest.mark.parametrize("seed", range(6))
def test_rays_end_at_the_first_cell_that_they_enter(seed):
    rng = np.random.default_rng(seed)
    blocked = rng.random(rng.integers(3, 40, 2)) < 0.1
    resolution, origin = rng.uniform(0.05, 2), rng.uniform(-5, 5, 2)
    grid = cs.OccupancyGrid(blocked, resolution=resolution, origin=origin)
    points = origin + rng.uniform(0, 1, (200, 2)) * blocked.shape[::-1] * resolution
    angles = rng.uniform(-7, 7, 200)
    got = maps.cast_rays(grid, points, angles)
    for p, angle, distance in zip(points, angles, got, strict=True):
        wanted = slabs(p, np.array([np.cos(angle), np.sin(angle)]), blocked, resolution, origin)
        assert distance == pytest.approx(wanted, abs=1e-9)
    np.testing.assert_array_equal(maps.cast_rays(grid, points, angles, 0.7), np.minimum(got, 0.7))


def test_rays_along_borders_and_through_corners():
    blocked = np.zeros((6, 6), bool)
    blocked[2, 4] = True
    grid = cs.OccupancyGrid(blocked)
    assert maps.cast_rays(grid, (0.5, 2.0), 0.0) == 5.5  # along the side of the cell
    assert maps.cast_rays(grid, (0.5, 2.5), 0.0) == 3.5
    blocked[1, 4] = True
    assert maps.cast_rays(cs.OccupancyGrid(blocked), (0.5, 2.0), 0.0) == 3.5  # both sides blocked
    corner = np.zeros((6, 6), bool)
    corner[2, 3] = corner[3, 2] = True  # they touch in (3, 3)
    grid = cs.OccupancyGrid(corner)
    angle = np.arctan2(1.0, 1.0)
    if np.cos(angle) == np.sin(angle):
        assert maps.cast_rays(grid, (1.0, 1.0), angle) == pytest.approx(np.sqrt(8))
    assert maps.cast_rays(grid, (2.5, 3.5), 1.0) == 0.0  # inside
    assert maps.cast_rays(grid, (-1.0, 3.5), 1.0) == 0.0  # outside


def test_what_is_no_ray_is_refused():
    grid = cs.OccupancyGrid(np.zeros((3, 3), bool))
    with pytest.raises(InputTypeError, match="OccupancyGrid"):
        maps.cast_rays(np.zeros((3, 3)), (1, 1), 0.0)
    with pytest.raises(InputError, match="max_range"):
        maps.cast_rays(grid, (1, 1), 0.0, 0.0)
    with pytest.raises(InputError, match="points"):
        maps.cast_rays(grid, (1, 1, 1), 0.0)
    assert maps.cast_rays(grid, np.ones((4, 1, 2)), np.zeros(5)).shape == (4, 5)


def test_the_old_name_stays():
    assert cs.navigation.cast_rays is maps.cast_rays
