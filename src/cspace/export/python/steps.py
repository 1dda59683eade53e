"""Equations are solved step by step, for one angle or two at a time.

They are trigonometric polynomials, which their values at some angles determine.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cspace.export.python.base import Array

AROUND = 2 * np.pi * np.arange(5) / 5  # angles whose values fix a trigonometric polynomial of degree two
WAVES = np.exp(-1j * np.outer(range(3), AROUND)) / 5  # from those values to its Fourier coefficients
FLAT = 1e-9  # coefficients below this, over the largest one, are rounding
BENT = 0.01  # squared sine of an angle beside the one that is nearest to a goal out of reach
NEARLY = 1e-5  # matrices nearer than this to singular ones have nearly double roots


class Known:
    """What is known so far, as attributes: p_x ... r_33 of the goal, angles such as t1, their cosines and
    sines such as c1 and s1, what the steps define. free: the names of the angles that nothing fixes.
    """

    free: tuple[str, ...] = ()

    def __init__(self, **numbers: Any) -> None:
        vars(self).update(numbers)

    def with_angles(self, names: tuple[str, ...], angles: tuple[float, ...]) -> Known:
        """A copy that knows some more angles."""
        out = Known(**vars(self))
        for name, angle in zip(names, angles, strict=True):
            vars(out).update({name: angle, f"c{name[1:]}": cos(angle), f"s{name[1:]}": sin(angle)})
        return out


Step = tuple[Callable[[Known], list[float]], tuple[str, ...]]  # the equations, left - right, and their angles


@dataclass
class Settings:
    """How near merging solutions are taken in, how far held apart, below which size a lever fixes no joint,
    and the angles that nothing fixes.
    """

    band: float = 1e-10
    spread: float = 0.0
    free: float = 1e-12
    unconstrained: dict[str, float] = field(default_factory=dict)


def cos(angle: float) -> float:
    return float(np.cos(angle))


def sin(angle: float) -> float:
    return float(np.sin(angle))


def follow_steps(steps: list[Step], goal: Known, settings: Settings) -> list[Known]:
    """Every way through the steps."""
    ways = [goal]
    for equations, names in steps:
        ways = [way for known in ways for way in ways_of_step(equations, names, known, settings)]
    return ways


def ways_of_step(
    equations: Callable[[Known], list[float]], names: tuple[str, ...], known: Known, settings: Settings
) -> list[Known]:
    """What is known behind a step, for each of its solutions."""

    def values(*angles: float) -> list[float]:
        return equations(known.with_angles(names, angles))

    free = known.free
    found: list[tuple[float, ...]]
    if len(names) == 2:
        found = [*two_angles(values)]
    elif (only := one_angle(np.array([values(t) for t in AROUND]), settings, clip=bool(free))) is None:
        found, free = [(settings.unconstrained[names[0]],)], (*free, *names)
    else:
        found = [(angle,) for angle in only]
    ways = [known.with_angles(names, angles) for angles in found]
    for way in ways:
        way.free = free
        equations(way)  # leaves what the step defines in it
    return ways


def one_angle(values: Array, settings: Settings, clip: bool) -> list[float] | None:
    """The angles at which equations hold, None where they do not depend on it. values (5, m): at AROUND.

    clip: whether an equation out of reach is nearly met nevertheless, since an angle before it is free.
    """
    waves = WAVES @ values
    if np.abs(waves[2]).max() > FLAT * np.abs(waves).max():
        return zeros_around(values[:, 0])
    levers, wanted = 2 * np.column_stack([waves[1].real, -waves[1].imag]), -waves[0].real
    U, size, V = np.linalg.svd(levers, full_matrices=False)
    if size[0] <= settings.free:
        return None if clip or np.abs(wanted).max() < np.sqrt(settings.band) else []
    along = (U.T @ wanted) / np.maximum(size, 1e-300)
    if len(size) > 1 and size[1] > NEARLY * size[0]:
        c, s = along @ V
        return [float(np.arctan2(s, c))]
    room = 1 - along[0] ** 2
    if room < -settings.band * (1 + 1 / size[0] ** 2):
        if not clip:
            return []
        room = BENT
    away = np.arctan2(np.sqrt(max(room, settings.spread)), along[0])
    return [float(np.arctan2(V[0, 1], V[0, 0]) + way * away) for way in ((1, -1) if away % np.pi else (1,))]


def zeros_around(values: Array) -> list[float]:
    """The zeros of a trigonometric polynomial of degree two from its values (5,) at AROUND."""
    half = WAVES @ values
    roots = np.roots([*half[::-1], *half[1:].conjugate()])
    return [float(np.angle(z)) for z in roots if abs(abs(z) - 1) < 1e-3]


def two_angles(values: Callable[[float, float], list[float]]) -> list[tuple[float, float]]:
    """The angles u, w at which two equations hold, linear in cosine and sine of each.

    They are constant + B u + C w = 0 with unit vectors u, w in the plane. So w = -inv(C) (constant + B u) has
    length one, which is a trigonometric polynomial in u.
    """
    quarter = np.pi / 2
    here, B1, C1, B2, C2 = (
        np.array(values(*at)) for at in ((0, 0), (np.pi, 0), (0, np.pi), (quarter, 0), (0, quarter))
    )
    B, C = np.column_stack([here - B1, 0 * B2]) / 2, np.column_stack([here - C1, 0 * C2]) / 2
    constant = here - B[:, 0] - C[:, 0]
    B[:, 1], C[:, 1] = B2 - constant - C[:, 0], C2 - constant - B[:, 0]
    rows = np.maximum(np.abs(np.column_stack([constant, B, C])).max(axis=1, keepdims=True), 1e-300)
    constant, B, C = constant / rows[:, 0], B / rows, C / rows
    if np.linalg.svd(B, compute_uv=False)[1] > np.linalg.svd(C, compute_uv=False)[1]:
        return [(u, w) for w, u in pairs_from(constant, C, B)]
    return pairs_from(constant, B, C)


def pairs_from(constant: Array, B: Array, C: Array) -> list[tuple[float, float]]:
    """The angles u, w, from the singular values of C: its smaller one may be zero."""
    U, (large, small), V = np.linalg.svd(C)

    def opposite(u: Any) -> Array:
        return np.asarray(-(U.T @ (constant + (B @ [np.cos(u), np.sin(u)]).T).T))

    g, h = opposite(AROUND)
    found = []
    for u in zeros_around((small * g) ** 2 + (large * h) ** 2 - (large * small) ** 2):
        first, second = opposite(u)
        x = np.clip(first / large, -1, 1)
        y = np.sqrt(1 - x * x)
        for side in [second / small] if small > NEARLY * large else [y, -y]:
            c, s = x * V[0] + side * V[1]
            found.append((u, float(np.arctan2(s, c))))
    return found
