"""The colours of joints over time: a colour each for those that move most, grey for the others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from cspace.arrays import Array

MOST_NAMED: Final = 10
"""Curves that a reader can tell apart, and that the default colours of matplotlib have."""
REST: Final = "0.75"
"""The colour of the others."""


def color_joints(joints: Sequence[str], q: Array) -> tuple[list[str], list[str]]:
    """The names and the colours of joints that move as q (..., k, n): the ten of the widest range are named,
    each in a colour of its own; the others have no name and are grey."""
    rows = q.reshape(-1, len(joints))
    good = rows[np.isfinite(rows).all(axis=-1)]
    ranges = np.ptp(good, axis=0) if len(good) else np.zeros(len(joints))
    chosen = sorted(np.argsort(-ranges, kind="stable")[:MOST_NAMED].tolist())
    colors = {k: f"C{i}" for i, k in enumerate(chosen)}
    return (
        [name if k in colors else "" for k, name in enumerate(joints)],
        [colors.get(k, REST) for k in range(len(joints))],
    )
