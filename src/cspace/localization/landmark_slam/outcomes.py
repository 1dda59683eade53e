"""What became of readings: which landmark each was paired with, and how well it fitted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.localization.log import Ids, Mask
from cspace.tables import count_things, one_line, tabulate

VERDICTS: Final = ("used", "rejected", "created", "skipped")
"""Names of verdicts by their number in the core."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class ReadingOutcomes:
    """What a filter did with readings, a row each.

    landmark (k,): the name of the landmark that the reading was paired with or made, −1 without any. verdict
    (k,): "used", "rejected" (beyond its gate, or ambiguous), "created" (it made a landmark), "skipped" (a
    landmark cannot be made of it). nis (k,): νᵀ S⁻¹ ν with dof (k,) degrees of freedom; NaN and 0 where
    nothing was predicted. innovations (k, 2): range [m] and bearing [rad] less their prediction, or the one
    that was measured and NaN.
    """

    landmark: Ids
    verdict: npt.NDArray[np.str_]
    dof: Ids
    nis: Array
    innovations: Array

    def __len__(self) -> int:
        """How many readings there are."""
        return len(self.landmark)

    def __repr__(self) -> str:
        counts = [(verdict, int((self.verdict == verdict).sum())) for verdict in VERDICTS]
        text = ", ".join(f"{count} {verdict}" for verdict, count in counts if count)
        return one_line("ReadingOutcomes", f"{count_things(len(self), 'reading')}: {text}".rstrip(": "))

    @property
    def used(self) -> Mask:
        """Which readings updated the filter, (k,)."""
        return np.asarray(self.verdict == "used")


def read_outcomes(columns: tuple[Any, ...]) -> ReadingOutcomes:
    """Outcomes from the columns of the core: names, verdicts, degrees of freedom, NIS, innovations."""
    names, verdicts, dof, nis, innovations = columns
    return ReadingOutcomes(names, np.array(VERDICTS)[verdicts], dof, nis, innovations)


def join_outcomes(parts: list[tuple[Any, ...]]) -> ReadingOutcomes:
    """Outcomes of many updates in a row."""
    if not parts:
        none = np.empty(0, np.int64)
        return read_outcomes((none, none, none, np.empty(0), np.empty((0, 2))))
    return read_outcomes(tuple(np.concatenate(columns) for columns in zip(*parts, strict=True)))
