"""Random and degenerate rotations, poses and twists, the same in every test of this folder."""

from __future__ import annotations

import numpy as np

import cspace as cs

BATCHES = [(), (5,), (2, 3), (0,)]

ANGLES = {
    "zero": lambda g, n: np.zeros(n),
    "1e-320": lambda g, n: np.full(n, 1e-320),
    "1e-160": lambda g, n: np.full(n, 1e-160),
    "1e-9": lambda g, n: np.full(n, 1e-9),
    "1e-5": lambda g, n: np.full(n, 1e-5),
    "any": lambda g, n: g.uniform(0.0, np.pi - 1e-3, n),
    "quarter": lambda g, n: np.full(n, np.pi / 2),
    "π - 1e-9": lambda g, n: np.full(n, np.pi - 1e-9),
    "π": lambda g, n: np.full(n, np.pi),
    "π + 1e-9": lambda g, n: np.full(n, np.pi + 1e-9),
}
"""Turn angles by name: drawn by a generator for a shape."""

EXACT = 1e-12


def close(actual, expected, atol=EXACT):
    actual, expected = np.asarray(actual), np.asarray(expected)
    assert actual.shape == expected.shape
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=atol)


def directions(generator, shape, *, along_axes=False):
    """Unit vectors; with `along_axes` plus or minus one of x, y, z."""
    if along_axes:
        return np.eye(3)[generator.integers(0, 3, shape)] * generator.choice([-1.0, 1.0], (*shape, 1))
    v = generator.normal(size=(*shape, 3))
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def rotvecs(name, shape, seed=0, *, along_axes=False):
    generator = np.random.default_rng(seed)
    return (
        directions(generator, shape, along_axes=along_axes)
        * np.asarray(ANGLES[name](generator, shape))[..., None]
    )


def twists(name, shape, seed=0):
    v = np.random.default_rng(seed + 1).uniform(-1.0, 1.0, (*shape, 3))
    return np.concatenate([v, rotvecs(name, shape, seed)], axis=-1)


def poses(name, shape, seed=0):
    xyz = np.random.default_rng(seed + 1).uniform(-1.0, 1.0, (*shape, 3))
    return cs.pose(xyz, rotvec=rotvecs(name, shape, seed))
