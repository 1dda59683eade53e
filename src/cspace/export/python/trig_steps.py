"""The steps that closed forms share. A turn by t is the complex number exp(i t); turns add up by products."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cspace.export.python.base import Array


@dataclass
class Care:
    """How near merging solutions are taken in, how far held apart, below which size a lever fixes no joint,
    the turns that joints take when nothing fixes them, and the one shoulder to look behind, if not both.
    """

    band: float = 1e-10
    spread: float = 0.0
    free: float = 1e-12
    unconstrained: list[complex] = field(default_factory=lambda: [1 + 0j] * 6)
    shoulder: int | None = None


def linear_equation(
    a: float, b: float, r: float, unit: float, care: Care, unconstrained: complex
) -> tuple[list[complex], bool]:
    """Both turns t with a cos t + b sin t = r, and whether there are any."""
    m = complex(a, b)
    n2 = abs(m) ** 2
    room = n2 - r * r
    is_free = n2 <= (care.free * unit) ** 2
    ok = room >= -care.band * (n2 + unit * unit) or (is_free and abs(r) <= 1e-9 * unit)
    if is_free:
        return [unconstrained, unconstrained], ok
    h = np.sqrt(max(room, care.spread * n2))
    return [m * complex(r, h) / n2, m * complex(r, -h) / n2], ok


def align(a: complex, b: complex, unit: float, care: Care, unconstrained: complex) -> complex:
    """The turn that takes a to b, both of one length."""
    n2 = abs(b) ** 2
    return unconstrained if n2 <= (care.free * unit) ** 2 else b * a.conjugate() / n2


def two_link(
    p: complex, l1: float, l2: float, unit: float, care: Care, unconstrained: complex
) -> tuple[list[tuple[complex, complex]], bool]:
    """First joint and elbow of a planar arm that reaches p, for both sides of the elbow."""
    r2, product, size2 = abs(p) ** 2, 2 * l1 * l2, (l1 + l2) ** 2
    room_out, room_in = (size2 - r2) / product, (r2 - (l1 - l2) ** 2) / product
    elbow = complex((room_in - room_out) / 2, np.sqrt(max(room_out * room_in, care.spread)))
    ok = min(room_out, room_in) >= -care.band * (size2 + unit * unit) / product
    is_free = r2 <= care.free**2 * size2
    sides = []
    for turn in (elbow, elbow.conjugate()):
        sides.append((unconstrained if is_free else p * (l1 + l2 * turn).conjugate() / r2, turn))
    return sides, ok


def undo_joint(turn: complex, ca: float, sa: float, v: Array) -> Array:
    """v as seen behind Rz(t) Rx(alpha)."""
    back = turn.conjugate() * complex(v[0], v[1])
    return np.array([back.real, ca * back.imag + sa * v[2], ca * v[2] - sa * back.imag])


def cosine_gap(ca: float, sa2: float, cb: float, sb: float) -> float:
    """cos a - cos b, from the sines where both are small and the cosines would cancel."""
    return (sb * sb - sa2) / (ca + cb) if abs(ca + cb) > 0.5 else ca - cb


def wrist(
    w: dict[str, float], z: Array, x: Array, care: Care, unconstrained: complex
) -> tuple[list[tuple[complex, complex, complex]], bool]:
    """Both solutions (t4, t5, t6) of Rz(t4) Rx(a4) Rz(t5) Rx(a5) Rz(t6) with third column z and first x."""
    rho2 = z[0] ** 2 + z[1] ** 2
    low = cosine_gap(z[2], rho2, w["c_sum"], w["s_sum"]) * w["inv"]
    high = -cosine_gap(z[2], rho2, w["c_diff"], w["s_diff"]) * w["inv"]
    ok = min(low, high) >= -care.band * (1 + abs(w["inv"]))
    c5, s5 = (high - low) / 2, np.sqrt(max(low * high, care.spread))
    both = []
    for s in (s5, -s5):
        first = complex(w["sa5"] * s, -w["ca4"] * w["sa5"] * c5 - w["sa4"] * w["ca5"])
        t4 = unconstrained if rho2 <= care.free**2 else complex(z[0], z[1]) * first.conjugate() / rho2
        y = t4.conjugate() * complex(x[0], x[1])
        along, across = w["ca4"] * y.imag + w["sa4"] * x[2], w["ca4"] * x[2] - w["sa4"] * y.imag
        t6 = complex(c5 * y.real + s * along, w["ca5"] * (c5 * along - s * y.real) + w["sa5"] * across)
        both.append((t4, complex(c5, s), t6))
    return both, bool(ok)


def turns_where_zero(*squares: tuple[float, float, float, float]) -> list[complex]:
    """The turns at which a sum of weight (k + c cos t + s sin t)^2 vanishes, given as (weight, k, c, s)."""
    total = np.zeros(5, dtype=complex)
    for weight, k, c, s in squares:
        factor = np.array([complex(c, -s) / 2, k, complex(c, s) / 2])  # times exp(i t), in powers of it
        total += weight * np.convolve(factor, factor)
    if not np.abs(total).max() > 0:
        return []
    roots = np.roots(total)
    return [complex(z / abs(z)) for z in roots if abs(abs(z) - 1) < 1e-3]
