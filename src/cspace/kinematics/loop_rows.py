"""What a loop of each type forbids, as rows of numbers.

With the frame A of the loop in its parent and B in its child, both with z along the axis if there is one, the
relative place is d = R_Aᵀ (p_B − p_A) and the relative rotation D = R_Aᵀ R_B. A row of a loop is the sum P ·
d + Σ C ∘ D, or that of a rod (d · d − l²) / (2 l). Sines stand for angles, so rows are lengths [m] and angles
[rad] where a loop is nearly closed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.model import Loop
from cspace.spatial.vectors import frame_along

Numbers = NDArray[np.intp]
Flags = NDArray[np.bool_]
Row = tuple[str, Array, Array]
"""The name of a row after that of its loop, P (3,) and C (3, 3)."""


def _moves(letters: str) -> list[Row]:
    """Rows of the components of d."""
    return [(c, np.eye(3)["xyz".index(c)], np.zeros((3, 3))) for c in letters]


def _turn(name: str, *entries: tuple[int, int, float]) -> Row:
    """A row of entries of D, each with its factor."""
    C = np.zeros((3, 3))
    for i, j, factor in entries:
        C[i, j] = factor
    return name, np.zeros(3), C


TILTS: Final = [_turn("rx", (1, 2, -1.0)), _turn("ry", (0, 2, 1.0))]
"""The rotations that turn the axis of the child away from that of the parent."""

TURNS: Final = [
    _turn("rx", (2, 1, 0.5), (1, 2, -0.5)),
    _turn("ry", (0, 2, 0.5), (2, 0, -0.5)),
    _turn("rz", (1, 0, 0.5), (0, 1, -0.5)),
]
"""All rotations: the vector of sin θ along the axis of rotation."""

ROD: Final[Row] = ("length", np.zeros(3), np.zeros((3, 3)))

ROWS: Final[dict[str, list[Row]]] = {
    "spherical": _moves("xyz"),
    "revolute": _moves("xyz") + TILTS,
    "continuous": _moves("xyz") + TILTS,
    "prismatic": _moves("xy") + TURNS,
    "universal": [*_moves("xyz"), _turn("angle", (2, 2, 1.0))],
    "cylindrical": _moves("xy") + TILTS,
    "planar": _moves("z") + TILTS,
    "fixed": _moves("xyz") + TURNS,
    "distance": [ROD],
    "floating": [],
}
"""The rows of each type. Those of a universal joint contain the angle between its two axes."""

UPRIGHT: Final[dict[str, Array]] = {
    **dict.fromkeys(("revolute", "continuous", "cylindrical", "planar"), np.diag([0.0, 0.0, 1.0])),
    **dict.fromkeys(("prismatic", "fixed"), np.eye(3) / 3.0),
}
"""U of each type whose sines are also zero upside down: Σ U ∘ D is 1 where it is closed, below zero at a loop
that is turned over."""

WITHOUT_AXIS: Final = ("spherical", "fixed", "distance", "floating")


@dataclass(frozen=True, eq=False)
class LoopRows:
    """The rows of all loops, one after the other.

    names: "loop.row". loop (r,): of which loop a row is. P (r, 3), C (r, 3, 3): see above. rods: the numbers
    of those rows that are rods. lengths (rods,) [m]. angular (r,): whether a row is an angle. upright (loops,
    3, 3): U, and signed (loops,): whether there is one.
    """

    names: tuple[str, ...]
    loop: Numbers
    P: Array
    C: Array
    rods: Numbers
    lengths: Array
    angular: Flags
    upright: Array
    signed: Flags


def make_rows(loops: tuple[Loop, ...]) -> LoopRows:
    """The rows of loops. Raises InputError for a helical one and a universal one without a second axis."""
    for loop in loops:
        if loop.type not in ROWS:
            known = ", ".join(sorted(ROWS))
            raise InputError(f"loop {loop.name!r} is {loop.type}; it has no pitch, so choose one of {known}")
        if loop.type == "universal" and loop.second_axis is None:
            raise InputError(
                f"loop {loop.name!r} is universal; give second_axis=, the axis that is fixed to its child"
                f" {loop.child!r}"
            )
    rows = [(i, row) for i, loop in enumerate(loops) for row in ROWS[loop.type]]
    numbers = np.array([i for i, _ in rows], dtype=np.intp)
    C = np.array([C for _, (_, _, C) in rows]).reshape(-1, 3, 3)
    rods = np.flatnonzero([loops[i].type == "distance" for i in numbers])
    return LoopRows(
        tuple(f"{loops[i].name}.{name}" for i, (name, _, _) in rows),
        numbers,
        np.array([P for _, (_, P, _) in rows]).reshape(-1, 3),
        C,
        rods,
        np.array([loops[i].length for i in numbers[rods]], dtype=np.float64),
        np.abs(C).any(axis=(1, 2)),
        np.array([UPRIGHT.get(loop.type, np.zeros((3, 3))) for loop in loops]).reshape(-1, 3, 3),
        np.array([loop.type in UPRIGHT for loop in loops], dtype=bool),
    )


def find_frames(loop: Loop) -> tuple[Array, Array]:
    """The frames A in the parent and B in the child (4, 4), with z along the axis if the type has one."""
    if loop.type in WITHOUT_AXIS:
        return loop.origin, loop.child_origin
    second = loop.axis if loop.second_axis is None else loop.second_axis
    frames = []
    for place, axis in ((loop.origin, loop.axis), (loop.child_origin, second)):
        turn = np.eye(4)
        turn[:3, :3] = frame_along(axis)
        frames.append(place @ turn)
    return frames[0], frames[1]
