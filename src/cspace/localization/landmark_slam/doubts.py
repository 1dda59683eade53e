"""Whether a map of landmarks contradicts the readings that made it."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.localization.filters.rows import follow_rows
from cspace.localization.landmark_slam.outcomes import ReadingOutcomes
from cspace.localization.log import Ids, Landmarks
from cspace.localization.sensors import RangeBearing, is_unlimited
from cspace.math.wrapping import wrap_angle

DOUBT_SPAN: Final = 50
"""Readings in a row of which the rejected ones are counted: some passes of a few landmarks."""
MOST_REJECTED: Final = {True: 0.5, False: 0.3}
"""Share of them, with and without names. In simulated drives whose readings were paired right, 2 to 30 % were
rejected, near other landmarks above all; on MRCLAM, paired wrongly, 34 to 100 %. Readings with names are only
rejected where they contradict, on MRCLAM up to 36 % by passers-by."""
TWIN_DEVIATIONS: Final = 3.0
"""Of the range: the sensor does not tell landmarks apart that are nearer to each other."""
MOST_TWINS: Final = 0.5
"""Share of the landmarks that have another one so near. Among random points it was up to 25 %."""
SURELY_SEEN: Final = 0.9
"""Part of the range and of the field of view of the sensor in which it sees a landmark surely."""
MOST_MISSED: Final = 0.12
"""Share of the sightings of landmarks without names that should have been, and were not. In simulated drives
with the right pairings it was 0 to 10 %, with landmarks on the map twice 15 to 40 %."""
MOST_TURN: Final = 1.0
"""Deviation [rad] of the heading that an extended filter may gain on the way: derivatives at one heading are
wrong by half for another one so far away. On MRCLAM it was up to 0.7."""


def find_gained_turn(covariances: Array) -> float:
    """The largest deviation of the heading [rad] from covariances (n, 3, 3), less that of the first one."""
    gained = float((covariances[:, 2, 2] - covariances[0, 2, 2]).max(initial=0.0))
    return float(np.sqrt(max(gained, 0.0)))


def find_rejected_share(readings: ReadingOutcomes) -> float:
    """The largest share of rejected readings among those in a row; 0 where there are fewer.

    A reading of a landmark at its place is rejected with the probability of the gate, or near others. Many
    rejections mean that the places are wrong, or that a landmark is on the map twice.
    """
    counts = np.concatenate([[0], np.cumsum(readings.verdict == "rejected")])
    if len(counts) <= DOUBT_SPAN:
        return 0.0
    return float((counts[DOUBT_SPAN:] - counts[:-DOUBT_SPAN]).max() / DOUBT_SPAN)


def find_twin_share(landmarks: Landmarks, range_sigma: float) -> float:
    """The share of landmarks that have another one nearer than the sensor can tell apart."""
    if len(landmarks) < 2:
        return 0.0
    between = landmarks.points[:, None] - landmarks.points
    distances = np.hypot(between[..., 0], between[..., 1])
    np.fill_diagonal(distances, np.inf)
    return float((distances.min(axis=1) < TWIN_DEVIATIONS * range_sigma).mean())


def find_missed_share(
    landmarks: Landmarks, poses: Array, node: Ids, readings: ReadingOutcomes, sensor: RangeBearing
) -> float:
    """Of the sightings that landmarks of the map should have had from poses (n, 3), at which readings of
    node (k,) were made, the share that is missing; 0 where the range of the sensor is not limited.

    Particles and pairings that are left always fit what was seen; a landmark that is on the map twice, or at
    a wrong place, is also not seen where it should be.
    """
    if not len(landmarks) or not len(node) or is_unlimited(sensor.most_range):
        return 0.0
    nodes, update = np.unique(node, return_inverse=True)
    row = np.full(len(node), -1)
    is_known = np.isin(readings.landmark, landmarks.names)
    row[is_known] = landmarks.rows_of(readings.landmark[is_known])
    seen = np.zeros((len(nodes), len(landmarks)), dtype=bool)
    seen[update[row >= 0], row[row >= 0]] = True
    T = follow_rows(poses[nodes], np.broadcast_to(np.asarray(sensor.mount), (len(nodes), 3)))
    away = landmarks.points[None] - T[:, None, :2]
    bearing = wrap_angle(np.arctan2(away[..., 1], away[..., 0]) - T[:, 2:])
    expected = np.hypot(away[..., 0], away[..., 1]) < SURELY_SEEN * sensor.most_range
    if sensor.field_of_view < 2 * np.pi:
        expected &= np.abs(bearing) < SURELY_SEEN * 0.5 * sensor.field_of_view
    return float((expected & ~seen).sum() / max(int(expected.sum()), 1))


def explain_turn(turn: float) -> str:
    """Why a gained deviation of the heading makes the map of an extended filter doubtful; nothing if not."""
    if turn <= MOST_TURN:
        return ""
    return (
        f"the heading was uncertain by {turn:.1f} rad (1σ) on the way (at most {MOST_TURN:g} may be, for its"
        " derivatives); give noise= that fits the odometry"
    )


def explain_doubt(
    share: float, missed: float, is_named: bool, landmarks: Landmarks, range_sigma: float
) -> str:
    """Why the map is doubtful; nothing if it is not. share: of rejected readings, missed: of sightings, as
    found above."""
    if share > MOST_REJECTED[is_named]:
        fitted = "contradicted the map" if is_named else "fitted no landmark, or several"
        return (
            f"of {DOUBT_SPAN} readings in a row {share:.0%} {fitted} (at most {MOST_REJECTED[is_named]:.0%}"
            " may); landmarks probably are at wrong places, or on the map twice"
        )
    if not is_named and missed > MOST_MISSED:
        return (
            f"of the landmarks within range {missed:.0%} were not seen (at most {MOST_MISSED:.0%} may be);"
            " some probably are at wrong places, or on the map twice"
        )
    twins = 0.0 if is_named else find_twin_share(landmarks, range_sigma)
    if twins > MOST_TWINS:
        return (
            f"{twins:.0%} of the landmarks are nearer to another than {TWIN_DEVIATIONS:g} deviations of the"
            " range; they probably are on the map twice"
        )
    return ""
