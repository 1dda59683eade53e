"""Arms with a spherical wrist: three joints place its centre, three turn about it."""

from __future__ import annotations

from typing import Any

from cspace.export.python.base import Array
from cspace.export.python.pieper_position import PLACES
from cspace.export.python.trig_steps import Care, undo_joint, wrist


def branches(plan: dict[str, Any], goal: Array, care: Care) -> list[list[complex]]:
    """Up to 4 x 2 branches."""
    arm = plan["wrist"]
    g, found = arm["first"], []
    for t1, t2, t3 in PLACES[g["kind"]](g, goal[:3, 3], care):
        seen = []
        for v in (goal[:3, 2], goal[:3, 0]):
            v = undo_joint(t1, g["ca1"], g["sa1"], v)
            v = undo_joint(t2, g["ca2"], g["sa2"], v)
            seen.append(undo_joint(t3, arm["ca3"], arm["sa3"], v))
        both, ok = wrist(arm["last"], seen[0], seen[1], care, care.unconstrained[3])
        found += [[t1, t2, t3, *last] for last in both if ok]
    return found
