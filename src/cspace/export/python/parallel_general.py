"""Arms with three parallel axes and no other help: two equations give two angles, a planar arm the others.

The parallel axes keep one direction n and one height: n . (a position) and n . (a direction) do not change.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array, inverse
from cspace.export.python.trig_steps import Care, align, turns_where_zero, two_link

FIRST_PARALLEL = 4
ROUNDING = 1e-13  # of rows of size one
NEARLY = 1e-5  # matrices nearer than this to singular ones have nearly double roots


def link(form: dict[str, Any], i: int, t: complex) -> Array:
    """Rz(t) Tz(d) Tx(a) Rx(alpha) of joint i."""
    c, s, ca, sa, a = t.real, t.imag, form["ca"][i], form["sa"][i], form["a"][i]
    return np.array(
        [
            [c, -s * ca, s * sa, a * c],
            [s, c * ca, -c * sa, a * s],
            [0.0, sa, ca, form["d"][i]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def about_z(t: complex) -> Array:
    """The turn by t about z."""
    return np.array([[t.real, -t.imag, 0, 0], [t.imag, t.real, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1.0]])


def turn_of(R: Array) -> complex:
    """The turn about z that R makes."""
    t = complex(R[0, 0], R[1, 0])
    return t / abs(t) if abs(t) > 0 else 1 + 0j


def pairs(alpha: Array, B: Array, C: Array) -> list[tuple[complex, complex]]:
    """Turns u, w with alpha + B u + C w = 0 as vectors of the plane.

    B or C has an inverse, or B u and C w run on lines: crossed with one line, only the other turn is left.
    """
    sizes = np.maximum(np.abs(np.column_stack([alpha, B, C])).max(axis=1), 1e-300)
    alpha, B, C = alpha / sizes, B / sizes[:, None], C / sizes[:, None]
    found = []
    if max(regular(B), regular(C)) > ROUNDING:
        if regular(B) > regular(C):
            found = [(u, w) for w, u in pairs_from(alpha, C, B)]
        else:
            found = pairs_from(alpha, B, C)
    if max(regular(B), regular(C)) < NEARLY:
        found += pairs_on_lines(alpha, B, C)
    return found


def regular(M: Array) -> float:
    """About the smaller singular value of M (2, 2)."""
    size = float(np.linalg.norm(M))
    return abs(float(np.linalg.det(M))) / size if size > 0 else 0.0


def pairs_on_lines(alpha: Array, B: Array, C: Array) -> list[tuple[complex, complex]]:
    """B u along a line b, C w along a line c; where these are parallel too, one equation is left."""
    b, c = (M[:, int(np.argmax(np.linalg.norm(M, axis=0)))] for M in (B, C))
    if abs(cross(b, c)) <= ROUNDING * np.linalg.norm(b) * np.linalg.norm(c):
        i = int(np.argmax(np.linalg.norm(C, axis=1)))
        return [(1 + 0j, w) for w in turns_of(C[i, 0], C[i, 1], -alpha[i] - B[i, 0])]
    us = turns_of(cross(c, B[:, 0]), cross(c, B[:, 1]), -cross(c, alpha))
    ws = turns_of(cross(b, C[:, 0]), cross(b, C[:, 1]), -cross(b, alpha))
    return [(u, w) for u in us for w in ws]


def cross(a: Array, b: Array) -> float:
    """The cross product of vectors of the plane."""
    return float(a[0] * b[1] - a[1] * b[0])


def turns_of(a: float, b: float, r: float) -> list[complex]:
    """The turns t with a cos t + b sin t = r, rounding beyond the ends cut off."""
    m = complex(a, b)
    if abs(r) > (1 + 1e-6) * abs(m) or abs(m) == 0:
        return []
    h = np.sqrt(max(abs(m) ** 2 - r * r, 0.0))
    turns = [m * complex(r, h) / abs(m) ** 2, m * complex(r, -h) / abs(m) ** 2]
    return [complex(t / abs(t)) for t in turns]


def pairs_from(alpha: Array, B: Array, C: Array) -> list[tuple[complex, complex]]:
    """w = -inv(C) (alpha + B u) has length one: a quartic for u."""
    d, A = -np.linalg.solve(C, alpha), -np.linalg.solve(C, B)
    rows = [(1.0, float(d[i]), float(A[i, 0]), float(A[i, 1])) for i in range(2)]
    found = []
    for u in turns_where_zero(*rows, (-1.0, 1.0, 0.0, 0.0)):
        w = complex(*(d + A @ [u.real, u.imag]))
        if abs(w) > 0:
            found.append((u, w / abs(w)))
    return found


def planar_three(
    form: dict[str, Any], j: int, planar: Array, care: Care
) -> list[tuple[complex, complex, complex]]:
    """The parallel joints j, j + 1, j + 2 that make a displacement of their plane: both elbows."""
    at = complex(planar[0, 3], planar[1, 3])
    sides, ok = two_link(at, form["a"][j], form["a"][j + 1], form["length"], care, care.unconstrained[j])
    return [(t, elbow, turn_of(planar) * (t * elbow).conjugate()) for t, elbow in sides if ok]


def branches(plan: dict[str, Any], goal: Array, care: Care) -> list[list[complex]]:
    """Up to 4 x 2 branches."""
    three = first_parallel if plan["family"] == FIRST_PARALLEL else middle_parallel
    return three(plan["form"], goal, care)


def middle_parallel(form: dict[str, Any], goal: Array, care: Care) -> list[list[complex]]:
    """Axes 2, 3, 4 parallel: the height of axis 6 and its slope against n fix t1 and t5."""
    p, g, ca, sa = goal[:3, 3], goal[:3, 2], form["ca"], form["sa"]
    length, height = form["length"], sum(form["d"][1:4]) + ca[3] * form["d"][4]
    alpha = np.array([(ca[0] * p[2] - height) / length, ca[0] * g[2] - ca[3] * ca[4]])
    B = sa[0] * np.array([[-p[1] / length, p[0] / length], [-g[1], g[0]]])
    C = np.array([[0.0, -sa[3] * form["a"][4] / length], [sa[3] * sa[4], 0.0]])
    found = []
    for t1, t5 in pairs(alpha, B, C):
        seen = inverse(link(form, 0, t1)) @ goal
        four = link(form, 3, 1 + 0j)
        four[:3, 3] = form["a"][3], 0.0, 0.0
        rest = four @ link(form, 4, t5)
        z, want = complex(*rest[:2, 2]), complex(*seen[:2, 2])
        t234 = align(z, want, 1.0, care, care.unconstrained[3])
        t6 = turn_of((about_z(t234) @ rest)[:3, :3].T @ seen[:3, :3])
        planar = about_z(t234)
        planar[:3, 3] = seen[:3, 3] - planar[:3, :3] @ rest[:3, 3]
        found += [[t1, *three, t5, t6] for three in planar_three(form, 1, planar, care)]
    return found


def first_parallel(form: dict[str, Any], goal: Array, care: Care) -> list[list[complex]]:
    """Axes 1, 2, 3 parallel: the slope of n against axis 5 and the height of the goal fix t4 and t6."""
    r, ca, sa, a, d, length = goal[2, :3], form["ca"], form["sa"], form["a"], form["d"], form["length"]
    fixed = d[1] + d[2] + ca[2] * d[3] + d[4] * ca[4] * r[2] - goal[2, 3]
    alpha = np.array([r[2] * ca[4] - ca[2] * ca[3], fixed / length])
    B = np.array([[sa[2] * sa[3], 0.0], [0.0, sa[2] * a[3] / length]])
    lever = np.array([a[4] * r[0] + d[4] * sa[4] * r[1], -a[4] * r[1] + d[4] * sa[4] * r[0]]) / length
    C = np.array([[r[1] * sa[4], r[0] * sa[4]], lever])
    found = []
    for t4, t6 in pairs(alpha, B, C):
        three = link(form, 2, 1 + 0j)
        three[:3, 3] = a[2], 0.0, 0.0
        to_four = three @ link(form, 3, t4)
        n = to_four[2, :3]
        seen = complex(r[0], r[1]) * t6
        t5 = align(complex(seen.real, ca[4] * seen.imag - sa[4] * r[2]), complex(n[0], n[1]), 1.0, care,
                   care.unconstrained[4])  # fmt: skip
        rest = to_four @ link(form, 4, t5) @ about_z(t6)
        planar = goal @ inverse(rest)
        found += [[*first, t4, t5, t6] for first in planar_three(form, 0, planar, care)]
    return found
