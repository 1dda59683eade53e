"""Fits the polynomials of include/cspace/math/trig.hpp and prints them as C++ (needs mpmath, takes minutes).

Each approximates g(z) on [0, b], z = x², so that the error that reaches the function stays smallest: Remez's
exchange with the weight w(z), in 80 digits. The coefficients are rounded to double one by one from the lowest
on, and those above are fitted anew each time, so that they make up for the rounding.
"""

from __future__ import annotations

import sys
from collections.abc import Callable

import mpmath as mp

Function = Callable[[mp.mpf], mp.mpf]
GRID = 600
mp.mp.dps = 80
root = mp.sqrt

# name: (g, w, b, number of coefficients)
FITS: dict[str, tuple[Function, Function, mp.mpf, int]] = {
    "sine": (
        lambda z: (mp.sin(root(z)) - root(z)) / root(z) ** 3,
        lambda z: root(z) ** 3 / mp.sin(root(z)),
        (mp.pi / 4 * mp.mpf("1.0002")) ** 2,
        6,
    ),
    "cosine": (
        lambda z: (mp.cos(root(z)) - 1 + z / 2) / z**2,
        lambda z: z**2,
        (mp.pi / 4 * mp.mpf("1.0002")) ** 2,
        6,
    ),
    "arctangent": (
        lambda z: (mp.atan(root(z)) - root(z)) / root(z) ** 3,
        lambda z: root(z) ** 3 / mp.atan(root(z)),
        mp.mpf(1),
        21,
    ),
    "arcsine": (
        lambda z: (mp.asin(root(z)) - root(z)) / root(z) ** 3,
        lambda z: root(z) ** 3 / mp.asin(root(z)),
        mp.mpf(1) / 4,
        13,
    ),
}


def horner(coefficients: list[mp.mpf], z: mp.mpf) -> mp.mpf:
    return mp.polyval(coefficients[::-1], z)


def extrema(errors: list[mp.mpf]) -> list[int]:
    """The largest error of each run of equal sign."""
    found, start = [], 0
    for i in range(1, len(errors) + 1):
        if i == len(errors) or mp.sign(errors[i]) != mp.sign(errors[start]):
            found.append(max(range(start, i), key=lambda k: abs(errors[k])))
            start = i
    return found


def remez(g: Function, w: Function, b: mp.mpf, n: int) -> list[mp.mpf]:
    """The n coefficients with the smallest max |w(z) (g(z) − Σ c_k z^k)| on [0, b] (Remez 1934)."""
    grid = [b * (1 - mp.cos(mp.pi * i / GRID)) / 2 for i in range(1, GRID + 1)]
    values = [(g(z), w(z)) for z in grid]
    points = [b / 2 - b / 2 * mp.cos(mp.pi * (i + mp.mpf(1) / 2) / (n + 1)) for i in range(n + 1)]
    for _ in range(12):
        system, right = mp.matrix(n + 1, n + 1), mp.matrix(n + 1, 1)
        for i, z in enumerate(points):
            for k in range(n):
                system[i, k] = z**k
            system[i, n] = (-1) ** i / w(z)
            right[i] = g(z)
        solution = mp.lu_solve(system, right)
        coefficients = [solution[k] for k in range(n)]
        errors = [
            weight * (value - horner(coefficients, z))
            for z, (value, weight) in zip(grid, values, strict=True)
        ]
        peaks = extrema(errors)
        if len(peaks) <= n:
            break
        while len(peaks) > n + 1:
            peaks.pop(0 if abs(errors[peaks[0]]) < abs(errors[peaks[-1]]) else -1)
        points = [grid[k] for k in peaks]
        sizes = [abs(errors[k]) for k in peaks]
        if max(sizes) < mp.mpf("1.02") * min(sizes):
            break
    return coefficients


def fit(g: Function, w: Function, b: mp.mpf, n: int) -> tuple[list[float], mp.mpf]:
    """The coefficients as doubles and the largest weighted error that is left."""
    fixed: list[float] = []
    for k in range(n):

        def rest(z: mp.mpf, head: tuple[float, ...] = tuple(fixed)) -> mp.mpf:
            return (g(z) - horner([mp.mpf(c) for c in head] or [mp.mpf(0)], z)) / z ** len(head)

        fixed.append(float(remez(rest, lambda z, k=k: w(z) * z**k, b, n - k)[0]))
    exact = [mp.mpf(c) for c in fixed]
    samples = [b * (i + mp.mpf(1) / 7) / 3001 for i in range(3001)]
    return fixed, max(abs(w(z) * (g(z) - horner(exact, z))) for z in samples)


def main() -> None:
    for name in sys.argv[1:] or FITS:
        coefficients, error = fit(*FITS[name])
        print(f"// error 2^{mp.nstr(mp.log(error, 2), 4)}")
        print(f"inline constexpr double {name}[] = {{{', '.join(c.hex() for c in coefficients)}}};")


if __name__ == "__main__":
    main()
