"""Arms with a spherical wrist: three joints place its centre, three turn about it (Pieper 1968)."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array
from cspace.export.python.trig_steps import (
    Care,
    align,
    linear_equation,
    turns_where_zero,
    two_link,
    undo_joint,
    wrist,
)

Triple = tuple[complex, complex, complex]


def behind_joint_two(g: dict[str, Any], t3: complex) -> Array:
    """The wrist's centre as joint 2 sees it."""
    w = t3 * complex(g["w"][0], g["w"][1])
    return np.array(
        [
            w.real + g["a2"],
            g["ca2"] * w.imag - g["sa2"] * g["w"][2],
            g["sa2"] * w.imag + g["ca2"] * g["w"][2] + g["d2"],
        ]
    )


def axes_2_3_parallel(g: dict[str, Any], p: Array, care: Care) -> list[Triple]:
    """The height of p over the plane of axes 2 and 3 fixes t1, a planar arm t2 and t3."""
    k = (g["w"][2] + g["d2"] - g["ca1"] * p[2]) / g["sa1"]
    shoulders, ok = linear_equation(-p[1], p[0], k, g["length"], care, care.unconstrained[0])
    found: list[Triple] = []
    for t1 in shoulders if ok else []:
        seen = t1.conjugate() * complex(p[0], p[1])
        target = complex(seen.real - g["a1"], g["ca1"] * seen.imag + g["sa1"] * p[2])
        sides, reached = two_link(target, g["a2"], g["wrist_reach"], g["length"], care, care.unconstrained[1])
        found += [(t1, t2, t3 * g["w_angle"].conjugate()) for t2, t3 in sides if reached]
    return found


def axes_1_2_meet(g: dict[str, Any], p: Array, care: Care) -> list[Triple]:
    """The distance of p from where axes 1 and 2 meet fixes t3, its height t2, its bearing t1."""
    w = g["w"]
    a = g["a2"] * w[0] + g["d2"] * g["sa2"] * w[1]
    b = g["d2"] * g["sa2"] * w[0] - g["a2"] * w[1]
    fixed = (g["a2"] ** 2 + g["d2"] ** 2 + w @ w) / 2 + g["d2"] * g["ca2"] * w[2]
    elbows, ok = linear_equation(a, b, p @ p / 2 - fixed, float(np.hypot(a, b)), care, care.unconstrained[2])
    found: list[Triple] = []
    for t3 in elbows if ok else []:
        v = behind_joint_two(g, t3)
        height = p[2] - g["ca1"] * v[2]
        lifts, reached = linear_equation(
            g["sa1"] * v[1], g["sa1"] * v[0], height, g["length"], care, care.unconstrained[1]
        )
        for t2 in lifts if reached else []:
            turned = t2 * complex(v[0], v[1])
            seen = complex(turned.real, g["ca1"] * turned.imag - g["sa1"] * v[2])
            t1 = align(seen, complex(p[0], p[1]), g["length"], care, care.unconstrained[0])
            found.append((t1, t2, t3))
    return found


def axes_2_3_meet(g: dict[str, Any], p: Array, care: Care) -> list[Triple]:
    """The distance of p from where axes 2 and 3 meet fixes t1, a height along axis 2 t3, a bearing t2."""
    out, height = -g["sa1"] * g["d2"], g["ca1"] * g["d2"]
    r = (p @ p + g["a1"] ** 2 + g["d2"] ** 2 - g["w"] @ g["w"]) / 2 - height * p[2]
    pans, ok = linear_equation(
        g["a1"] * p[0] + out * p[1],
        g["a1"] * p[1] - out * p[0],
        r,
        g["length"] * float(np.hypot(g["a1"], out)),
        care,
        care.unconstrained[0],
    )
    found: list[Triple] = []
    for t1 in pans if ok else []:
        seen = t1.conjugate() * complex(p[0], p[1])
        x1, y1 = seen.real - g["a1"], seen.imag
        y, z = g["ca1"] * y1 + g["sa1"] * p[2], g["ca1"] * p[2] - g["sa1"] * y1 - g["d2"]
        elbows, reached = linear_equation(
            g["sa2"] * g["w"][1],
            g["sa2"] * g["w"][0],
            z - g["ca2"] * g["w"][2],
            g["sa2"] * g["wrist_reach"],
            care,
            care.unconstrained[2],
        )
        for t3 in elbows if reached else []:
            v = behind_joint_two(g, t3)
            t2 = align(complex(v[0], v[1]), complex(x1, y), g["length"], care, care.unconstrained[1])
            found.append((t1, t2, t3))
    return found


def axes_1_2_parallel(g: dict[str, Any], p: Array, care: Care) -> list[Triple]:
    """The height of p fixes t3, its distance from axis 1 t2, its bearing t1."""
    elbows, ok = linear_equation(
        g["sa2"] * g["w"][1],
        g["sa2"] * g["w"][0],
        p[2] - g["d2"] - g["ca2"] * g["w"][2],
        g["sa2"] * g["wrist_reach"],
        care,
        care.unconstrained[2],
    )
    found: list[Triple] = []
    for t3 in elbows if ok else []:
        v = behind_joint_two(g, t3)
        r = (p[0] ** 2 + p[1] ** 2 - v[0] ** 2 - v[1] ** 2 - g["a1"] ** 2) / (2 * g["a1"])
        lifts, reached = linear_equation(v[0], -v[1], r, g["length"], care, care.unconstrained[1])
        for t2 in lifts if reached else []:
            seen = t2 * complex(v[0], v[1]) + g["a1"]
            found.append((align(seen, complex(p[0], p[1]), g["length"], care, care.unconstrained[0]), t2, t3))
    return found


def any_three(g: dict[str, Any], p: Array, care: Care) -> list[Triple]:
    """The distance of p from joint 1 and its height along axis 1 give a quartic for t3."""
    w, a1, a2, d2, ca2, sa2 = g["w"], g["a1"], g["a2"], g["d2"], g["ca2"], g["sa2"]
    fixed = a2**2 + d2**2 + w @ w + 2 * d2 * ca2 * w[2]
    X = (
        (p @ p - a1**2 - fixed) / (2 * a1),
        -(a2 * w[0] + d2 * sa2 * w[1]) / a1,
        -(d2 * sa2 * w[0] - a2 * w[1]) / a1,
    )
    cot = g["ca1"] / g["sa1"]
    Y = (p[2] / g["sa1"] - cot * (ca2 * w[2] + d2), -cot * sa2 * w[1], -cot * sa2 * w[0])
    vx, vy = (a2, w[0], -w[1]), (-sa2 * w[2], ca2 * w[1], ca2 * w[0])
    found: list[Triple] = []
    for t3 in turns_where_zero((1, *X), (1, *Y), (-1, *vx), (-1, *vy)):
        x, y = (f[0] + f[1] * t3.real + f[2] * t3.imag for f in (X, Y))
        v = behind_joint_two(g, t3)
        t2 = align(complex(v[0], v[1]), complex(x, y), g["length"], care, care.unconstrained[1])
        seen = complex(x + a1, g["ca1"] * y - g["sa1"] * v[2])
        found.append((align(seen, complex(p[0], p[1]), g["length"], care, care.unconstrained[0]), t2, t3))
    return found


PLACES = (axes_2_3_parallel, axes_1_2_meet, axes_2_3_meet, axes_1_2_parallel, any_three)


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
