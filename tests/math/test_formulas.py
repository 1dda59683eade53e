"""Polynomials in cosines and sines: an algebra whose values are those of ordinary numbers."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.math import Angle, Equation, Product, TrigMatrix, TrigPolynomial

ANGLES = [Angle(1, 1), Angle(2, 2), Angle(3, 2), Angle(4, 2), Angle(5, 3)]
SYMBOLS = ["p_x", "a_2", "ca_1"]
cos, sin, symbol = TrigPolynomial.cos, TrigPolynomial.sin, TrigPolynomial.symbol


def random_polynomial(rng, size=4):
    total = TrigPolynomial()
    for _ in range(size):
        term = TrigPolynomial.number(rng.normal())
        for _ in range(rng.integers(0, 4)):
            choice = rng.integers(0, 3)
            angle = ANGLES[rng.integers(0, len(ANGLES))]
            term = term * [cos(angle), sin(angle), symbol(SYMBOLS[rng.integers(0, 3)])][choice]
        total = total + term
    return total


def random_values(rng, shape=(7,)):
    return {
        **{f"t_{angle.index}": rng.uniform(-4, 4, shape) for angle in ANGLES},
        **{name: rng.normal(size=shape) for name in SYMBOLS},
    }


@pytest.mark.parametrize("seed", range(20))
def test_sums_and_products_have_the_values_of_sums_and_products(seed):
    rng = np.random.default_rng(seed)
    f, g, values = random_polynomial(rng), random_polynomial(rng), random_values(rng)
    F, G = f.evaluate(values), g.evaluate(values)
    np.testing.assert_allclose((f + g).evaluate(values), F + G, atol=1e-12)
    np.testing.assert_allclose((f * g).evaluate(values), F * G, atol=1e-10)
    np.testing.assert_allclose((2.0 - f).evaluate(values), 2.0 - F, atol=1e-12)
    assert f * g == g * f
    assert (f + g) * f == f * f + g * f
    assert not (f - f).terms


@pytest.mark.parametrize("seed", range(5))
def test_numbers_take_the_place_of_symbols(seed):
    rng = np.random.default_rng(seed)
    f, values = random_polynomial(rng) * symbol("a_2"), random_values(rng, ())
    known = {"a_2": values["a_2"], "ca_1": values["ca_1"]}
    g = f.with_numbers(known)
    assert not g.symbols() & set(known)
    np.testing.assert_allclose(g.evaluate(values), f.evaluate(values), atol=1e-12)


def test_products_of_one_group_become_sums():
    a, b = ANGLES[1:3]
    assert (cos(a) * cos(b) - sin(a) * sin(b)).text() == "c23"
    assert (sin(a) * cos(b) + cos(a) * sin(b)).latex() == "s_{23}"
    assert (cos(a) * cos(a) + sin(a) * sin(a)).text() == "1"
    assert (cos(a) * cos(b) + sin(a) * sin(b)).text() == "cos(t2 − t3)"
    assert (cos(ANGLES[0]) * cos(a)).text() == "c1 c2"
    with pytest.raises(ValueError, match="one group"):
        cos(ANGLES[0], a)


def test_what_is_printed():
    f = 0.5 * symbol("a_2") * cos(ANGLES[0]) * symbol("p_x") - symbol("ca_1") * symbol("ca_1") + 3
    assert f.text() == "3 − cα1² + 0.5 a2 c1 px"
    assert f.latex() == r"3 - c_{\alpha_{1}}^2 + 0.5 a_{2} c_{1} p_{x}"
    assert TrigPolynomial().text() == "0"
    assert (cos(ANGLES[0]) + 1e-7 * sin(ANGLES[0])).text(least=1e-5) == "c1"


@pytest.mark.parametrize("seed", range(5))
def test_matrices_multiply_and_invert_as_their_values_do(seed):
    rng = np.random.default_rng(seed)
    values = random_values(rng, (3,))
    A = (
        TrigMatrix.about_z(ANGLES[1])
        @ TrigMatrix.shift(symbol("a_2"), 0.3, -1)
        @ TrigMatrix.turn("x", 0.6, 0.8)
    )
    B = TrigMatrix.about_z(ANGLES[2]) @ TrigMatrix.shift(z=symbol("p_x"))
    names = Product((("A", "A", A), ("B", "B", B)))
    np.testing.assert_allclose((A @ B).evaluate(values), A.evaluate(values) @ B.evaluate(values), atol=1e-12)
    np.testing.assert_allclose(names.evaluate(values), names.matrix().evaluate(values), atol=1e-12)
    np.testing.assert_allclose(A.inverse().evaluate(values), np.linalg.inv(A.evaluate(values)), atol=1e-12)
    assert names.text() == "A B"
    assert names.latex() == r"A \, B"
    one = A @ A.inverse()
    np.testing.assert_allclose(one.evaluate(values) - np.eye(4), 0, atol=1e-12)


def test_equations_say_how_far_they_are_off():
    c, s = cos(ANGLES[0]), sin(ANGLES[0])
    true = Equation(symbol("p_x"), 2.0 * c)
    theta = np.linspace(-3, 3, 11)
    np.testing.assert_allclose(true.residual({"t_1": theta, "p_x": 2 * np.cos(theta)}), 0, atol=1e-15)
    assert (
        np.abs(Equation(symbol("p_x"), 2.0 * s).residual({"t_1": theta, "p_x": 2 * np.cos(theta)})).max() > 1
    )
    assert true.text() == "px = 2 c1"
    assert true.latex() == "p_{x} &= 2 c_{1}"
    assert Equation.definition("p_x", c).with_numbers({"p_x": 3.0}).text() == "px = c1"
