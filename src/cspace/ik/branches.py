"""Names for the branches of a closed form, read off the configurations themselves.

shoulder: seen from axis 1 towards the wrist, the arm's plane passes on the right or left of axis 1; an arm
whose plane contains axis 1 faces its goal (front) or has turned away and reaches over its back (back), its
face being the side on which the tip is at zero or, for an arm upright at zero, to which joint 2 tilts it.

elbow: joint 3 lies above or below the line from shoulder to wrist, up being the direction of axis 1. Where
the axes are parallel the arm moves in a plane: its elbow is up if joint 2 lies on the left of the line from
axis 1 to the wrist, drawn with the base's x (else its y) to the right and its z (else its y) up; for a goal
ahead that is above the line. The wrist of such an arm is its third axis, or the tip if it has none.

wrist: the sign of the middle wrist joint; flip where the second of the two wrist solutions is used.

slide: the tip (or a third axis parallel to the first) lies forward or back of the turning axis, along the
slide. link: the tip lies ahead of or behind the last axis, along the slide.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.ik.joint_axes import Placed, are_parallel, are_square, meeting_point, place_axes
from cspace.ik.solver import Solver
from cspace.model import Chain
from cspace.tolerances import BRANCH_LENGTH, BRANCH_OFFSET

SPHERICAL_WRIST, THREE_PARALLEL = 1, 2
LAST_PARALLEL = 0

Words = Callable[[Placed, int], str]
"""The name of one configuration, from where the arm is and the number of its branch."""


def branch_labels(solver: Solver, q: Array, numbers: tuple[int, ...]) -> tuple[str, ...]:
    """One label per configuration of q (k, dof), from the branches `numbers` of the closed form."""
    seen = _core._ik_geometry(solver)
    if seen is None or any(n < 0 for n in numbers):
        return ("",) * len(numbers)
    words = None if seen["general"] else words_of(solver.chain, seen)
    if words is None:
        return tuple(f"branch {n + 1}" for n in numbers)
    chain = solver.chain
    return tuple(words(place_axes(chain, row), n) for row, n in zip(q, numbers, strict=True))


def words_of(chain: Chain, seen: dict[str, Any]) -> Words | None:
    """How the branches of an arm are named; None where its geometry has no names."""
    if seen["family"] < 0:
        return words_of_few(chain)
    if seen["virtual_joints"]:
        return words_of_completed(chain)
    if seen["reversed"]:
        return None
    if seen["family"] == THREE_PARALLEL:
        # The wrist is where axes 5 and 6 meet; the forearm ends at axis 4.
        return six_joints(5, wrist_bit=1, forearm_end=3)
    if seen["family"] == SPHERICAL_WRIST and seen["pieper_case"] == LAST_PARALLEL:
        return six_joints(3, wrist_bit=0, forearm_end=None)
    return None


def six_joints(other: int, wrist_bit: int, forearm_end: int | None) -> Words:
    def words(at: Placed, number: int) -> str:
        wrist = meeting_point(at, 4, other)
        end = wrist if forearm_end is None else at.points[forearm_end]
        flip = "flip" if (number >> wrist_bit) & 1 else "no flip"
        return f"{name_shoulder(at, wrist)}, {name_elbow(at, end)}, wrist {flip}"

    return words


def words_of_completed(chain: Chain) -> Words | None:
    """Arms of four and five revolute joints: axis 1 perpendicular to parallel axes 2 and 3."""
    h, p = chain.axes, chain.points
    if not (are_square(h[0], h[1]) and are_parallel(h[1], h[2])):
        return None
    if are_parallel(h[1], h[3]):
        return lambda at, _: f"{name_shoulder(at, at.points[3])}, {name_elbow(at, at.points[3])}"
    if len(h) == 5 and not are_parallel(h[3], h[4]):
        gap = np.cross(h[3], h[4]) @ (p[4] - p[3])
        if abs(gap) <= BRANCH_OFFSET:
            return shoulder_and_elbow_at_meeting
    return None


def shoulder_and_elbow_at_meeting(at: Placed, _: int) -> str:
    wrist = meeting_point(at, 3, 4)
    return f"{name_shoulder(at, wrist)}, {name_elbow(at, wrist)}"


def words_of_few(chain: Chain) -> Words | None:
    """Arms of up to three joints, revolute or prismatic."""
    kinds, h = chain.joint_types, chain.axes
    turns = [i for i, kind in enumerate(kinds) if kind == "R"]
    slides = [i for i, kind in enumerate(kinds) if kind == "P"]
    if not turns or len(kinds) == 1:
        return lambda *_: "the only one"
    along = [i for i in slides if are_parallel(h[i], h[turns[0]])]
    across = [i for i in slides if are_square(h[i], h[turns[0]])]
    level = all(are_parallel(h[turns[0]], h[i]) for i in turns)
    if len(turns) > 1 and level and along == slides:
        return in_a_plane(turns)
    if len(turns) == 1 and len(across) == 1 and len(across) + len(along) == len(slides):
        return lambda at, _: name_slide(at, turns[0], across[0], at.tip)
    if kinds == "RPR" and across and level:
        return lambda at, _: name_slide(at, 0, 1, at.points[2])
    if kinds == "RPR" and across and are_square(h[2], h[0]) and are_square(h[2], h[1]):
        return lambda at, _: (
            f"{name_slide(at, 0, 1, at.tip)}, link {side_of(at, 2, 1, at.tip, ('ahead', 'behind'))}"
        )
    if kinds == "RRR" and are_square(h[0], h[1]) and are_parallel(h[1], h[2]):
        return lambda at, _: f"{name_shoulder(at, at.tip)}, {name_elbow(at, at.tip)}"
    if kinds == "RRP" and are_square(h[0], h[1]) and are_square(h[1], h[2]):
        return lambda at, _: f"{name_shoulder(at, at.tip)}, {name_slide(at, 1, 2, at.tip)}"
    return None


def in_a_plane(turns: list[int]) -> Words:
    """The elbow of an arm whose turning axes are parallel: axis 1, joint 2, and axis 3 or the tip."""
    first, second = turns[:2]

    def words(at: Placed, _: int) -> str:
        end = at.points[turns[2]] if len(turns) > 2 else at.tip
        n = towards_viewer(at.axes[first])
        line, upper = (part_across(v - at.points[first], n) for v in (end, at.points[second]))
        if np.linalg.norm(line) <= BRANCH_OFFSET * np.linalg.norm(upper):
            return "elbow folded"
        return elbow_side(line, upper, np.cross(n, line))

    return words


def towards_viewer(h: Array) -> Array:
    """h or −h, towards a viewer who sees the base's x (else y) to the right and its z (else y) up."""
    X, Y, Z = np.eye(3)
    right = Y if are_parallel(h, X) else X
    up = Y if are_parallel(h, Z) else Z
    return h if np.cross(right, up) @ h > 0 else -h


def name_shoulder(at: Placed, wrist: Array) -> str:
    h1, h2 = at.axes[:2]
    to_wrist = wrist - at.points[0]
    forward, beside = part_across(to_wrist, h1), to_wrist @ h2
    side = np.cross(h1, forward) @ (beside * h2)
    if abs(beside) <= _core.AXIS_RELATION * np.linalg.norm(to_wrist):
        return "shoulder front" if at.face @ forward > 0 else "shoulder back"
    return "shoulder left" if side > 0 else "shoulder right"


def name_elbow(at: Placed, end: Array) -> str:
    """The elbow of an arm whose axes 2 and 3 are parallel and whose forearm ends at `end`."""
    h2 = at.axes[1]
    line, upper = (part_across(v - at.points[1], h2) for v in (end, at.points[2]))
    return elbow_side(line, upper, at.axes[0])


def elbow_side(line: Array, upper: Array, up: Array) -> str:
    """Whether the upper arm ends above the line from shoulder to wrist or below."""
    length2 = line @ line
    offset = upper - (upper @ line) / length2 * line if length2 > BRANCH_LENGTH**2 else upper
    if np.linalg.norm(offset) <= BRANCH_OFFSET * np.linalg.norm(upper):
        return "elbow straight"
    return "elbow up" if offset @ up > 0 else "elbow down"


def name_slide(at: Placed, turn: int, sliding: int, end: Array) -> str:
    return f"slide {side_of(at, turn, sliding, end, ('forward', 'back'))}"


def side_of(at: Placed, turn: int, sliding: int, end: Array, words: tuple[str, str]) -> str:
    """On which side of a turning axis `end` lies, along a prismatic joint; "level" at the fold between."""
    from_axis = part_across(end - at.points[turn], at.axes[turn])
    ahead = from_axis @ at.axes[sliding]
    if abs(ahead) <= BRANCH_OFFSET * np.linalg.norm(from_axis):
        return "level"
    return words[0] if ahead > 0 else words[1]


def part_across(v: Array, h: Array) -> Array:
    """The part of v perpendicular to the unit vector h."""
    return np.asarray(v - (v @ h) * h)
