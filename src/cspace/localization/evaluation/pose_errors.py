"""Absolute and relative errors of trajectories (Sturm et al. 2012), as evo computes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, bounded_number, positive_number, whole_number
from cspace.errors import InputError, check_known
from cspace.localization.evaluation.alignment import align_points
from cspace.localization.evaluation.association import associate_tracks
from cspace.localization.evaluation.tracks import Track, read_track
from cspace.spatial import inverse_pose, inverse_pose_2d, rotation_distance, rotation_distance_2d
from cspace.tables import count_things, one_line, tabulate

Rows = npt.NDArray[np.intp]
ALIGNMENTS = ("se2", "se3")
UNITS = ("m", "s", "frames")


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class PoseErrors:
    """Errors of an estimated trajectory, a row per pose (ate) or per pair of poses (rpe).

    kind: what was measured, "ate" or "rpe over 1 m". errors (k,) [m]: of the positions; turns (k,) [rad]: of
    the rotations. times (k,) [s]: of the pose, or of the later one of the pair; None for trajectories without
    times. pairs (k, 2): rows of the poses among the associated ones. poses, truth: the associated poses, n
    rows x, y, θ or (n, 4, 4), the estimate aligned by `alignment` (3, 3) or (4, 4), T_truth_estimate.
    """

    kind: str
    errors: Array
    turns: Array
    times: Array | None
    pairs: Rows
    poses: Array
    truth: Array
    alignment: Array

    def __len__(self) -> int:
        """How many errors there are."""
        return len(self.errors)

    def __repr__(self) -> str:
        numbers = f"rmse {self.rmse:.6g} m, mean {self.mean:.6g} m, max {self.max:.6g} m"
        what = "pose" if self.kind == "ate" else "pair"
        return one_line("PoseErrors", f"{self.kind} of {count_things(len(self), what)}: {numbers}")

    @property
    def rmse(self) -> float:
        """The root of the mean squared error of the positions [m]."""
        return float(np.sqrt(np.mean(self.errors**2)))

    @property
    def mean(self) -> float:
        """The mean error of the positions [m]."""
        return float(np.mean(self.errors))

    @property
    def median(self) -> float:
        """The median of the errors of the positions [m]."""
        return float(np.median(self.errors))

    @property
    def max(self) -> float:
        """The largest error of a position [m]."""
        return float(np.max(self.errors))

    @property
    def turn_rmse(self) -> float:
        """The root of the mean squared error of the rotations [rad]."""
        return float(np.sqrt(np.mean(self.turns**2)))

    @property
    def turn_max(self) -> float:
        """The largest error of a rotation [rad]."""
        return float(np.max(self.turns))


def ate(
    estimate: Any,
    truth: Any,
    *,
    align: str | None = "se2",
    interpolate: bool = False,
    max_difference: float = 0.01,
    max_gap: float = np.inf,
) -> PoseErrors:
    """The absolute trajectory error: how far the estimated positions are from the true ones.

    estimate, truth: TimedPoses, an answer with `poses` (and `times`), a log (its truth), arrays (n, 3) or
    (n, 4, 4) whose rows correspond, or paths of files (TUM, KITTI, logs with truth). align: "se2" compares in
    the plane after the rigid motion of least squares, without scale; "se3" in space; None does not move the
    estimate, and compares in space if both are poses of space. Poses belong together if their times differ by
    at most max_difference [s]; interpolate=True takes the denser trajectory at the times of the other, not
    across gaps longer than max_gap [s]. Raises InputError if nothing belongs together, or if the poses
    determine no alignment. Source: Sturm et al. 2012.
    """
    found, true = read_pair(estimate, truth, align, interpolate, max_difference, max_gap)
    alignment = np.eye(found.T.shape[-1])
    if align is not None:
        alignment = align_points(found.T[:, :-1, -1], true.T[:, :-1, -1])
    moved = Track(found.times, alignment @ found.T)
    rows = np.arange(len(found), dtype=np.intp)
    errors = np.linalg.norm(moved.T[:, :-1, -1] - true.T[:, :-1, -1], axis=1)
    turns = measure_turns(moved.T, true.T)
    return PoseErrors(
        "ate", errors, turns, found.times, np.stack([rows, rows], 1), moved.flat(), true.flat(), alignment
    )


def rpe(
    estimate: Any,
    truth: Any,
    *,
    delta: float = 1.0,
    unit: str = "m",
    align: str | None = "se2",
    interpolate: bool = False,
    max_difference: float = 0.01,
    max_gap: float = np.inf,
) -> PoseErrors:
    """The relative pose error: how far motions over a distance or a time are from the true ones.

    Consecutive pairs of poses are compared, E = (Qᵢ⁻¹ Qⱼ)⁻¹ (Pᵢ⁻¹ Pⱼ) with Q true and P estimated. delta and
    unit: a pair ends where the path of the estimate is at least delta [m], the time at least delta [s], or
    the rows are delta "frames" apart. align: "se2" compares in the plane, "se3" in space, None in space if
    both are poses of space; relative motions need no alignment. The rest as of `ate`. Raises InputError if
    the trajectory is shorter than delta. Source: Sturm et al. 2012.
    """
    check_known("unit", unit, UNITS)
    length = positive_number(delta, "delta") if unit != "frames" else whole_number(delta, "delta", 1, 2**31)
    found, true = read_pair(estimate, truth, align, interpolate, max_difference, max_gap)
    starts, ends = pair_poses(found, length, unit)
    if not len(starts):
        raise InputError(
            f"delta is {delta:g} {unit}, and the trajectory of {count_things(len(found), 'pose')} is shorter"
        )
    P, Q = relate_poses(found.T[starts], found.T[ends]), relate_poses(true.T[starts], true.T[ends])
    errors = np.linalg.norm(relate_poses(Q, P)[:, :-1, -1], axis=1)
    times = None if found.times is None else found.times[ends]
    pairs, alignment = np.stack([starts, ends], axis=1), np.eye(found.T.shape[-1])
    kind = f"rpe over {delta:g} {unit}"
    return PoseErrors(kind, errors, measure_turns(P, Q), times, pairs, found.flat(), true.flat(), alignment)


def read_pair(
    estimate: Any, truth: Any, align: str | None, interpolate: bool, max_difference: float, max_gap: float
) -> tuple[Track, Track]:
    """Both trajectories, associated, in the plane or in space."""
    if align is not None:
        check_known("align", align, ALIGNMENTS)
    most = bounded_number(max_difference, "max_difference", 0.0, "it must not be below zero [s]")
    gap = positive_number(max_gap, "max_gap", largest=np.inf)
    found, true = read_track(estimate, "estimate"), read_track(truth, "truth")
    if align == "se3" or (align is None and found.is_spatial and true.is_spatial):
        found, true = found.in_space(), true.in_space()
    else:
        found, true = found.in_plane(), true.in_plane()
    return associate_tracks(found, true, interpolate=interpolate, max_difference=most, max_gap=gap)


def pair_poses(track: Track, delta: float, unit: str) -> tuple[Rows, Rows]:
    """Rows of the poses where consecutive stretches of the length delta begin and end."""
    if unit == "frames":
        marks = np.arange(0, len(track), int(delta), dtype=np.intp)
    elif unit == "s":
        if track.times is None:
            raise InputError('the poses have no times; give unit="m" or unit="frames"')
        marks = np.array(list(mark_stretches(np.diff(track.times), delta)), dtype=np.intp)
    else:
        steps = np.linalg.norm(np.diff(track.T[:, :-1, -1], axis=0), axis=1)
        marks = np.array(list(mark_stretches(steps, delta)), dtype=np.intp)
    return marks[:-1], marks[1:]


def mark_stretches(steps: Array, delta: float) -> Iterator[int]:
    """Row 0, and each row by which the sum of the steps since the last mark has reached delta."""
    yield 0
    length = 0.0
    for row, step in enumerate(steps.tolist(), 1):
        length += step
        if length >= delta:
            yield row
            length = 0.0


def relate_poses(T: Array, others: Array) -> Array:
    """T⁻¹ T', (n, d, d)."""
    inverse = inverse_pose if T.shape[-1] == 4 else inverse_pose_2d
    return np.asarray(inverse(T) @ others)


def measure_turns(T: Array, others: Array) -> Array:
    """The angles between rotations (n,) [rad]."""
    distance = rotation_distance if T.shape[-1] == 4 else rotation_distance_2d
    return np.asarray(distance(T[:, :-1, :-1], others[:, :-1, :-1]))
