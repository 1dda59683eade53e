"""Likelihood fields against distances from every cell to every blocked one."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError


def naive_scores(blocked, known, resolution, sigma, floor):
    """The scores of cells by the least distance between centres, with no border."""
    cells = np.argwhere(np.ones_like(blocked, dtype=bool))
    walls = np.argwhere(blocked)
    if not len(walls):
        return np.zeros(blocked.shape, np.uint8)
    apart = resolution * np.hypot(*np.moveaxis(cells[:, None] - walls, -1, 0)).min(axis=1)
    likelihood = (1 - floor) * np.exp(-0.5 * (apart / sigma) ** 2) + floor
    exact = (255 * (1 - np.log(likelihood) / np.log(floor))).reshape(blocked.shape)
    return np.where(known, exact, 0.0)


@pytest.mark.parametrize("seed", range(12))
def test_scores_are_those_of_the_nearest_blocked_cell(seed):
    rng = np.random.default_rng(seed)
    blocked = rng.random(rng.integers(1, 40, 2)) < rng.choice([0.0, 0.01, 0.1, 0.6, 1.0])
    resolution, sigma, floor = rng.uniform(0.02, 0.5), rng.uniform(0.05, 1.0), rng.uniform(0.01, 0.9)
    grid = cs.OccupancyGrid(blocked, resolution, origin=(1.0, -2.0))
    field = grid.likelihood_field(sigma, floor)
    wanted = naive_scores(blocked, np.ones_like(blocked), resolution, sigma, floor)
    assert field.scores.shape == blocked.shape
    assert field.outside == 0
    np.testing.assert_allclose(field.scores, wanted, atol=0.5 + 1e-9)
    assert (field.scores[blocked] == 255).all()
    np.testing.assert_array_equal(field.origin, grid.origin)


def test_the_border_is_not_an_obstacle():
    blocked = np.zeros((30, 30), bool)
    assert not cs.OccupancyGrid(blocked, 0.05).likelihood_field().scores.any()
    blocked[15, 0] = True
    scores = cs.OccupancyGrid(blocked, 0.05).likelihood_field(0.1).scores
    assert scores[15, 0] == 255
    assert not scores[[0, -1]].any()
    assert not scores[:, -1].any()


def test_turned_grids_have_turned_fields():
    blocked = np.random.default_rng(3).random((40, 61)) < 0.03
    scores = cs.OccupancyGrid(blocked, 0.1).likelihood_field(0.2).scores
    turned = cs.OccupancyGrid(np.rot90(blocked), 0.1).likelihood_field(0.2).scores
    np.testing.assert_array_equal(turned, np.rot90(scores))


@pytest.mark.parametrize(
    ("sigma", "floor", "subject"),
    [
        (0.0, 0.1, "sigma"),
        (-1.0, 0.1, "sigma"),
        (1e9, 0.1, "sigma"),
        (0.1, 0.0, "floor"),
        (0.1, 1.0, "floor"),
    ],
)
def test_what_is_no_model_is_refused(sigma, floor, subject):
    with pytest.raises(InputError, match=subject):
        cs.OccupancyGrid(np.zeros((3, 3), bool)).likelihood_field(sigma, floor)
