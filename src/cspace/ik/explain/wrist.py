"""Three joints position a wrist, three rotate it: the steps of include/cspace/ik/spherical_wrist.hpp."""

from __future__ import annotations

from cspace.ik.explain.findings import Step
from cspace.ik.explain.form import Form, symbol
from cspace.math import Equation, Product, TrigPolynomial

define = Equation.definition
px, py, pz = (symbol(f"p_{axis}") for axis in "xyz")
wx, wy, wz = (symbol(f"w_{axis}") for axis in "xyz")
vx, vy, vz = (symbol(f"v_{axis}") for axis in "xyz")
x, y, a1, a2, d2 = map(symbol, ("x", "y", "a_1", "a_2", "d_2"))


def wrist_constants(form: Form) -> dict[str, float]:
    """w, the wrist centre in the frame behind joint 3 at t_3 = 0."""
    return {
        "w_x": form.a[2],
        "w_y": -form.sa[2] * form.d[3],
        "w_z": form.d[2] + form.ca[2] * form.d[3],
    }


def wrist_steps(form: Form, kind: int) -> list[Step]:
    """The steps of an arm with a spherical wrist whose first three axes share `kind`."""
    ca3, sa3 = form.twist(3)
    where = Step(
        "$w$",
        "The wrist centre is at $w$ behind joint 3 and rotates with $t_3$; $p$ is its goal.",
        (
            define("w_x", symbol("a_3"), "m"),
            define("w_y", -sa3 * symbol("d_4"), "m"),
            define("w_z", symbol("d_3") + ca3 * symbol("d_4"), "m"),
        ),
    )
    in_order_of_the_core = (last_parallel, first_meet, last_meet, first_parallel, pieper_quartic)
    return [where, *in_order_of_the_core[kind](form), *turn_steps(form, 3, "4")]


def turned_by_three(form: Form) -> tuple[TrigPolynomial, TrigPolynomial]:
    """x and y of w turned by t_3."""
    c3, s3 = form.cos(3), form.sin(3)
    return c3 * wx - s3 * wy, s3 * wx + c3 * wy


def turned_by_two(form: Form) -> tuple[TrigPolynomial, TrigPolynomial]:
    """x and y of v turned by t_2."""
    c2, s2 = form.cos(2), form.sin(2)
    return c2 * vx - s2 * vy, s2 * vx + c2 * vy


def height_along_two(form: Form) -> TrigPolynomial:
    """The height of the wrist along axis 2, by t_3."""
    ca2, sa2 = form.twist(2)
    return ca2 * wz + sa2 * turned_by_three(form)[1]


def behind_joint_two(form: Form, *, a2: TrigPolynomial = a2) -> tuple[Equation, ...]:
    """v, the wrist in the frame behind joint 1, before joint 2 turns: (a2, 0, d2) + Rx(α2) Rz(t3) w."""
    ca2, sa2 = form.twist(2)
    x3, y3 = turned_by_three(form)
    return (
        define("v_x", x3 + a2, "m"),
        define("v_y", ca2 * y3 - sa2 * wz, "m"),
        define("v_z", height_along_two(form) + d2, "m"),
    )


def pan_step(form: Form, *, a1: TrigPolynomial = a1) -> Step:
    """t_1 from the bearing of p."""
    (c1, s1), (ca1, sa1) = (form.cos(1), form.sin(1)), form.twist(1)
    x2, y2 = turned_by_two(form)
    ahead, aside = x2 + a1, ca1 * y2 - sa1 * vz
    return Step.of_angles(
        "1",
        "subproblem 1",
        "Both sides of the first joint are known now: the bearing of $p$ about axis 1 gives its angle.",
        Equation(px, c1 * ahead - s1 * aside, unit="m"),
        Equation(py, s1 * ahead + c1 * aside, unit="m"),
    )


def in_frame_one(form: Form) -> tuple[Equation, ...]:
    """x and y of p in the frame behind joint 1."""
    (c1, s1), (ca1, sa1) = (form.cos(1), form.sin(1)), form.twist(1)
    return (
        define("x", c1 * px + s1 * py - a1, "m"),
        define("y", ca1 * (c1 * py - s1 * px) + sa1 * pz, "m"),
    )


def height_behind_one(form: Form) -> TrigPolynomial:
    """The height of p along axis 2, in the frame behind joint 1."""
    ca1, sa1 = form.twist(1)
    return sa1 * (form.sin(1) * px - form.cos(1) * py) + ca1 * pz


def sum_squares(*parts: TrigPolynomial) -> TrigPolynomial:
    """The sum of squares."""
    return sum((part * part for part in parts), TrigPolynomial())


def last_parallel(form: Form) -> list[Step]:
    """Axes 2 and 3 parallel."""
    c23, s23 = form.cos(2, 3), form.sin(2, 3)
    return [
        Step.of_angles(
            "1",
            "subproblem 4",
            "Joints 2 and 3 do not change the height of the wrist along their axes, so it depends on "
            "$t_1$ alone.",
            Equation(height_behind_one(form), wz + d2, unit="m"),
        ),
        Step.of_angles(
            "3",
            "subproblem 3",
            "In the plane across axes 2 and 3 an upper arm $a_2$ and a forearm to the wrist span the "
            "distance of the wrist from axis 2: the law of cosines.",
            *in_frame_one(form),
            Equation(
                sum_squares(x, y), sum_squares(a2, wx, wy) + 2.0 * a2 * turned_by_three(form)[0], unit="m²"
            ),
        ),
        Step.of_angles(
            "2",
            "subproblem 1",
            "The bent arm is rotated until the wrist is at its goal.",
            Equation(x, a2 * form.cos(2) + wx * c23 - wy * s23, unit="m"),
            Equation(y, a2 * form.sin(2) + wx * s23 + wy * c23, unit="m"),
        ),
    ]


def first_meet(form: Form) -> list[Step]:
    """Axes 1 and 2 meet."""
    (ca1, sa1), (ca2, sa2) = form.twist(1), form.twist(2)
    x3, y3 = turned_by_three(form)
    reach = sum_squares(a2, d2, wx, wy, wz) + 2.0 * (a2 * x3 + d2 * (sa2 * y3 + ca2 * wz))
    return [
        Step.of_angles(
            "3",
            "subproblem 3",
            "Joints 1 and 2 do not move the point where their axes meet, so the distance of the wrist "
            "from it depends only on $t_3$.",
            Equation(sum_squares(px, py, pz), reach, unit="m²"),
        ),
        Step.of_angles(
            "2",
            "subproblem 4",
            "Joint 1 does not change heights along its axis: that of the wrist, now known behind joint 2, "
            "fixes $t_2$.",
            *behind_joint_two(form),
            Equation(pz, ca1 * vz + sa1 * turned_by_two(form)[1], unit="m"),
        ),
        pan_step(form, a1=TrigPolynomial()),
    ]


def last_meet(form: Form) -> list[Step]:
    """Axes 2 and 3 meet."""
    c1, s1 = form.cos(1), form.sin(1)
    x2, y2 = turned_by_two(form)
    reach = sum_squares(wx, wy, wz) + 2.0 * (a1 * (c1 * px + s1 * py) + d2 * height_behind_one(form))
    return [
        Step.of_angles(
            "1",
            "subproblem 3",
            "Joints 2 and 3 do not move the point where their axes meet, so the distance of the wrist "
            "from it is constant. This gives an equation in $t_1$ alone.",
            Equation(sum_squares(px, py, pz, a1, d2), reach, unit="m²"),
        ),
        Step.of_angles(
            "3",
            "subproblem 4",
            "Joint 2 does not change heights along its axis: that of the wrist, known in front of it, "
            "fixes $t_3$.",
            *in_frame_one(form),
            define("z", height_behind_one(form) - d2, "m"),
            Equation(symbol("z"), height_along_two(form), unit="m"),
        ),
        Step.of_angles(
            "2",
            "subproblem 1",
            "The bearing of the wrist about axis 2 gives the remaining angle.",
            *behind_joint_two(form, a2=TrigPolynomial()),
            Equation(x, x2, unit="m"),
            Equation(y, y2, unit="m"),
        ),
    ]


def first_parallel(form: Form) -> list[Step]:
    """Axes 1 and 2 parallel."""
    reach = sum_squares(a1, vx, vy) + 2.0 * a1 * turned_by_two(form)[0]
    return [
        Step.of_angles(
            "3",
            "subproblem 4",
            "Joints 1 and 2 do not change heights along their axes: that of the wrist depends on $t_3$ "
            "alone.",
            Equation(pz, d2 + height_along_two(form), unit="m"),
        ),
        Step.of_angles(
            "2",
            "subproblem 3",
            "The distance of the wrist from axis 1 gives the elbow angle between the two parallel axes.",
            *behind_joint_two(form),
            Equation(sum_squares(px, py), reach, unit="m²"),
        ),
        pan_step(form),
    ]


def pieper_quartic(form: Form) -> list[Step]:
    """Three axes in general position."""
    ca1, sa1 = form.twist(1)
    x2, y2 = turned_by_two(form)
    v2, p2 = sum_squares(vx, vy, vz), sum_squares(px, py, pz)
    k, m, n = symbol("k"), symbol("m"), 4.0 * a1 * a1
    return [
        Step.of_angles(
            "3",
            "subproblem 5",
            "The distance from the foot of axis 1 and the height along it are two equations, linear in "
            "cosine and sine of $t_2$. Their squares add up to one without $t_2$: a quartic in "
            "$\\tan(t_3/2)$ (Pieper 1968).",
            *behind_joint_two(form),
            define("k", p2 - a1 * a1 - v2, "m²"),
            define("m", pz - ca1 * vz, "m"),
            Equation(sa1 * sa1 * k * k + n * m * m, n * sa1 * sa1 * sum_squares(vx, vy), unit="m⁴"),
        ),
        Step.of_angles(
            "2",
            "subproblem 1",
            "The same two equations, with $t_3$ known.",
            Equation(p2, a1 * a1 + v2 + 2.0 * a1 * x2, unit="m²"),
            Equation(pz, ca1 * vz + sa1 * y2, unit="m"),
        ),
        pan_step(form),
    ]


def turn_steps(form: Form, before: int, first: str) -> list[Step]:
    """The wrist: t_5, then the angle in front of it, then t_6.

    before: how many joints turn in front of the wrist's own rotation M. first: the joints whose angles add up
    to the first angle of the wrist.
    """
    M = form.turned_goal(before)
    turns = [form.about_z(int(i)) for i in first]
    wrist = Product((*turns, form.about_x(4), form.about_z(5), form.about_x(5), form.about_z(6))).matrix()
    front = form.seen_from(before).latex().replace(r" \, ", " ")
    (ca4, sa4), (ca5, sa5), c5, s5 = form.twist(4), form.twist(5), form.cos(5), form.sin(5)
    c, s = form.cos(*map(int, first)), form.sin(*map(int, first))
    m = {i: symbol(f"m_{i}1") for i in (1, 2, 3)}
    nx, ny, nz = (symbol(f"n_{axis}") for axis in "xyz")
    aside = c * m[2] - s * m[1]

    def entries(*places: tuple[int, int]) -> list[Equation]:
        return [define(f"m_{i}{j}", M[i - 1, j - 1]) for i, j in places]

    def equals(i: int, j: int) -> Equation:
        return Equation(symbol(f"m_{i}{j}"), wrist[i - 1, j - 1])

    return [
        Step.of_angles(
            "5",
            "subproblem 4",
            f"The remaining orientation, $M = ({front})^T R$, is the rotation of the wrist. Its third "
            "diagonal entry, the cosine between axes 4 and 6, depends only on $t_5$.",
            *entries((3, 3)),
            equals(3, 3),
        ),
        Step.of_angles(
            first,
            "subproblem 1",
            "The third column of $M$ is the direction of axis 6.",
            *entries((1, 3), (2, 3)),
            equals(1, 3),
            equals(2, 3),
        ),
        Step.of_angles(
            "6",
            "subproblem 1",
            "The first column of $M$, seen behind the first joint of the wrist, is $n$; behind the second "
            "one it has only the cosine and sine of $t_6$ left.",
            *entries((1, 1), (2, 1), (3, 1)),
            define("n_x", c * m[1] + s * m[2]),
            define("n_y", ca4 * aside + sa4 * m[3]),
            define("n_z", ca4 * m[3] - sa4 * aside),
            Equation(form.cos(6), c5 * nx + s5 * ny),
            Equation(form.sin(6), ca5 * (c5 * ny - s5 * nx) + sa5 * nz),
        ),
    ]
