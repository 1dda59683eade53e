"""Scan matching: the pose from which a scan fits a field or another scan best, near a guess."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, guard_memory, one_array, one_number, positive_number
from cspace.errors import InputError, check_known
from cspace.localization.checks import read_pose
from cspace.localization.scans.points import MOST_BEAMS, read_scan, thin_scan
from cspace.maps import ByteField
from cspace.tables import one_line, tabulate
from cspace.tolerances import WIDEST_BELL

METHODS: Final = ("correlation", "icp")
AMBIGUOUS: Final = 0.95
"""A second peak of this share of the best score makes a match ambiguous; the core has the same number."""
LARGEST_WINDOW: Final = 100.0
"""Half a side [m]; search_pose is for whole maps."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class ScanMatch:
    """Where a scan fits best; truthy if it is matched.

    pose (3,): x, y [m], θ [rad] of base in map, or in the base of the other scan. covariance (3, 3) of ξ in
    T exp ξ, in base. score: the mean of the field at the ends of the beams there, 0 to 1. second: the best
    score of another peak; 0 with ICP. status: "matched", "ambiguous", "no overlap" or "not converged";
    reason: the same in words.
    """

    pose: Array
    covariance: Array
    score: float
    second: float
    status: str
    reason: str

    def __bool__(self) -> bool:
        return self.status == "matched"

    def __repr__(self) -> str:
        x, y, theta = self.pose
        text = f"{self.status}: ({x:.3f}, {y:.3f}, {theta:.4f}), score {self.score:.3f}"
        return one_line("ScanMatch", text)


def match_scan(
    scan: Any,
    field: Any,
    *,
    guess: npt.ArrayLike = (0.0, 0.0, 0.0),
    window: tuple[float, float] = (0.8, 0.26),
    method: str = "correlation",
    least_score: float = 0.3,
    resolution: float = 0.05,
    sigma: float = 0.08,
) -> ScanMatch:
    """The pose of a scan in a map, or relative to another scan, near a guess.

    "correlation" scores every translation by whole cells and every rotation in the window exactly, and
    refines the best one by Gauss–Newton on the field. The covariance is the second moment of that surface. A
    second peak within 5 % makes the match ambiguous (Olson 2009). "icp" draws each point to the line through
    the two nearest points of another scan (Censi 2008); it sees one minimum alone, so that the guess must
    be near.

    scan: Scans of one row, or points in base (m, 2) [m] in the order of the beams. field: a ByteField, such
    as that of EvidenceGrid.likelihood_field; or another scan, of which a field of bells exp(−d²/2σ²) is made
    with `resolution` and `sigma` [m]. guess: (3,) or (3, 3). window: half its sides [m] and [rad].
    least_score: of a match. Raises InputError for a scan without points, and UnknownNameError for another
    method.
    """
    check_known("method", method, METHODS)
    points = thin_scan(read_scan(scan, "scan"), MOST_BEAMS)
    near = read_pose(guess, "guess")
    reach, turn = read_window(window)
    least = one_number(least_score, "least_score")
    if isinstance(field, ByteField):
        if method == "icp":
            raise InputError('field is a ByteField; method="icp" needs the points of another scan')
        reference, made = None, field
    else:
        other = read_scan(field, "field")
        reference, made = other if method == "icp" else None, make_field(other, resolution, sigma)
    place = (made.scores, made.resolution, made.origin, made.outside)
    with guard_memory("window", window, reach * reach * turn / made.resolution**2, "give a smaller window"):
        if reference is not None:
            found = _core.match_point_lines(*place, reference, points, near, reach)
        else:
            found = search_window(place, points, near, reach, turn)
    return report_match(*found, method=method, least=least)


def search_window(
    place: tuple[Any, float, Any, int], points: Array, near: Array, reach: float, turn: float
) -> Any:
    """The answer of the core for all poses of a window; InputError for windows of too many poses."""
    try:
        return _core.match_points(*place, points, near, reach, turn, True)
    except ValueError as error:
        raise InputError(
            f"window is ({reach:g}, {turn:g}), too many poses of cells of {place[1]:g} m; give a smaller one,"
            " or take search_pose for a whole map"
        ) from error


def read_window(window: Any) -> tuple[float, float]:
    """Half the sides of a window, [m] and [rad]."""
    reach, turn = one_array(window, "window", (2,), "half the sides [m] and [rad]").tolist()
    positive_number(reach, "window", largest=LARGEST_WINDOW)
    positive_number(turn, "window", "its angle is above zero, at most π", largest=np.pi)
    return reach, turn


def make_field(points: Array, resolution: float, sigma: float) -> ByteField:
    """A field of bells exp(−d²/2σ²) about points (m, 2); InputError for points that are too far apart."""
    cell, width = positive_number(resolution, "resolution"), positive_number(sigma, "sigma")
    check_bell(cell, width, f"sigma is {width:g} m; give one of at most")
    try:
        with guard_memory("resolution", cell, np.ptp(points, axis=0).prod() / cell**2, "give larger cells"):
            scores, x, y = _core.make_field_of_points(points, cell, width)
    except ValueError as error:
        raise InputError(
            f"the points span {np.ptp(points, axis=0).max():g} m, too far for cells of {cell:g} m; leave out"
            " beams without return, or give a larger resolution"
        ) from error
    return ByteField(scores, cell, np.array([x, y]))


def check_bell(resolution: float, sigma: float, text: str) -> None:
    """InputError for a bell of more than tolerances.WIDEST_BELL cells. text: what precedes the limit."""
    if sigma > WIDEST_BELL * resolution:
        raise InputError(
            f"{text} {WIDEST_BELL * resolution:g} m, {WIDEST_BELL} cells of {resolution:g} m, or larger cells"
        )


def report_match(
    is_found: bool,
    is_ambiguous: bool,
    pose: Array,
    covariance: Array,
    score: float,
    second: float,
    *,
    method: str,
    least: float,
) -> ScanMatch:
    """The answer of the core as ScanMatch."""
    status, reason = "matched", f"the scan scores {score:.3f}, and {second:.3f} in the next peak"
    if not is_found and method == "icp":
        status = "not converged"
        reason = (
            "too few points have two neighbours within the window, or they leave a direction undetermined"
        )
    elif not is_found or score < least:
        status, reason = "no overlap", f"the best score in the window is {score:.3f}, below {least:g}"
    elif is_ambiguous:
        status = "ambiguous"
        reason = f"a second peak scores {second:.3f}, at least {AMBIGUOUS:.0%} of the best one, {score:.3f}"
    return ScanMatch(np.reshape(pose, 3), np.reshape(covariance, (3, 3)), score, second, status, reason)
