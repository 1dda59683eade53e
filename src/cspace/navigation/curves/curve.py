"""A curve of a car: its segments, and the pose at every arc length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, guard_memory, positive_number
from cspace.errors import InputError
from cspace.tables import show_fields, tabulate

KINDS: Final = {1: "left", 0: "straight", -1: "right"}
Pieces = tuple[tuple[int, float], ...]
"""Turn (+1 left, 0 straight, −1 right) and length [m] of each segment; a negative length is driven in
reverse."""


@show_fields
@dataclass(frozen=True)
class Segment:
    """One segment of a curve: kind "left", "straight" or "right" as seen when driving forwards, length [m],
    curvature [1/m] (positive to the left) and direction: 1 forwards, −1 in reverse."""

    kind: str
    length: float
    curvature: float
    direction: int


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Curve:
    """A path of a car from pose to pose, composed of arcs of one radius and straight segments.

    start, goal (3,): x, y [m] of the middle of the rear axle and heading theta [rad]. radius [m]: of the
    arcs.
    """

    start: Array
    goal: Array
    radius: float
    _pieces: Pieces

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """The segments in driving order; none where start and goal are the same pose."""
        return tuple(
            Segment(KINDS[turn], abs(length), turn / self.radius, 1 if length > 0 else -1)
            for turn, length in self._pieces
        )

    @property
    def length(self) -> float:
        """The distance driven [m], the sum of forward and reverse driving."""
        return sum(abs(length) for _, length in self._pieces)

    @property
    def word(self) -> str:
        """The letters of the segments, L, S and R, each with + if driven forwards and − if in reverse."""
        return "".join("SLR"[turn] + ("+" if length > 0 else "−") for turn, length in self._pieces)

    @property
    def cusps(self) -> Array:
        """The arc lengths at which the car changes its direction of driving, (k,) [m]."""
        signs = np.sign([length for _, length in self._pieces])
        return np.asarray(self._ends[:-1][signs[1:] != signs[:-1]])

    @cached_property
    def _ends(self) -> Array:
        """The arc length at the end of each segment, (k,) [m]."""
        return np.cumsum([abs(length) for _, length in self._pieces])

    def at(self, s: Any) -> Array:
        """The poses at arc lengths s (...,) [m], (..., 3).

        Headings are continuous from that of the start, so that the last may differ from that of the goal by
        a multiple of 2π. Raises InputError for an arc length outside the curve.
        """
        lengths = as_floats(s, "s")
        beyond = lengths[(lengths < 0) | (lengths > self.length)]
        if beyond.size:
            raise InputError(f"s holds {beyond[0]:g}; the curve has lengths of 0 to {self.length:g} m")
        pieces = np.array(self._pieces).reshape(-1, 2)
        poses = _core._car_poses(self.start, pieces, self.radius, np.ascontiguousarray(lengths.ravel()))
        return poses.reshape(*lengths.shape, 3)

    def sample(self, spacing: float) -> Array:
        """Poses at most `spacing` [m] apart, (n, 3), both ends and those of every segment included."""
        step = positive_number(spacing, "spacing", "give a length above zero, in metres")
        parts, begin = [np.zeros(1)], 0.0
        with guard_memory("spacing", spacing, 3 * self.length / step, "give a larger one"):
            for end in self._ends.tolist():
                count = max(1, int(np.ceil((end - begin) / step)))
                parts.append(np.linspace(begin, end, count + 1)[1:])
                begin = end
            return self.at(np.minimum(np.concatenate(parts), self.length))

    def __repr__(self) -> str:
        return f"<Curve {self.word or 'of no length'}: {self.length:.6g} m, radius {self.radius:g} m>"
