"""The elementary functions of the core: error in ulp, special values, on every compiled copy."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cspace import _core

Array = np.ndarray
COPIES = ["baseline", "avx2", "avx512"]
FUNCTIONS = {"sincos": 2, "atan2": 1, "acos": 1, "asin": 1}  # and the number of results
BOUND = {
    "sincos": 0.85,
    "atan2": 1.5,
    "acos": 1.15,
    "asin": 1.15,
}  # ulp, as include/cspace/math/trig.hpp states

RUN_ELSEWHERE = """
import sys, numpy as np
from cspace import _core
assert _core.isa == sys.argv[2], _core.isa
data = np.load(sys.argv[1])
inputs = [data[key] for key in sorted(data)]
outputs = [np.empty_like(inputs[0]) for _ in range(int(sys.argv[4]))]
getattr(_core, sys.argv[3])(*inputs, *outputs)
np.save(sys.argv[1], np.array(outputs))
"""


@pytest.fixture(params=COPIES)
def call(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[..., Array]:
    """Calls a function of one compiled copy: in this process, or in another started with CSPACE_ISA."""
    copy = request.param
    if copy not in COPIES[: COPIES.index(_core.isa) + 1]:
        pytest.skip(f"this process runs {_core.isa}, which {copy} is above")

    def elsewhere(name: str, *inputs: Array) -> Array:
        file = tmp_path / "data.npz"
        np.savez(file, **{f"input_{k}": x for k, x in enumerate(inputs)})
        command = [sys.executable, "-c", RUN_ELSEWHERE, str(file), copy, name, str(FUNCTIONS[name])]
        subprocess.run(command, check=True, env={**os.environ, "CSPACE_ISA": copy})
        return np.asarray(np.load(f"{file}.npy"))

    def here(name: str, *inputs: Array) -> Array:
        outputs = np.empty((FUNCTIONS[name], inputs[0].size))
        getattr(_core, name)(*inputs, *outputs)
        return outputs

    return here if copy == _core.isa else elsewhere


needs_oracle = pytest.mark.skipif(
    np.finfo(np.longdouble).nmant < 63, reason="the oracle needs a long double of 64 bits or more"
)


def ulps(got: Array, want: Array) -> float:
    """The largest |got − want| in units in the last place of want; got must be NaN where want is."""
    np.testing.assert_array_equal(np.isnan(got), np.isnan(want))
    _, exponent = np.frexp(np.where(np.isfinite(want), want, 1))
    ulp = np.ldexp(np.longdouble(1), np.maximum(exponent, -1021) - 53)
    return float(np.max(np.abs(got - want) / ulp, initial=0, where=np.isfinite(want)))


def any_double(rng: np.random.Generator, n: int) -> Array:
    """Every exponent and sign, infinities and NaN included."""
    return rng.integers(0, 2**64, n, dtype=np.uint64).view(np.float64)


def spread(rng: np.random.Generator, n: int, lowest: int, highest: int) -> Array:
    """Random fractions with binary exponents drawn from lowest to highest, of both signs."""
    return np.ldexp(rng.uniform(-1, 1, n), rng.integers(lowest, highest + 1, n))


def angles(rng: np.random.Generator) -> Array:
    multiples = np.arange(-70_000, 70_001) * (np.pi / 2)
    return np.concatenate(
        [
            np.linspace(-10, 10, 200_001),
            rng.uniform(-1e5, 1e5, 300_000),
            spread(rng, 100_000, -60, 20),
            multiples,
            np.nextafter(multiples, np.inf),
            np.nextafter(multiples / 2, -np.inf),
            any_double(rng, 20_000),
        ]
    )


def cosines(rng: np.random.Generator) -> Array:
    near_one = 1 - np.abs(spread(rng, 200_000, -53, 0))
    return np.concatenate(
        [
            np.linspace(-1, 1, 200_001),
            rng.uniform(-1, 1, 300_000),
            rng.uniform(0.45, 0.62, 300_000),
            near_one,
            -near_one,
            spread(rng, 100_000, -70, 0),
            any_double(rng, 20_000),
        ]
    )


def vectors(rng: np.random.Generator) -> tuple[Array, Array]:
    n = 200_000
    x = np.concatenate([rng.uniform(-1, 1, 2 * n), any_double(rng, n), spread(rng, n, -1030, -1000)])
    above_a_power = np.ldexp(1 + rng.uniform(0, 0.1, n), rng.integers(-6, 7, n))
    slope = np.concatenate([rng.uniform(0.5, 0.55, n), above_a_power])
    y = np.concatenate([x[: 2 * n] * slope, any_double(rng, n), spread(rng, n, -1030, -1000)])
    return y, x


@needs_oracle
@np.errstate(invalid="ignore", over="ignore", under="ignore")
def test_sincos_within_the_stated_error(call: Callable[..., Array]) -> None:
    x = angles(np.random.default_rng(1))
    sine, cosine = call("sincos", x)
    assert ulps(sine, np.sin(x.astype(np.longdouble))) <= BOUND["sincos"]
    assert ulps(cosine, np.cos(x.astype(np.longdouble))) <= BOUND["sincos"]


@needs_oracle
@np.errstate(invalid="ignore", over="ignore", under="ignore")
def test_atan2_within_the_stated_error(call: Callable[..., Array]) -> None:
    y, x = vectors(np.random.default_rng(2))
    for a, b in [(y, x), (x, y)]:
        (angle,) = call("atan2", a, b)
        assert ulps(angle, np.arctan2(a.astype(np.longdouble), b.astype(np.longdouble))) <= BOUND["atan2"]


@pytest.mark.slow
@needs_oracle
@np.errstate(invalid="ignore")
@pytest.mark.parametrize("name", ["acos", "asin"])
def test_inverses_within_the_stated_error(call: Callable[..., Array], name: str) -> None:
    x = cosines(np.random.default_rng(3))
    (angle,) = call(name, x)
    oracle = {"acos": np.arccos, "asin": np.arcsin}[name]
    assert ulps(angle, oracle(x.astype(np.longdouble))) <= BOUND[name]


# x, then sin x and cos x as a double and what is missing, from 400-digit arithmetic (mpmath). Of all doubles
# the first lies nearest to a multiple of π/2 (Muller, Elementary Functions, 2016, section 11.3.2), of those
# below 1e5 the second.
HARD = """
0x1.6ac5b262ca1ffp+849 0x1.0000000000000p+0    -1.1e-37   -0x1.14ae72e6ba22fp-61  4.37e-36
0x1.6c6cbc45dc8dep+5   0x1.0000000000000p+0    -1.92e-37  -0x1.6d61b58c99c43p-61  5.56e-36
0x1.921fb54442d18p+0   0x1.0000000000000p+0    -1.87e-33  0x1.1a62633145c07p-54   -1.5e-33
0x1.2d97c7f3321d2p+2   -0x1.0000000000000p+0   1.69e-32   -0x1.a79394c9e8a0ap-53  -7.83e-33
0x1.86a0092755206p+16  0x1.571e7dee4e1fap-39   1.72e-28   -0x1.0000000000000p+0   2.97e-24
0x1.86a0000000000p+16  0x1.24daa9c527e96p-5    1.54e-18   -0x1.ffac3841b3da7p-1   -2.34e-17
0x1.dffffffffff1fp-22  0x1.dfffffffffe06p-22   -1.32e-23  0x1.ffffffffffc7cp-1    6.99e-27
0x1.921fb54442d17p+0   0x1.0000000000000p+0    -4.01e-32  0x1.469898cc51702p-52   -1.38e-32
0x1.0f0cf064dd592p+73  -0x1.b453ab76bf397p-1   -6.78e-18  0x1.0be2cef01c8f4p-1    -4.71e-17
0x1.fffffffffffffp+1023 0x1.452fc98b34e97p-8    -2.5e-19   -0x1.fffe62ecfab75p-1   -2.6e-17
0x1.921fb54442d18p-1   0x1.6a09e667f3bccp-1    4.1e-17    0x1.6a09e667f3bcdp-1    -2.67e-17
"""


def test_sincos_where_it_is_hardest(call: Callable[..., Array]) -> None:
    def number(word: str) -> float:
        return float.fromhex(word) if "x" in word else float(word)

    table = np.array([[number(word) for word in line.split()] for line in HARD.strip().splitlines()])
    x, sine, sine_rest, cosine, cosine_rest = table.T
    results = call("sincos", np.ascontiguousarray(x))
    for got, want, rest in zip(results, (sine, cosine), (sine_rest, cosine_rest), strict=True):
        error = np.abs((got - want) - rest) / np.spacing(np.abs(want))
        assert error.max() <= BOUND["sincos"]


@pytest.mark.slow
@np.errstate(invalid="ignore", under="ignore")
def test_special_values_are_those_of_the_c_standard(call: Callable[..., Array]) -> None:
    edges = np.array([0.0, 5e-324, 1e-310, 1.0, 1e308, np.inf, np.nan])
    edges = np.concatenate([edges, -edges])
    y, x = (np.ascontiguousarray(a.ravel()) for a in np.meshgrid(edges, edges))
    (angle,) = call("atan2", y, x)
    np.testing.assert_allclose(angle, np.arctan2(y, x), rtol=3e-16, atol=0)
    number = ~np.isnan(angle)
    np.testing.assert_array_equal(np.signbit(angle[number]), np.signbit(np.arctan2(y, x)[number]))

    sine, cosine = call("sincos", edges)
    np.testing.assert_allclose([sine, cosine], [np.sin(edges), np.cos(edges)], rtol=3e-16, atol=0)
    finite = np.isfinite(edges)
    np.testing.assert_array_equal(np.signbit(sine[finite]), np.signbit(np.sin(edges[finite])))

    (angle,) = call("acos", np.array([1.0, -1.0, 0.0, -0.0]))
    np.testing.assert_array_equal(angle, [0.0, np.pi, np.pi / 2, np.pi / 2])
    (angle,) = call("asin", np.array([1.0, -1.0, 0.0, -0.0]))
    np.testing.assert_array_equal(angle, [np.pi / 2, -np.pi / 2, 0.0, -0.0])
    np.testing.assert_array_equal(np.signbit(angle), [False, True, False, True])
    beyond = np.array([np.nextafter(1, 2), -np.nextafter(1, 2), 2.0, np.inf, -np.inf, np.nan])
    for name in ["acos", "asin"]:
        assert np.isnan(call(name, beyond)).all()


@pytest.mark.parametrize("n", [0, 1, 2, 3, 5, 7, 8, 9, 1000])
def test_an_element_does_not_depend_on_its_neighbours(n: int) -> None:
    x = angles(np.random.default_rng(4))[::1001][:n].copy()
    together = np.empty((2, n))
    _core.sincos(x, *together)
    for k in range(n):
        alone = np.empty((2, 1))
        _core.sincos(x[k : k + 1], *alone)
        np.testing.assert_array_equal(alone[:, 0], together[:, k])
