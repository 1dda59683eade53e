"""Random rotations and poses, uniform in the sense that no frame is preferred."""

from __future__ import annotations

import math
from contextlib import AbstractContextManager

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, as_generator, guard_memory
from cspace.errors import InputError, InputTypeError, name_new_keywords, shown
from cspace.spatial.planar import matrix_of_angle
from cspace.spatial.poses import assemble
from cspace.spatial.quaternions import matrix_of_quaternion

Size = int | tuple[int, ...]


@name_new_keywords
def random_rotation(size: Size = (), *, rng: int | np.random.Generator | None = None) -> Array:
    """Rotations drawn uniformly: turned by any fixed rotation, the distribution stays the same.

    q = (√(1−u) sin 2πa, √(1−u) cos 2πa, √u sin 2πb, √u cos 2πb) with u, a, b uniform in [0, 1).

    size: how many, an int or a shape; () for one. rng: seed, Generator or None. Returns (..., 3, 3), the size
    first. Source: Shoemake 1992.
    """
    shape = _shape(size)
    with _guard_size(size, shape):
        return _rotations(shape, as_generator(rng))


@name_new_keywords
def random_pose(
    size: Size = (),
    *,
    lower: npt.ArrayLike = -1.0,
    upper: npt.ArrayLike = 1.0,
    rng: int | np.random.Generator | None = None,
) -> Array:
    """Poses with uniform rotations and translations uniform in a box.

    size: how many, an int or a shape; () for one. lower, upper: corners of the box, (3,) or one number [m].
    rng: seed, Generator or None. Returns (..., 4, 4), the size first.
    """
    shape, generator = _shape(size), as_generator(rng)
    with _guard_size(size, shape):
        R = _rotations(shape, generator)
        return assemble(R, _box(shape, 3, lower, upper, generator))


@name_new_keywords
def random_rotation_2d(size: Size = (), *, rng: int | np.random.Generator | None = None) -> Array:
    """Planar rotations with the angle uniform in [−π, π).

    size: how many, an int or a shape. rng: seed, Generator or None. Returns (..., 2, 2), the size first.
    """
    shape = _shape(size)
    with _guard_size(size, shape):
        return matrix_of_angle(np.asarray(as_generator(rng).uniform(-np.pi, np.pi, shape)))


@name_new_keywords
def random_pose_2d(
    size: Size = (),
    *,
    lower: npt.ArrayLike = -1.0,
    upper: npt.ArrayLike = 1.0,
    rng: int | np.random.Generator | None = None,
) -> Array:
    """Planar poses with uniform headings and translations uniform in a rectangle.

    size: how many, an int or a shape. lower, upper: corners of the rectangle, (2,) or one number [m].
    rng: seed, Generator or None. Returns (..., 3, 3), the size first.
    """
    shape, generator = _shape(size), as_generator(rng)
    with _guard_size(size, shape):
        R = matrix_of_angle(np.asarray(generator.uniform(-np.pi, np.pi, shape)))
        return assemble(R, _box(shape, 2, lower, upper, generator))


def _rotations(shape: tuple[int, ...], generator: np.random.Generator) -> Array:
    u, a, b = np.moveaxis(generator.random((*shape, 3)), -1, 0)
    near, far = np.sqrt(1.0 - u), np.sqrt(u)
    a, b = 2.0 * np.pi * a, 2.0 * np.pi * b
    q = np.stack([near * np.sin(a), near * np.cos(a), far * np.sin(b), far * np.cos(b)], axis=-1)
    return matrix_of_quaternion(q, "quaternion")


def _box(
    shape: tuple[int, ...],
    n: int,
    lower: npt.ArrayLike,
    upper: npt.ArrayLike,
    generator: np.random.Generator,
) -> Array:
    low, high = as_floats(lower, "lower"), as_floats(upper, "upper")
    for name, corner in (("lower", low), ("upper", high)):
        if corner.shape not in {(), (n,)}:
            raise InputError(f"{name} has shape {corner.shape}, expected ({n},) or one number")
    if (low > high).any():
        raise InputError(f"lower {low.tolist()} exceeds upper {high.tolist()}; swap them")
    return np.asarray(low + (high - low) * generator.random((*shape, n)))


def _shape(size: Size) -> tuple[int, ...]:
    dimensions = size if isinstance(size, (tuple, list)) else (size,)
    for n in dimensions:
        if isinstance(n, bool) or not isinstance(n, (int, np.integer)):
            raise InputTypeError(f"size is {shown(size)}; it must be an int or a tuple of ints")
        if n < 0:
            raise InputError(f"size is {size!r}; it must not be negative")
    return tuple(int(n) for n in dimensions)


def _guard_size(size: Size, shape: tuple[int, ...]) -> AbstractContextManager[None]:
    """InputError for a size whose matrices exceed the memory."""
    return guard_memory("size", size, 9.0 * math.prod(shape), "draw fewer at once")
