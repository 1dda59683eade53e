"""Whether a map of landmarks contradicts the readings that made it."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.localization.landmark_slam.outcomes import ReadingOutcomes
from cspace.localization.log import Landmarks

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


def explain_doubt(share: float, is_named: bool, landmarks: Landmarks, range_sigma: float) -> str:
    """Why the map is doubtful; nothing if it is not. share: of rejected readings, as found above."""
    if share > MOST_REJECTED[is_named]:
        fitted = "contradicted the map" if is_named else "fitted no landmark, or several"
        return (
            f"of {DOUBT_SPAN} readings in a row {share:.0%} {fitted} (at most {MOST_REJECTED[is_named]:.0%}"
            " may); landmarks probably are at wrong places, or on the map twice"
        )
    twins = 0.0 if is_named else find_twin_share(landmarks, range_sigma)
    if twins > MOST_TWINS:
        return (
            f"{twins:.0%} of the landmarks are nearer to another than {TWIN_DEVIATIONS:g} deviations of the"
            " range; they probably are on the map twice"
        )
    return ""
