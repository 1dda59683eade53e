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


def first_wall(point, direction, walls):
    """How far a ray goes to the first of segments (n, 2, 2), by its intersection with every line."""
    a, along = walls[:, 0], walls[:, 1] - walls[:, 0]
    slant = direction[0] * along[:, 1] - direction[1] * along[:, 0]
    t = ((a - point)[:, 0] * along[:, 1] - (a - point)[:, 1] * along[:, 0]) / slant
    s = ((a - point)[:, 0] * direction[1] - (a - point)[:, 1] * direction[0]) / slant
    return t[(t > 0) & (s >= 0) & (s <= 1)].min()


def random_world(rng):
    """Polygons that may overlap, in bounds of 10 × 8 m."""
    obstacles = []
    for _ in range(rng.integers(0, 12)):
        turns = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 7)))
        if np.diff(turns).min() > 0.1:
            reach = rng.uniform(0.3, 1.2)
            ring = rng.uniform(1, 7, 2) + reach * np.stack([np.cos(turns), np.sin(turns)], axis=-1)
            obstacles.append(ring)
    return cs.PolygonWorld(obstacles, bounds=(0, 0, 10, 8))


@pytest.mark.parametrize("seed", range(12))
def test_rays_among_polygons_end_at_the_first_wall(seed):
    rng = np.random.default_rng(seed)
    world = random_world(rng)
    walls = np.concatenate([np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in world.walls])
    points = rng.uniform(0, 1, (200, 2)) * (10, 8)
    angles = rng.uniform(-7, 7, 200)
    got = maps.cast_rays(world, points, angles)
    free = world.is_free(points)
    assert (got[~free] == 0).all()
    for p, angle, distance in zip(points[free], angles[free], got[free], strict=True):
        wanted = first_wall(p, np.array([np.cos(angle), np.sin(angle)]), walls)
        assert distance == pytest.approx(wanted, abs=1e-9)
    np.testing.assert_array_equal(maps.cast_rays(world, points, angles, 0.7), np.minimum(got, 0.7))


def test_rays_from_walls_and_outside():
    world = cs.PolygonWorld([[(2, 2), (4, 2), (4, 4), (2, 4)]], bounds=(0, 0, 6, 6))
    assert maps.cast_rays(world, (1.0, 3.0), 0.0) == 1.0
    assert maps.cast_rays(world, (2.0, 3.0), 0.0) == 0.0  # from the wall into it
    assert maps.cast_rays(world, (2.0, 3.0), np.pi) == 2.0  # and away from it
    assert maps.cast_rays(world, (3.0, 3.0), 0.0) == 0.0  # inside
    assert maps.cast_rays(world, (7.0, 3.0), 0.0) == 0.0  # outside
    np.testing.assert_allclose(maps.cast_rays(world, (1.0, 1.0), [0, np.pi / 2]), 5.0)


def test_grids_and_their_polygons_stop_the_same_rays():
    rng = np.random.default_rng(5)
    grid = cs.OccupancyGrid(rng.random((20, 30)) < 0.1, 0.5)
    world = cs.PolygonWorld.from_grid(grid)
    points = rng.uniform(0, 1, (500, 2)) * (15, 10)
    angles = rng.uniform(-4, 4, 500)
    free = grid.is_free(points)
    mine, theirs = (maps.cast_rays(each, points[free], angles[free]) for each in (grid, world))
    np.testing.assert_allclose(mine, theirs, atol=1e-9)
