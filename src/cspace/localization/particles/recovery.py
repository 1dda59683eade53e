"""When a particle filter is lost: scores of the best particle against those it had while localised."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.localization.particles.models import Judgement

FIRST_SCORES: Final = 20
"""Scores after which their median replaces the threshold of the sensor."""
KEPT_SCORES: Final = 200
"""Scores of which the median is taken: the log's first minutes, and later its last ones."""
SHARE_OF_MEDIAN: Final = 0.8
"""A score below this part of the median is suspicious, even where the sensor's threshold lies higher."""
FEWEST_SCORES: Final = 5
"""Scores after which their median tells what is usual."""
USUAL_SHARE: Final = 0.9
"""A score below this part of the median is looked into: there may be a better pose nearby."""
LOST_UPDATES: Final = 3
"""Suspicious scores in a row after which the filter says that it is lost."""
LOST_SHARE: Final = 0.8
"""Part of the threshold below which scores count for that."""
LONGEST_WAIT: Final = 2
"""Most updates between two searches of the map that find nothing better."""
GAINS: Final = (0.3, 0.1)
"""By how much the score of another place must exceed that of the best particle, over the number of suspicious
scores in a row, and the least: being carried away is rare, so a first bad scan is not enough for a place that
fits a bit better."""
LEAST_SCORE: Final = 0.4
"""The least score of a place at the start."""
MISSING_GAIN: Final = 0.5
"""By how much more for each beam that is missing, as a share of a full scan: few beams fit anywhere."""
UNKNOWN_GAIN: Final = 0.25
"""The same for each beam that the map cannot judge: few of the others fit elsewhere by chance."""
MOST_UNKNOWN: Final = 0.6
"""Share of such beams from which a scan says nothing."""
SHARE_OF_RAYS: Final = 0.65
"""Part of the threshold below which the whole of a measurement is suspicious: many of its beams go through
walls."""
LOST_WHOLE: Final = 0.5
"""Part of the threshold below which the whole counts for being lost: most of its beams go through walls."""
DOUBTED_WHOLE: Final = 0.85
"""Part of the threshold below which the rays of the next measurement are looked along, too."""
PLACE_SHARE: Final = 0.9
"""The least score of another place later, over the threshold: places of maps that look alike fit by half."""


def add_doubt(judged: Judgement) -> float:
    """By how much more a pose must exceed the present one where a measurement says little."""
    return MISSING_GAIN * judged.missing + UNKNOWN_GAIN * judged.unknown


class ScoreMonitor:
    """Remembers scores, and decides when to search the map."""

    def __init__(self, threshold: float) -> None:
        self.first = threshold
        self.scores: list[float] = []
        self.bad, self.low = 0, 0
        self._threshold, self._median = threshold, 0.0
        self._wait, self._pause = 0, 1
        self.is_crossing = False  # whether some beams of the last measurement went through walls

    @property
    def threshold(self) -> float:
        """The score below which another place is looked for."""
        return self._threshold

    def see(self, judged: Judgement) -> None:
        """Counts a judgement before the decision to search."""
        self.low = self.low + 1 if self._is_low(judged) else 0

    def _is_low(self, judged: Judgement) -> bool:
        return judged.score < self._threshold or judged.whole < SHARE_OF_RAYS * self._threshold

    def is_unusual(self, score: float) -> bool:
        """Whether a score is low enough to look for a better pose nearby."""
        usual = USUAL_SHARE * self._median if len(self.scores) >= FEWEST_SCORES else 0.0
        return score < max(usual, self._threshold)

    @property
    def least_of_places(self) -> float:
        """What another place must score."""
        return PLACE_SHARE * self._threshold

    def bound_places(self, judged: Judgement) -> tuple[float, float]:
        """What another place must score, and what it must exceed on the whole, given the judgement here."""
        gain = max(GAINS[0] / max(self.low, 1), GAINS[1]) + add_doubt(judged)
        return self.least_of_places, max(LEAST_SCORE, judged.whole + gain)

    def add(self, judged: Judgement, is_localised: bool) -> None:
        """Takes note of the judgement of an update."""
        score = judged.score
        is_bad = score < LOST_SHARE * self._threshold or judged.whole < LOST_WHOLE * self._threshold
        self.bad = self.bad + 1 if is_bad else 0
        self.is_crossing = judged.whole < DOUBTED_WHOLE * self._threshold
        self._wait = max(self._wait - 1, 0)
        if is_localised and score >= self._threshold:
            self._pause = 1
        if is_localised:
            self.scores = [*self.scores, score][-KEPT_SCORES:]
            self._median = float(np.median(self.scores))
            if len(self.scores) >= FIRST_SCORES:
                self._threshold = min(self.first, SHARE_OF_MEDIAN * self._median)

    def wants_search(self, judged: Judgement) -> bool:
        """Whether to search now."""
        return self._is_low(judged) and self._wait == 0

    def note_search(self, found: int) -> None:
        """After a search; one that found nothing lets the next wait twice as long."""
        self._pause = 1 if found else min(2 * self._pause, LONGEST_WAIT)
        self._wait = self._pause

    @property
    def is_lost(self) -> bool:
        """Whether the scores were suspicious for some updates."""
        return self.bad >= LOST_UPDATES
