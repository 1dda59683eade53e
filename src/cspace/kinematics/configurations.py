"""Configurations drawn at random, within the limits of a robot."""

from __future__ import annotations

import sys
from typing import TypeAlias

import numpy as np

from cspace.arrays import Array, as_generator, bounded_number, guard_memory, whole_number
from cspace.errors import InputError
from cspace.model import Limits

Seed: TypeAlias = "int | np.random.Generator | None"

ROWS_AT_ONCE = 1 << 15


def random_configurations(
    limits: Limits, joint_types: str, n: int | None = None, *, rng: Seed = None, reach: float | None = None
) -> Array:
    """Configurations drawn uniformly between the limits.

    limits: of the joints, each (n_joints,). joint_types: "R" or "P" per joint. n: how many; None gives one,
    without a leading axis. rng: seed or generator. A revolute joint without limits is sampled from (−π, π];
    one with a limit on one side from the π inside it; a prismatic joint without limits needs
    reach, the length [m] drawn on the open side.

    Returns q (n, n_joints) or (n_joints,) [rad or m].
    Raises InputError for a prismatic joint with an open side and without reach, a negative n or reach, an
    n beyond the memory;
    InputTypeError for values that are not numbers.
    """
    if n is not None:
        n = whole_number(n, "n", 0, sys.maxsize)
    if reach is not None:
        reach = bounded_number(reach, "reach", 0.0, "it must be one length [m], 0 or more")
    lower, upper = np.array(limits.lower), np.array(limits.upper)
    below, above = np.isinf(lower), np.isinf(upper)
    span = np.array([np.pi if kind == "R" else np.nan if reach is None else reach for kind in joint_types])
    if (open_ended := np.flatnonzero((below | above) & np.isnan(span))).size:
        i = int(open_ended[0])
        raise InputError(
            f"prismatic joint {i} has the limits {lower[i]:g} and {upper[i]:g} m; without a finite range give"
            " reach="
        )
    lower[below] = np.where(above, -span, upper - span)[below]
    upper[above] = np.where(below, span, lower + span)[above]
    generator, count = as_generator(rng), 1 if n is None else n
    with guard_memory("n", n, count * lower.size, "draw fewer configurations"):
        q = np.empty((count, lower.size))
    for begin in range(0, count, ROWS_AT_ONCE):  # an interrupt comes between two steps
        rows = q[begin : begin + ROWS_AT_ONCE]
        # From the upper end downward: (−π, π] excludes −π and includes π.
        np.subtract(upper, (upper - lower) * generator.random(rows.shape), out=rows)
    return q[0] if n is None else q
