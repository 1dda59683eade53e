"""Roots of many polynomials: those that random factors have, each on its interval."""

import numpy as np

from cspace.trajectory.piece_roots import find_piece_roots


def test_roots_are_those_of_the_factors():
    rng = np.random.default_rng(51)
    for degree in range(1, 9):
        roots = np.sort(rng.uniform(-2, 2, (200, degree)), axis=1)
        c = np.array([np.poly(row)[::-1] for row in roots]) * rng.choice([-3.0, 0.1], (200, 1))
        begin = rng.uniform(-2, 0, 200)
        end = begin + rng.uniform(0, 2, 200)
        found = find_piece_roots(c, begin, end)
        assert found.shape == (200, degree)
        for row, given, a, b in zip(found, roots, begin, end, strict=True):
            inside = given[(given > a) & (given < b)]
            near = np.diff(given).min(initial=1.0)
            if near < 1e-3 or np.abs(given[:, None] - [a, b]).min() < 1e-6:
                continue
            np.testing.assert_allclose(row[np.isfinite(row)], inside, atol=1e-9 / near**2)


def test_zeros_at_ends_constants_and_nothing():
    found = find_piece_roots(
        np.array([[0.0, 1.0], [1.0, -1.0], [0.0, 0.0], [5.0, 0.0]]), np.zeros(4), np.ones(4)
    )
    assert found[0] == 0.0
    assert found[1] == 1.0
    assert np.isnan(found[3])
    assert find_piece_roots(np.ones((3, 1)), np.zeros(3), np.ones(3)).shape == (3, 0)
    assert find_piece_roots(np.zeros((0, 4)), np.zeros(0), np.zeros(0)).shape == (0, 3)
    assert np.isfinite(find_piece_roots(np.zeros((1, 6)), np.zeros(1), np.ones(1))).sum() <= 5
    assert np.isnan(find_piece_roots(np.full((1, 4), np.nan), np.zeros(1), np.ones(1))).all()
