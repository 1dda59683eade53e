"""A score from 0 to 255 for every cell of a grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, positive_number, whole_number
from cspace.errors import InputError
from cspace.maps.points import as_point
from cspace.tables import one_line, tabulate


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class ByteField:
    """A score for every cell of a grid, for instance how likely a laser beam ends there.

    scores (rows, columns) uint8; row i spans y in origin_y + resolution · [i, i + 1], column j spans x
    likewise. resolution [m]: the side of a cell. origin (2,) [m]: the corner of cell (0, 0) of least x and y.
    outside: the score of every place outside the grid. Raises InputError for other scores.
    """

    scores: npt.NDArray[np.uint8]
    resolution: float
    origin: Array
    outside: int = 0

    def __post_init__(self) -> None:
        scores = np.ascontiguousarray(self.scores)
        if scores.ndim != 2 or not scores.size or scores.dtype != np.uint8:
            raise InputError(
                f"scores is {scores.dtype} of shape {scores.shape}; give bytes (rows, columns), at least one,"
                " dtype uint8"
            )
        object.__setattr__(self, "scores", scores)
        object.__setattr__(self, "resolution", positive_number(self.resolution, "resolution"))
        object.__setattr__(self, "origin", np.array(as_point(self.origin, "origin")))
        object.__setattr__(self, "outside", whole_number(self.outside, "outside", 0, 255))

    def __repr__(self) -> str:
        rows, columns = self.scores.shape
        return one_line("ByteField", f"{rows} × {columns} cells of {self.resolution:g} m")
