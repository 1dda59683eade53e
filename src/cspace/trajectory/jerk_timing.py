"""Timing of a path under jerk limits: sections between stops, each by the compiled barrier method."""

from __future__ import annotations

from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace._core import time_path_with_jerk
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.tolerances import BARRIER_GAP, LAUNCH_PART
from cspace.trajectory.graded_grid import Section, divide_gradually
from cspace.trajectory.jerk_timed_path import LANDING, LAUNCH, QUADRATIC
from cspace.trajectory.path import Path, restrict_pieces
from cspace.trajectory.sampled_limits import SampledLimits
from cspace.trajectory.timed_path import Grid, TimedPath

LEAST_INTERVALS: Final = 24
"""Of a section between stops, beside those that lead up to its ends."""

PIECE_INTERVALS: Final = 30
"""Of a piece, by default: halving them shortens motions by a hundredth."""

DEFAULT_INTERVALS: Final = 150
"""Of a path, by default and at least."""

MANY_INTERVALS: Final = 3000
"""Of a path, from which on pieces have fewer by default if they are short parts of a smooth path."""

PLAIN_INTERVALS: Final = 8
"""Of a piece without jerk limits, at least: such a piece needs no more under them."""

FIRST_SLOWER: Final = 1.5
"""Duration of the motion to begin with, over that without jerk limits."""

SHORT_PIECE: Final = 100.0
"""Multiple of the first and the last piece beyond which a launch is not as long as its path permits."""

LAUNCH_SLACK: Final = 0.97
"""Share of the limits that a launch uses: the motion after it needs room."""


PathArrays = tuple[Array, Array, npt.NDArray[np.int8]]
"""A path as the core reads it: control points, lengths of pieces, and flags of the breaks that are stops."""


class JerkLimits(NamedTuple):
    """Largest velocity, acceleration and jerk of each joint (dof,)."""

    velocity: Array
    acceleration: Array
    jerk: Array


class SectionLaw(NamedTuple):
    """Intervals of a section with their squared speeds (k, 3), laws (k,) and path jerks (k,)."""

    grid: Grid
    squares: Array
    law: npt.NDArray[np.int8]
    jerk: Array


def refuse_jumps(path: Path) -> None:
    """InputError where the second derivative of a path jumps at other places than its stops."""
    jumps = path.jumps(2) & ~path.jumps(1)
    if jumps.any():
        s = float(path.breaks[jumps][0])
        raise InputError(
            f"the second derivative of the path jumps at s = {s:.6g}, so that jerks are unbounded there;"
            " use spline, or blend with quintic blends"
        )


def find_sections(path: Path) -> list[Section]:
    """The pieces between the stops of a path."""
    stops = [0, *(np.flatnonzero(path.stop_flags)).tolist(), len(path)]
    return [Section(a, b) for a, b in pairwise(stops)]


def divide_section(path: Path, section: Section, count: int) -> Grid:
    """The share that a section has of so many intervals of the path, without a margin at its ends."""
    share = float(path.breaks[section.last] - path.breaks[section.first]) / path.length
    return divide_gradually(
        path, section, max(LEAST_INTERVALS, round(count * share)), _find_margin(path, section)
    )


def divide_for_feed(grid: Grid, parts: npt.NDArray[np.intp]) -> Grid:
    """The grid with its intervals divided into parts (k,), and neighbours with them: sizes stay gradual."""
    half = -(-parts // 2)
    return grid.divided(np.maximum.reduce([parts, np.append(half[1:], 1), np.append(1, half[:-1])]))


def _find_margin(path: Path, section: Section) -> float:
    """The length of the launch and the landing of a section."""
    whole = float(path.breaks[section.last] - path.breaks[section.first])
    first, last = path.lengths[[section.first, section.last - 1]].tolist()
    return float(LAUNCH_PART * min(whole, SHORT_PIECE * first, SHORT_PIECE * last))


def time_sections(sections: list[Section], plain: TimedPath) -> list[float]:
    """The seconds of each section in a motion."""
    breaks = plain.path.breaks[[sections[0].first, *(each.last for each in sections)]]
    return list(np.diff(np.interp(breaks, plain.grid, plain.knots)).tolist())


def time_section(
    path: Path,
    section: Section,
    arrays: tuple[Array, Array, npt.NDArray[np.int8]],
    limits: JerkLimits,
    grid: Grid,
    seconds: float,
    sampled: SampledLimits | None,
) -> SectionLaw | None:
    """The fastest motion along a section from rest to rest; None if none keeps the limits.

    arrays: the path as the core reads it. grid: as of divide_section, or finer. seconds: of the motion
    without jerk limits. sampled: those of torque and of a frame, if there are any.
    """
    margin = _find_margin(path, section)
    launch = find_launch_jerk(path, section.first, margin, limits, at_end=False)
    landing = find_launch_jerk(path, section.last - 1, margin, limits, at_end=True)
    found, squares, first, last = time_path_with_jerk(
        *arrays,
        limits.velocity,
        limits.acceleration,
        limits.jerk,
        (grid.piece, grid.begin, grid.end),
        (margin, launch),
        (margin, landing),
        FIRST_SLOWER * seconds,
        BARRIER_GAP,
        None if sampled is None else sampled(*grid),
    )
    return _add_launches(grid, section, squares, (first, last)) if found else None


def _add_launches(grid: Grid, section: Section, squares: Array, jerks: tuple[float, float]) -> SectionLaw:
    """The law of a section with the intervals from and to rest."""
    whole = Grid(
        np.concatenate([grid.piece[:1], grid.piece, grid.piece[-1:]]),
        np.concatenate([[0.0], grid.begin, grid.end[-1:]]),
        np.concatenate([grid.begin[:1], grid.end, [1.0]]),
    )
    first, last = squares[0, 0], squares[-1, 2]
    rows = np.concatenate([[[0.0, 0.5 * first, first]], squares, [[last, 0.5 * last, 0.0]]])
    law = np.full(len(rows), QUADRATIC, dtype=np.int8)
    law[0], law[-1] = LAUNCH, LANDING
    jerk = np.zeros(len(rows))
    jerk[0], jerk[-1] = jerks
    return SectionLaw(whole, rows, law, jerk)


def join_laws(laws: list[SectionLaw]) -> SectionLaw:
    """One after the other."""
    if len(laws) == 1:
        return laws[0]
    grid = Grid(*(np.concatenate([each.grid[k] for each in laws]) for k in range(3)))
    squares, law, jerk = (np.concatenate([each[k] for each in laws]) for k in range(1, 4))
    return SectionLaw(grid, squares, law.astype(np.int8), jerk)


def find_launch_jerk(path: Path, piece: int, margin: float, limits: JerkLimits, *, at_end: bool) -> float:
    """The largest path jerk c with which s = c t³ / 6 keeps all limits over a margin of a piece.

    There ṡs̈ = 3cs and ṡ³ = 4.5cs², so that the jerk is at most c (|q'| + 9s|q''| + 4.5s²|q'''|).
    """
    share = margin / path.lengths[piece]
    begin, end = (np.array([1.0 - share]), np.array([1.0])) if at_end else (np.zeros(1), np.array([share]))
    sizes = [
        np.abs(restrict_pieces(path._derivatives[order][[piece]], begin, end)).max(axis=(0, 1))
        for order in range(1, 4)
    ]
    used = sizes[0] + 9.0 * margin * sizes[1] + 4.5 * margin**2 * sizes[2]
    with np.errstate(divide="ignore", invalid="ignore"):
        jerk = LAUNCH_SLACK * float(np.nanmin(np.where(used > 0.0, limits.jerk / used, np.inf)))
        # At the end of the launch s̈ = c t and ṡ = c t² / 2 are largest, with c t³ = 6s.
        while True:
            seconds = np.cbrt(6.0 * margin / jerk)
            u, v = jerk * seconds, 0.5 * jerk * seconds**2
            within = (sizes[1] * v * v + sizes[0] * u <= LAUNCH_SLACK * limits.acceleration) & (
                sizes[0] * v <= LAUNCH_SLACK * limits.velocity
            )
            if (within | (used == 0.0)).all():
                return jerk
            jerk *= 0.5


def default_intervals(path: Path, plain: int) -> int:
    """How many intervals a path has without a number given; plain: those without jerk limits.

    Beyond many, each further one without jerk limits counts fourfold.
    """
    pieces = len(path)
    enough = max(MANY_INTERVALS, PLAIN_INTERVALS * pieces + 4 * (plain - PLAIN_INTERVALS * pieces))
    return max(DEFAULT_INTERVALS, min(PIECE_INTERVALS * pieces, enough))
