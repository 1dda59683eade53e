"""Trace: the events of a search in order, sufficient to draw the search again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.tables import one_line


@dataclass(frozen=True, eq=False)
class Trace:
    """The events of a search in chronological order.

    words: the kinds of events of the planner ("expand", "hit", "follow", …). kind: (k,) index of each event
    into words. start, end: (k, 2) [m] the segment of the event, or the same point twice. value: (k,) the
    number that the planner records with the event (a cost, a clearance, an arc length; its page states
    which).
    """

    words: tuple[str, ...]
    kind: npt.NDArray[np.int8]
    start: Array
    end: Array
    value: Array

    def __repr__(self) -> str:
        return one_line("Trace", f"of {len(self)} events: {', '.join(self.words)}")

    def __len__(self) -> int:
        """The number of events."""
        return len(self.kind)

    def __iter__(self) -> Iterator[tuple[str, Array, Array, float]]:
        """(word, start (2,), end (2,), value) of each event."""
        for kind, start, end, value in zip(self.kind, self.start, self.end, self.value, strict=True):
            yield self.words[kind], start, end, float(value)

    def only(self, word: str) -> Trace:
        """The events of one kind: a Trace with the same arrays (k, 2), fewer rows."""
        kept = self.kind == (self.words.index(word) if word in self.words else -1)
        return Trace(self.words, self.kind[kept], self.start[kept], self.end[kept], self.value[kept])
