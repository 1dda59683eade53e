"""Relations of the axes of an arm, measured: parallel, perpendicular or meeting, and their invariants."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.ik.conditions import angle_between, common_point
from cspace.model import Chain
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True)
class Relation:
    """Two neighbouring axes. joints: their numbers from 1. angle: between the lines [rad], 0 to π/2.

    distance: between the lines [m], NaN where one belongs to a prismatic joint, which has no place.
    parallel, meet, square: within what the solver allows.
    """

    joints: tuple[int, int]
    angle: float
    distance: float
    parallel: bool
    meet: bool
    square: bool

    @property
    def words(self) -> str:
        """The relation as text."""
        if self.parallel:
            return "on one line" if self.meet else "parallel"
        found = [word for word, holds in (("meet", self.meet), ("perpendicular", self.square)) if holds]
        return ", ".join(found) or "skew"


@show_fields
@dataclass(frozen=True, eq=False)
class InvariantPoint:
    """A point that some joints do not move: their axes meet in it. place: (3,) in the base at zero [m].

    joints: their numbers from 1. miss: how far the axes pass it at most [m].
    """

    place: Array
    joints: tuple[int, ...]
    miss: float


@show_fields
@dataclass(frozen=True, eq=False)
class InvariantDirection:
    """A direction that some joints do not change: their axes are parallel to it. direction: (3,) at zero.

    joints: their numbers from 1. miss: the largest angle between an axis and it [rad].
    """

    direction: Array
    joints: tuple[int, ...]
    miss: float


def measure_relations(chain: Chain, length: float) -> tuple[Relation, ...]:
    """What each pair of neighbouring axes shares; length: the arm's [m], the scale of what is allowed."""
    out = []
    for i in range(len(chain.joint_types) - 1):
        (h, k), (p, r) = chain.axes[i : i + 2], chain.points[i : i + 2]
        angle = angle_between(h, k)
        parallel = bool(np.sin(angle) < _core.AXIS_RELATION)
        across = np.cross(h, r - p) if parallel else [np.cross(h, k) @ (r - p) / np.sin(angle)]
        slides = "P" in chain.joint_types[i : i + 2]
        distance = float("nan") if slides else float(np.linalg.norm(across))
        meet = distance < _core.AXIS_RELATION * length
        square = abs(np.pi / 2 - angle) < _core.AXIS_RELATION
        out.append(Relation((i + 1, i + 2), angle, distance, parallel, meet, square))
    return tuple(out)


def invariant_points(chain: Chain, length: float) -> tuple[InvariantPoint, ...]:
    """Where adjacent axes meet: three in a point, or two that belong to no such three."""
    pairs = [each.joints for each in measure_relations(chain, length) if each.meet and not each.parallel]
    threes = [
        (a, b, c)
        for (a, b), (_, c) in itertools.pairwise(pairs)
        if c == b + 1
        and common_point(chain.axes[a - 1 : c], chain.points[a - 1 : c])[1] < _core.AXIS_RELATION * length
    ]
    in_threes = {pair for a, b, c in threes for pair in ((a, b), (b, c))}
    groups = sorted([*threes, *(pair for pair in pairs if pair not in in_threes)])
    out = []
    for joints in groups:
        some = slice(joints[0] - 1, joints[-1])
        place, miss = common_point(chain.axes[some], chain.points[some])
        out.append(InvariantPoint(place, joints, miss))
    return tuple(out)


def invariant_directions(chain: Chain, length: float) -> tuple[InvariantDirection, ...]:
    """Runs of neighbouring parallel axes of revolute joints."""
    runs: list[list[int]] = []
    for each in measure_relations(chain, length):
        a, b = each.joints
        if not each.parallel or "P" in chain.joint_types[a - 1 : b]:
            continue
        if runs and runs[-1][-1] == a:
            runs[-1].append(b)
        else:
            runs.append([a, b])
    out = []
    for run in runs:
        n = chain.axes[run[0] - 1]
        miss = max(angle_between(n, chain.axes[joint - 1]) for joint in run)
        out.append(InvariantDirection(np.asarray(n), tuple(run), miss))
    return tuple(out)
