"""Grids of a path whose intervals grow and shrink gradually."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from cspace.arrays import Array
from cspace.trajectory.path import Path
from cspace.trajectory.timed_path import Grid

GROWTH: Final = 0.4
"""Of the size of intervals by place: neighbours differ by a factor of 1.5. Faster growth costs duration."""


class Section(NamedTuple):
    """Pieces first … last − 1 of a path, between two places at which a motion stands."""

    first: int
    last: int


def divide_gradually(path: Path, section: Section, count: int, margin: float) -> Grid:
    """About `count` intervals of a section without a margin at its ends, beside which they are as short."""
    lengths = path.lengths[section.first : section.last]
    largest = float(lengths.sum()) / count
    sizes = _node_sizes(lengths, largest, margin)
    piece, begin, end = [], [], []
    for k, length in enumerate(lengths.tolist()):
        low = margin if k == 0 else 0.0
        high = length - margin if k == len(lengths) - 1 else length
        places = (low + _place_graded(high - low, sizes[k], sizes[k + 1], largest)) / length
        if k < len(lengths) - 1:
            places[-1] = 1.0
        piece.append(np.full(len(places) - 1, section.first + k, dtype=np.int32))
        begin.append(places[:-1])
        end.append(places[1:])
    return Grid(np.concatenate(piece), np.concatenate(begin), np.concatenate(end))


def _node_sizes(lengths: Array, largest: float, margin: float) -> list[float]:
    """The size of intervals at the ends of pieces: half of the shorter piece, or what growth permits."""
    caps = np.minimum(largest, 0.5 * lengths)
    sizes = [margin, *np.minimum(caps[:-1], caps[1:]).tolist(), margin]
    for k, length in enumerate(lengths.tolist()):
        sizes[k + 1] = min(sizes[k + 1], sizes[k] + GROWTH * length)
    for k in range(len(lengths) - 1, -1, -1):
        sizes[k] = min(sizes[k], sizes[k + 1] + GROWTH * float(lengths[k]))
    return sizes


def _place_graded(length: float, left: float, right: float, largest: float) -> Array:
    """Places from 0 to length, with intervals of size min(left + g d, right + g (length − d), largest) at d.

    The number of intervals up to d is the integral of 1 / size: a logarithm where the size grows.
    """
    up, down = (largest - left) / GROWTH, (largest - right) / GROWTH
    if up + down > length:
        up = min(max(0.5 * (length + (right - left) / GROWTH), 0.0), length)
        down = length - up
    top = max(left + GROWTH * up, right + GROWTH * down)
    rising, falling = np.log1p(GROWTH * up / left) / GROWTH, np.log1p(GROWTH * down / right) / GROWTH
    flat = (length - up - down) / top
    total = rising + flat + falling
    c = np.linspace(0.0, total, max(1, int(np.ceil(total))) + 1)
    with np.errstate(over="ignore"):
        grown = left * np.expm1(GROWTH * np.minimum(c, rising)) / GROWTH
        shrunk = length - right * np.expm1(GROWTH * np.minimum(total - c, falling)) / GROWTH
    middle = up + (c - rising) * top
    places = np.where(c <= rising, grown, np.where(c <= rising + flat, middle, shrunk))
    places[0], places[-1] = 0.0, length
    return np.asarray(places)
