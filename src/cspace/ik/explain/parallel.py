"""Three parallel axes: the steps of include/cspace/ik/three_parallel.hpp and parallel_general.hpp."""

from __future__ import annotations

from cspace.ik.explain.findings import Step
from cspace.ik.explain.form import Form, symbol
from cspace.ik.explain.wrist import define, in_frame_one, px, py, pz, sum_squares, turn_steps
from cspace.math import Equation, Product, TrigMatrix, TrigPolynomial


def wrist_heights(form: Form) -> tuple[TrigPolynomial, TrigPolynomial]:
    """The height of the goal and of the wrist along axes 2, 3, 4; that of the wrist without joint 5."""
    (c1, s1), (ca1, sa1), ca4 = (form.cos(1), form.sin(1)), form.twist(1), form.twist(4)[0]
    d = [symbol(f"d_{i}") for i in range(1, 6)]
    return sa1 * (s1 * px - c1 * py) + ca1 * pz, d[1] + d[2] + d[3] + ca4 * d[4]


def three_parallel_steps(form: Form) -> list[Step]:
    """Axes 2, 3, 4 parallel, 5 and 6 meet."""
    goal, own = wrist_heights(form)
    shoulder = Step(
        "$t_1$",
        2,
        "subproblem 4",
        "Joints 2, 3 and 4 do not change heights along their axes, and joints 5 and 6 do not move the "
        "wrist, so its height depends only on $t_1$.",
        (Equation(goal, own, unit="m"),),
    )
    return [shoulder, *turn_steps(form, 1, (2, 3, 4)), *planar_steps(form, meeting=True)]


def middle_parallel_steps(form: Form) -> list[Step]:
    """Axes 2, 3, 4 parallel, 5 and 6 apart."""
    (goal, own), (ca1, sa1), (ca4, sa4) = wrist_heights(form), form.twist(1), form.twist(4)
    ca5, sa5 = form.twist(5)
    c1, s1, c5, s5 = form.cos(1), form.sin(1), form.cos(5), form.sin(5)
    r = {i: symbol(f"r_{i}3") for i in (1, 2, 3)}
    both = Step(
        "$t_1, t_5$",
        4,
        "subproblem 6",
        "Joints 2, 3 and 4 change neither heights along their axes nor angles with them: the height of "
        "axis 6 and its slope are two equations in $t_1$ and $t_5$.",
        (
            Equation(goal, own + sa4 * symbol("a_5") * s5, unit="m"),
            Equation(ca1 * r[3] + sa1 * (s1 * r[1] - c1 * r[2]), ca4 * ca5 - sa4 * sa5 * c5),
        ),
    )
    turns = turn_steps(form, 1, (2, 3, 4))[1:]
    front = "$M = (R_z(t_1) R_x(\\alpha_1))^T R$ is what the plane sees of the orientation. "
    turns[0] = Step(turns[0].finds, 1, turns[0].method, front + turns[0].words, turns[0].equations)
    return [both, *turns, *planar_steps(form, meeting=False)]


def planar_steps(form: Form, *, meeting: bool) -> list[Step]:
    """The planar arm of joints 2, 3, 4, its last angle the rest of their sum."""
    c234, s234, c5, s5 = form.cos(2, 3, 4), form.sin(2, 3, 4), form.cos(5), form.sin(5)
    (c2, s2), c23, s23, c3 = (form.cos(2), form.sin(2)), form.cos(2, 3), form.sin(2, 3), form.cos(3)
    ca4, sa4 = form.twist(4)
    a2, a3, a4, a5 = (symbol(f"a_{i}") for i in (2, 3, 4, 5))
    X, Y = a4, -sa4 * symbol("d_5")
    if not meeting:
        X, Y = X + a5 * c5, Y + ca4 * a5 * s5
    u, v, x, y = symbol("u"), symbol("v"), symbol("x"), symbol("y")
    return [
        Step(
            "$t_3$",
            2,
            "subproblem 3",
            "Axis 4, seen from axis 2 in the plane, is at $(u, v)$; links $a_2$ and $a_3$ span that "
            "distance: the law of cosines.",
            (
                *in_frame_one(form),
                define("u", x - c234 * X + s234 * Y, "m"),
                define("v", y - s234 * X - c234 * Y, "m"),
                Equation(sum_squares(u, v), sum_squares(a2, a3) + 2.0 * a2 * a3 * c3, unit="m²"),
            ),
        ),
        Step(
            "$t_2, t_4$",
            1,
            "subproblem 1",
            "$t_2$ rotates the bent arm to $(u, v)$; $t_4$ is the rest of the sum $t_{234}$.",
            (
                Equation(u, a2 * c2 + a3 * c23, unit="m"),
                Equation(v, a2 * s2 + a3 * s23, unit="m"),
            ),
        ),
    ]


def first_parallel_steps(form: Form) -> list[Step]:
    """Axes 1, 2, 3 parallel."""
    c = {i: form.cos(i) for i in (4, 5, 6)}
    s = {i: form.sin(i) for i in (4, 5, 6)}
    (ca3, sa3), (ca4, sa4), (ca5, sa5) = (form.twist(i) for i in (3, 4, 5))
    a4, a5, d2, d3, d4, d5 = (symbol(name) for name in ("a_4", "a_5", "d_2", "d_3", "d_4", "d_5"))
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
    qx, qy, a1, a2 = symbol("u"), symbol("v"), symbol("a_1"), symbol("a_2")
    return [
        Step(
            "$t_4, t_6$",
            4,
            "subproblem 6",
            "Joints 1, 2 and 3 change neither heights along their axes nor angles with them: the height "
            "of the goal and the slope of axis 5 against them are two equations in $t_4$ and $t_6$.",
            (slope, level),
        ),
        Step(
            "$t_5$",
            1,
            "subproblem 1",
            "The direction of the parallel axes, seen from both sides of joint 5.",
            (
                define("k_x", k[2, 0]),
                define("k_y", k[2, 1]),
                Equation(kx * c[5] + ky * s[5], rx * c[6] - ry * s[6]),
                Equation(ky * c[5] - kx * s[5], ca5 * (rx * s[6] + ry * c[6]) - sa5 * rz),
            ),
        ),
        Step(
            "$t_2$",
            2,
            "subproblem 3",
            "With joints 4, 5, 6 known, axis 3 seen from axis 1 in the plane is at $(u, v)$; links $a_1$ "
            "and $a_2$ span that distance: the law of cosines.",
            (
                define("u", Q[0, 3], "m"),
                define("v", Q[1, 3], "m"),
                Equation(sum_squares(qx, qy), sum_squares(a1, a2) + 2.0 * a1 * a2 * form.cos(2), unit="m²"),
            ),
        ),
        Step(
            "$t_1, t_3$",
            1,
            "subproblem 1",
            "$t_1$ rotates the bent arm to $(u, v)$; $t_3$ is the rest of $t_{123}$, the angle of the plane.",
            (
                Equation(qx, a1 * form.cos(1) + a2 * form.cos(1, 2), unit="m"),
                Equation(qy, a1 * form.sin(1) + a2 * form.sin(1, 2), unit="m"),
                define("n_x", Q[0, 0]),
                define("n_y", Q[1, 0]),
                Equation(symbol("n_x"), form.cos(1, 2, 3)),
                Equation(symbol("n_y"), form.sin(1, 2, 3)),
            ),
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
