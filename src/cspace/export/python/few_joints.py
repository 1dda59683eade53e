"""Arms of up to three joints, turning or sliding, exactly.

Seen from the far end, the joints before the last bring points of its axis to their places. Joint 2 leaves a
point's height along its axis and its distance from a place on it alone (where it slides, its two coordinates
across), which are equations for joint 1; joints 2 and 3 follow.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array, Solutions, accept_candidate, inverse, joint_motion, make_answer

FLAT = 1e-9  # coefficients below this, over lengths of the arm, fix nothing


def across(h: Array) -> Array:
    """A unit vector square to h."""
    v = np.cross(h, np.eye(3)[int(np.argmin(np.abs(h)))])
    return np.asarray(v / np.linalg.norm(v))


def apply(T: Array, p: Array) -> Array:
    """The point p moved by T."""
    return np.asarray(T[:3, :3] @ p + T[:3, 3])


def backwards(arm: dict[str, Any]) -> dict[str, Any]:
    """The same arm read from its tip: its pose at the joints in reverse order is the inverse."""
    back = inverse(arm["T_zero"])
    points = [apply(back, p) for p in arm["points"][::-1]]
    axes = -(arm["axes"][::-1] @ back[:3, :3].T)
    return {**arm, "axes": axes, "points": np.array(points), "slides": arm["slides"][::-1], "T_zero": back}


def angle_between(h: Array, a: Array, b: Array) -> float:
    """The angle about h from a to b."""
    return float(np.arctan2(h @ np.cross(a, b), a @ b - (h @ a) * (h @ b)))


def joint_between(
    arm: dict[str, Any], i: int, pairs: list[tuple[Array, Array]], unconstrained: float
) -> float:
    """The value at which joint i brings the first of each pair to the second, or `unconstrained`."""
    h, o = arm["axes"][i], arm["points"][i]
    if arm["slides"][i]:
        return float(h @ (pairs[0][1] - pairs[0][0]))
    a, b = max(pairs, key=lambda pair: float(np.linalg.norm(np.cross(h, pair[0] - o))))
    return angle_between(h, a - o, b - o) if np.linalg.norm(np.cross(h, a - o)) > FLAT else unconstrained


def first_joint(arm: dict[str, Any], x: Array, y: Array) -> list[float]:
    """Values of joint 1 that give y, moved back by it, the invariants of x under joint 2."""
    h, o = arm["axes"][1], arm["points"][1]
    normals = [across(h), np.cross(h, across(h))] if arm["slides"][1] else [h]

    def left_alone(p: Array) -> Array:
        values = [n @ (p - o) for n in normals]
        return np.array(values if arm["slides"][1] else [*values, (p - o) @ (p - o)])

    # Of a turn by t they are k + c cos t + s sin t, of a slide by t polynomials of degree two.
    samples = (0.0, np.pi / 2, np.pi) if not arm["slides"][0] else (-1.0, 0.0, 1.0)
    f = [left_alone(apply(joint_motion(arm, 0, -t), y)) - left_alone(x) for t in samples]
    found: list[float] = []
    for one, two, three in zip(*f, strict=True):
        if arm["slides"][0]:
            poly = np.array([(one + three) / 2 - two, (three - one) / 2, two])
            if np.abs(poly[:2]).max() > FLAT:
                found += [float(z.real) for z in np.roots(poly) if abs(z.imag) < 1e-4]
            continue
        k, c = (one + three) / 2, (one - three) / 2
        s = two - k
        size = float(np.hypot(c, s))
        if size > FLAT and abs(k) < (1 + 1e-6) * size:
            away = np.arccos(np.clip(-k / size, -1, 1))
            found += [float(np.arctan2(s, c) + way * away) for way in (1, -1)]
    return found


def with_one_turn(arm: dict[str, Any], T: Array, unconstrained: Array) -> list[Array]:
    """At most one joint turns: the orientation fixes it, linear equations the slides."""
    q, G = unconstrained.copy(), T @ inverse(arm["T_zero"])
    for i in np.flatnonzero(~arm["slides"]).tolist():
        a = across(arm["axes"][i])
        q[i] = angle_between(arm["axes"][i], a, G[:3, :3] @ a)
    slides = np.flatnonzero(arm["slides"])
    if len(slides):
        directions, at = [], np.eye(4)
        for i, value in enumerate(q):
            directions.append(at[:3, :3] @ arm["axes"][i])
            at = at @ joint_motion(arm, i, value)
        D = np.array(directions)[slides].T
        q[slides] += np.linalg.lstsq(D, T[:3, 3] - (at @ arm["T_zero"])[:3, 3], rcond=None)[0]
    return [q]


def with_more_turns(arm: dict[str, Any], T: Array, unconstrained: Array) -> list[Array]:
    """The last joint turns, and one before it."""
    n, G = len(unconstrained), T @ inverse(arm["T_zero"])
    h, p = arm["axes"][-1], arm["points"][-1]
    pairs = [(x, apply(G, x)) for x in (p, p + arm["length"] * h)]
    if n == 3:
        firsts = [t for x, y in pairs for t in first_joint(arm, x, y)] or [float(unconstrained[0])]
    else:
        firsts = [joint_between(arm, 0, pairs, float(unconstrained[0]))]
    found = []
    for t in firsts:
        q, rest = unconstrained.copy(), inverse(joint_motion(arm, 0, t)) @ G
        q[0] = t
        if n == 3:
            moved = [(x, apply(inverse(joint_motion(arm, 0, t)), y)) for x, y in pairs]
            q[1] = joint_between(arm, 1, moved, float(unconstrained[1]))
            rest = inverse(joint_motion(arm, 1, q[1])) @ rest
        q[-1] = angle_between(h, across(h), rest[:3, :3] @ across(h))
        found.append(q)
    return found


def solve_few_joints(arm: dict[str, Any], T: Array, unconstrained: Array) -> Solutions:
    """Every configuration; joints that nothing constrains take their values in `unconstrained`."""
    found: list[Array] = []
    if np.count_nonzero(~arm["slides"]) < 2:
        candidates = with_one_turn(arm, T, unconstrained)
    elif arm["slides"][-1]:
        back = backwards(arm)
        candidates = [q[::-1].copy() for q in with_more_turns(back, inverse(T), unconstrained[::-1].copy())]
    else:
        candidates = with_more_turns(arm, T, unconstrained)
    for q in candidates:
        accept_candidate(arm, T, found, q)
    return make_answer(arm, T, found)
