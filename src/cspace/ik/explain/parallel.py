"""Three parallel axes: the steps of include/cspace/ik/three_parallel.hpp and parallel_general.hpp."""

from __future__ import annotations

from dataclasses import replace

from cspace.ik.explain.findings import Step
from cspace.ik.explain.form import Form, symbol
from cspace.ik.explain.wrist import (
    a1,
    a2,
    define,
    height_behind_one,
    in_frame_one,
    pz,
    sum_squares,
    turn_steps,
)
from cspace.math import Equation, Product, TrigMatrix, TrigPolynomial

a3, a4, a5, d3, d4, d5 = (symbol(name) for name in ("a_3", "a_4", "a_5", "d_3", "d_4", "d_5"))
u, v, x, y, d2 = map(symbol, ("u", "v", "x", "y", "d_2"))


def wrist_height(form: Form) -> TrigPolynomial:
    """The height of the wrist along axes 2, 3, 4, without joint 5."""
    return d2 + d3 + d4 + form.twist(4)[0] * d5


def three_parallel_steps(form: Form) -> list[Step]:
    """Axes 2, 3, 4 parallel, 5 and 6 meet."""
    shoulder = Step.of_angles(
        "1",
        "subproblem 4",
        "Joints 2, 3 and 4 do not change heights along their axes, and joints 5 and 6 do not move the "
        "wrist, so its height depends only on $t_1$.",
        Equation(height_behind_one(form), wrist_height(form), unit="m"),
    )
    return [shoulder, *turn_steps(form, 1, "234"), *planar_steps(form, TrigPolynomial())]


def middle_parallel_steps(form: Form) -> list[Step]:
    """Axes 2, 3, 4 parallel, 5 and 6 apart."""
    (ca1, sa1), (ca4, sa4), (ca5, sa5) = (form.twist(i) for i in (1, 4, 5))
    r = {i: symbol(f"r_{i}3") for i in (1, 2, 3)}
    both = Step.of_angles(
        "1 5",
        "subproblem 6",
        "Joints 2, 3 and 4 change neither heights along their axes nor angles with them: the height of "
        "axis 6 and its slope are two equations in $t_1$ and $t_5$.",
        Equation(height_behind_one(form), wrist_height(form) + sa4 * a5 * form.sin(5), unit="m"),
        Equation(
            ca1 * r[3] + sa1 * (form.sin(1) * r[1] - form.cos(1) * r[2]), ca4 * ca5 - sa4 * sa5 * form.cos(5)
        ),
    )
    _, first, last = turn_steps(form, 1, "234")
    front = "$M = (R_z(t_1) R_x(\\alpha_1))^T R$ is what the plane sees of the orientation. "
    return [both, replace(first, words=front + first.words), last, *planar_steps(form, a5)]


def law_of_cosines(middle: str, first: TrigPolynomial, second: TrigPolynomial, form: Form) -> Equation:
    """The distance |(u, v)| that two links with an angle between them span."""
    span = sum_squares(first, second) + 2.0 * first * second * form.cos(int(middle))
    return Equation(sum_squares(u, v), span, unit="m²")


def planar_steps(form: Form, a5: TrigPolynomial) -> list[Step]:
    """The planar arm of joints 2, 3, 4, its last angle the rest of their sum.

    a5: zero if axes 5 and 6 meet.
    """
    c234, s234, (ca4, sa4) = form.cos(2, 3, 4), form.sin(2, 3, 4), form.twist(4)
    X, Y = a4 + a5 * form.cos(5), ca4 * a5 * form.sin(5) - sa4 * d5
    return [
        Step.of_angles(
            "3",
            "subproblem 3",
            "Axis 4, seen from axis 2 in the plane, is at $(u, v)$; links $a_2$ and $a_3$ span that "
            "distance: the law of cosines.",
            *in_frame_one(form),
            define("u", x - c234 * X + s234 * Y, "m"),
            define("v", y - s234 * X - c234 * Y, "m"),
            law_of_cosines("3", a2, a3, form),
        ),
        Step.of_angles(
            "2",
            "subproblem 1",
            "$t_2$ rotates the bent arm to $(u, v)$; $t_4$ is the rest of the sum $t_{234}$.",
            Equation(u, a2 * form.cos(2) + a3 * form.cos(2, 3), unit="m"),
            Equation(v, a2 * form.sin(2) + a3 * form.sin(2, 3), unit="m"),
        ),
    ]


def first_parallel_steps(form: Form) -> list[Step]:
    """Axes 1, 2, 3 parallel."""
    c = {i: form.cos(i) for i in (4, 5, 6)}
    s = {i: form.sin(i) for i in (4, 5, 6)}
    (ca3, sa3), (ca4, sa4), (ca5, sa5) = (form.twist(i) for i in (3, 4, 5))
    rx, ry, rz = (symbol(f"r_3{j}") for j in (1, 2, 3))
    slope = Equation(rz * ca5 + sa5 * (ry * c[6] + rx * s[6]), ca3 * ca4 - sa3 * sa4 * c[4])
    level = Equation(
        pz,
        d2 + d3 + ca3 * d4 + sa3 * a4 * s[4] + ca5 * d5 * rz
        + (a5 * rx + d5 * sa5 * ry) * c[6] + (d5 * sa5 * rx - a5 * ry) * s[6],
        unit="m",
    )  # fmt: skip
    k = Product((form.about_x(3), form.about_z(4), form.about_x(4))).matrix()
    kx, ky = symbol("k_x"), symbol("k_y")
    Q = parallel_displacement(form)
    return [
        Step.of_angles(
            "4 6",
            "subproblem 6",
            "Joints 1, 2 and 3 change neither heights along their axes nor angles with them: the height "
            "of the goal and the slope of axis 5 against them are two equations in $t_4$ and $t_6$.",
            slope,
            level,
        ),
        Step.of_angles(
            "5",
            "subproblem 1",
            "The direction of the parallel axes, seen from both sides of joint 5.",
            define("k_x", k[2, 0]),
            define("k_y", k[2, 1]),
            Equation(kx * c[5] + ky * s[5], rx * c[6] - ry * s[6]),
            Equation(ky * c[5] - kx * s[5], ca5 * (rx * s[6] + ry * c[6]) - sa5 * rz),
        ),
        Step.of_angles(
            "2",
            "subproblem 3",
            "With joints 4, 5, 6 known, axis 3 seen from axis 1 in the plane is at $(u, v)$; links $a_1$ "
            "and $a_2$ span that distance: the law of cosines.",
            define("u", Q[0, 3], "m"),
            define("v", Q[1, 3], "m"),
            law_of_cosines("2", a1, a2, form),
        ),
        Step.of_angles(
            "1",
            "subproblem 1",
            "$t_1$ rotates the bent arm to $(u, v)$.",
            Equation(u, a1 * form.cos(1) + a2 * form.cos(1, 2), unit="m"),
            Equation(v, a1 * form.sin(1) + a2 * form.sin(1, 2), unit="m"),
        ),
        Step.of_angles(
            "123",
            "",
            "The sum is the angle of the plane; $t_3$ is its rest.",
            define("n_x", Q[0, 0]),
            define("n_y", Q[1, 0]),
            Equation(symbol("n_x"), form.cos(1, 2, 3)),
            Equation(symbol("n_y"), form.sin(1, 2, 3)),
        ),
    ]


def parallel_displacement(form: Form) -> TrigMatrix:
    """P (Tx(a3) Rx(α3) A4 A5 Rz(t6))⁻¹: the displacement by the three parallel joints."""
    rest = TrigMatrix.shift(x=form.a[2]) @ form.about_x(3)[2]
    for i in (4, 5):
        rest = rest @ form.about_z(i)[2] @ TrigMatrix.shift(x=form.a[i - 1], z=form.d[i - 1])
        rest = rest @ form.about_x(i)[2]
    rest = (rest @ form.about_z(6)[2]).with_numbers(form.constants())
    return TrigMatrix.symbols() @ rest.inverse()
