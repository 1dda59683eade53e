"""Formulas as data: polynomials in cosines and sines of joint angles, that print and can be evaluated."""

from cspace.math.equation import Equation, MatrixEquation
from cspace.math.trig_matrix import Product, TrigMatrix
from cspace.math.trig_polynomial import Angle, TrigPolynomial

__all__ = ["Angle", "Equation", "MatrixEquation", "Product", "TrigMatrix", "TrigPolynomial"]
