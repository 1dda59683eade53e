"""Arms whose axes 2, 3 and 4 are parallel and whose axes 5 and 6 meet, such as those of Universal Robots."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array
from cspace.export.python.trig_steps import Care, linear_equation, two_link, undo_joint, wrist


def behind_shoulders(
    arm: dict[str, Any], goal: Array, care: Care
) -> list[tuple[complex, Array, Array, complex]]:
    """Per shoulder: t1, the third and first column of the orientation behind it, the place in the plane."""
    p, ca1, sa1, found = goal[:3, 3], arm["ca1"], arm["sa1"], []
    k = (arm["height"] - ca1 * p[2]) / sa1
    shoulders, ok = linear_equation(-p[1], p[0], k, arm["length"], care, care.unconstrained[0])
    for i, t1 in enumerate(shoulders if ok else []):
        if care.shoulder not in (None, i) or (care.shoulder == 1 and abs(shoulders[0] - t1) < 1e-4):
            continue
        z, x = (undo_joint(t1, ca1, sa1, goal[:3, column]) for column in (2, 0))
        turned = t1.conjugate() * complex(p[0], p[1])
        found.append((t1, z, x, complex(turned.real - arm["a1"], ca1 * turned.imag + sa1 * p[2])))
    return found


def branches(plan: dict[str, Any], goal: Array, care: Care) -> list[list[complex]]:
    """The shoulder from a height, the wrist from the orientation, both elbows of a planar arm: 2 x 2 x 2."""
    arm, found = plan["parallel"], []
    for t1, z, x, target in behind_shoulders(arm, goal, care):
        both, there = wrist(arm["last"], z, x, care, care.unconstrained[3])
        for t234, t5, t6 in both if there else []:
            at = target - t234 * complex(arm["x4"], arm["y4"])
            sides, reached = two_link(at, arm["l2"], arm["l3"], arm["length"], care, care.unconstrained[1])
            for t2, t3 in sides if reached else []:
                found.append([t1, t2, t3, t234 * (t2 * t3).conjugate(), t5, t6])
    return found


def free_turns(plan: dict[str, Any], goal: Array, care: Care) -> list[complex]:
    """Where the pose leaves t2 + t3 + t4 free: the sums at which the planar arm begins or ends to reach, and
    a little inside of them, where the elbow bends; those nearest to the idle one first.
    """
    arm, found = plan["parallel"], []
    for _, z, _, at in behind_shoulders(arm, goal, care):
        if z[0] ** 2 + z[1] ** 2 > care.free**2:
            continue
        circle = complex(arm["x4"], arm["y4"])
        m = 2 * at * circle.conjugate()
        for reach in (arm["l2"] + arm["l3"], arm["l2"] - arm["l3"]):
            r = abs(at) ** 2 + abs(circle) ** 2 - reach**2
            ends, ok = linear_equation(m.real, m.imag, r, arm["length"] ** 2, care, 1 + 0j)
            inside = min(0.02, 0.1 * abs(np.angle(ends[0] / ends[1]))) if ok else 0.0
            for end in ends if ok else []:
                found += [(0, end * np.exp(way * inside)) for way in (1j, -1j)] + [(1, end)]
    found.sort(key=lambda one: (one[0], abs(np.angle(one[1] / care.unconstrained[3]))))
    return [complex(turn) for _, turn in found]
