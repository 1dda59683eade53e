"""Three joints position a wrist, three rotate it: the steps of include/cspace/ik/spherical_wrist.hpp."""

from __future__ import annotations

from cspace.ik.explain.findings import Step
from cspace.ik.explain.form import Form, symbol
from cspace.math import Equation, Product, TrigPolynomial

define = Equation.definition
LAST_PARALLEL, FIRST_MEET, LAST_MEET, FIRST_PARALLEL, GENERAL = range(5)
"""What the first three axes share, in the order of the core."""
px, py, pz = (symbol(f"p_{axis}") for axis in "xyz")
wx, wy, wz = (symbol(f"w_{axis}") for axis in "xyz")
vx, vy, vz = (symbol(f"v_{axis}") for axis in "xyz")


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
        1,
        "",
        "The wrist centre is at $w$ behind joint 3 and rotates with $t_3$; $p$ is its goal.",
        (
            define("w_x", symbol("a_3"), "m"),
            define("w_y", -sa3 * symbol("d_4"), "m"),
            define("w_z", symbol("d_3") + ca3 * symbol("d_4"), "m"),
        ),
    )
    place = {
        LAST_PARALLEL: last_parallel,
        FIRST_MEET: first_meet,
        LAST_MEET: last_meet,
        FIRST_PARALLEL: first_parallel,
        GENERAL: any_three,
    }[kind](form)
    return [where, *place, *turn_steps(form, 3, (4,))]


def behind_joint_two(form: Form, *, a2: bool = True) -> tuple[Equation, ...]:
    """v, the wrist in the frame behind joint 1, before joint 2 turns: (a2, 0, d2) + Rx(α2) Rz(t3) w."""
    c3, s3 = form.cos(3), form.sin(3)
    ca2, sa2 = form.twist(2)
    y = s3 * wx + c3 * wy
    x = c3 * wx - s3 * wy
    return (
        define("v_x", x + symbol("a_2") if a2 else x, "m"),
        define("v_y", ca2 * y - sa2 * wz, "m"),
        define("v_z", sa2 * y + ca2 * wz + symbol("d_2"), "m"),
    )


def turned_by_two(form: Form) -> tuple[TrigPolynomial, TrigPolynomial]:
    """x and y of v turned by t_2."""
    c2, s2 = form.cos(2), form.sin(2)
    return c2 * vx - s2 * vy, s2 * vx + c2 * vy


def pan_step(form: Form, *, a1: bool = True) -> Step:
    """t_1 from the bearing of p."""
    (c1, s1), (ca1, sa1) = (form.cos(1), form.sin(1)), form.twist(1)
    x, y = turned_by_two(form)
    x, y = (x + symbol("a_1") if a1 else x), ca1 * y - sa1 * vz
    return Step(
        "$t_1$",
        1,
        "subproblem 1",
        "Both sides of the first joint are known now: the bearing of $p$ about axis 1 gives its angle.",
        (Equation(px, c1 * x - s1 * y, unit="m"), Equation(py, s1 * x + c1 * y, unit="m")),
    )


def in_frame_one(form: Form) -> tuple[Equation, ...]:
    """x and y of p in the frame behind joint 1."""
    (c1, s1), (ca1, sa1) = (form.cos(1), form.sin(1)), form.twist(1)
    return (
        define("x", c1 * px + s1 * py - symbol("a_1"), "m"),
        define("y", ca1 * (c1 * py - s1 * px) + sa1 * pz, "m"),
    )


def last_parallel(form: Form) -> list[Step]:
    """Axes 2 and 3 parallel."""
    (c1, s1), (ca1, sa1) = (form.cos(1), form.sin(1)), form.twist(1)
    (c2, s2), (c3, s3) = (form.cos(2), form.sin(2)), (form.cos(3), form.sin(3))
    c23, s23 = form.cos(2, 3), form.sin(2, 3)
    x, y, a2 = symbol("x"), symbol("y"), symbol("a_2")
    return [
        Step(
            "$t_1$",
            2,
            "subproblem 4",
            "Joints 2 and 3 do not change the height of the wrist along their axes, so it depends on "
            "$t_1$ alone.",
            (Equation(sa1 * (s1 * px - c1 * py) + ca1 * pz, wz + symbol("d_2"), unit="m"),),
        ),
        Step(
            "$t_3$",
            2,
            "subproblem 3",
            "In the plane across axes 2 and 3 an upper arm $a_2$ and a forearm to the wrist span the "
            "distance of the wrist from axis 2: the law of cosines.",
            (
                *in_frame_one(form),
                Equation(
                    x * x + y * y,
                    a2 * a2 + wx * wx + wy * wy + 2.0 * a2 * (wx * c3 - wy * s3),
                    unit="m²",
                ),
            ),
        ),
        Step(
            "$t_2$",
            1,
            "subproblem 1",
            "The bent arm is rotated until the wrist is at its goal.",
            (
                Equation(x, a2 * c2 + wx * c23 - wy * s23, unit="m"),
                Equation(y, a2 * s2 + wx * s23 + wy * c23, unit="m"),
            ),
        ),
    ]


def sum_squares(*parts: TrigPolynomial) -> TrigPolynomial:
    """The sum of squares."""
    return sum((part * part for part in parts), TrigPolynomial())


def first_meet(form: Form) -> list[Step]:
    """Axes 1 and 2 meet."""
    c3, s3 = form.cos(3), form.sin(3)
    (ca1, sa1), (ca2, sa2) = form.twist(1), form.twist(2)
    a2, d2 = symbol("a_2"), symbol("d_2")
    _, y = turned_by_two(form)
    length2 = (
        sum_squares(a2, d2, wx, wy, wz)
        + 2.0 * d2 * ca2 * wz
        + 2.0 * (a2 * wx + d2 * sa2 * wy) * c3
        + 2.0 * (d2 * sa2 * wx - a2 * wy) * s3
    )
    return [
        Step(
            "$t_3$",
            2,
            "subproblem 3",
            "Joints 1 and 2 do not move the point where their axes meet, so the distance of the wrist "
            "from it depends only on $t_3$.",
            (Equation(sum_squares(px, py, pz), length2, unit="m²"),),
        ),
        Step(
            "$t_2$",
            2,
            "subproblem 4",
            "Joint 1 does not change heights along its axis: that of the wrist, now known behind joint 2, "
            "fixes $t_2$.",
            (*behind_joint_two(form), Equation(pz, ca1 * vz + sa1 * y, unit="m")),
        ),
        pan_step(form, a1=False),
    ]


def last_meet(form: Form) -> list[Step]:
    """Axes 2 and 3 meet."""
    (c1, s1), (ca1, sa1), (ca2, sa2) = (form.cos(1), form.sin(1)), form.twist(1), form.twist(2)
    a1, d2 = symbol("a_1"), symbol("d_2")
    c3, s3 = form.cos(3), form.sin(3)
    out = -sa1 * d2
    x, y = turned_by_two(form)
    return [
        Step(
            "$t_1$",
            2,
            "subproblem 3",
            "Joints 2 and 3 do not move the point where their axes meet, so the distance of the wrist "
            "from it is constant. This gives an equation in $t_1$ alone.",
            (
                Equation(
                    sum_squares(px, py, pz, a1, d2) - 2.0 * ca1 * d2 * pz,
                    sum_squares(wx, wy, wz)
                    + 2.0 * (a1 * px + out * py) * c1
                    + 2.0 * (a1 * py - out * px) * s1,
                    unit="m²",
                ),
            ),
        ),
        Step(
            "$t_3$",
            2,
            "subproblem 4",
            "Joint 2 does not change heights along its axis: that of the wrist, known in front of it, "
            "fixes $t_3$.",
            (
                *in_frame_one(form),
                define("z", ca1 * pz - sa1 * (c1 * py - s1 * px) - d2, "m"),
                Equation(symbol("z"), ca2 * wz + sa2 * (s3 * wx + c3 * wy), unit="m"),
            ),
        ),
        Step(
            "$t_2$",
            1,
            "subproblem 1",
            "The bearing of the wrist about axis 2 gives the remaining angle.",
            (
                *behind_joint_two(form, a2=False),
                Equation(symbol("x"), x, unit="m"),
                Equation(symbol("y"), y, unit="m"),
            ),
        ),
    ]


def first_parallel(form: Form) -> list[Step]:
    """Axes 1 and 2 parallel."""
    ca2, sa2 = form.twist(2)
    a1, c3, s3 = symbol("a_1"), form.cos(3), form.sin(3)
    x, _ = turned_by_two(form)
    return [
        Step(
            "$t_3$",
            2,
            "subproblem 4",
            "Joints 1 and 2 do not change heights along their axes: that of the wrist depends on $t_3$ "
            "alone.",
            (Equation(pz, symbol("d_2") + ca2 * wz + sa2 * (s3 * wx + c3 * wy), unit="m"),),
        ),
        Step(
            "$t_2$",
            2,
            "subproblem 3",
            "The distance of the wrist from axis 1 gives the elbow angle between the two parallel axes.",
            (
                *behind_joint_two(form),
                Equation(sum_squares(px, py), sum_squares(a1, vx, vy) + 2.0 * a1 * x, unit="m²"),
            ),
        ),
        pan_step(form),
    ]


def any_three(form: Form) -> list[Step]:
    """Three axes in general position."""
    ca1, sa1 = form.twist(1)
    a1 = symbol("a_1")
    x, y = turned_by_two(form)
    v2, p2 = sum_squares(vx, vy, vz), sum_squares(px, py, pz)
    k, m, n = symbol("k"), symbol("m"), 4.0 * a1 * a1
    return [
        Step(
            "$t_3$",
            4,
            "subproblem 5",
            "The distance from the foot of axis 1 and the height along it are two equations, linear in "
            "cosine and sine of $t_2$. Their squares add up to one without $t_2$: a quartic in "
            "$\\tan(t_3/2)$ (Pieper 1968).",
            (
                *behind_joint_two(form),
                define("k", p2 - a1 * a1 - v2, "m²"),
                define("m", pz - ca1 * vz, "m"),
                Equation(sa1 * sa1 * k * k + n * m * m, n * sa1 * sa1 * sum_squares(vx, vy), unit="m⁴"),
            ),
        ),
        Step(
            "$t_2$",
            1,
            "subproblem 1",
            "The same two equations, with $t_3$ known.",
            (
                Equation(p2, a1 * a1 + v2 + 2.0 * a1 * x, unit="m²"),
                Equation(pz, ca1 * vz + sa1 * y, unit="m"),
            ),
        ),
        pan_step(form),
    ]


def turn_steps(form: Form, before: int, sum_of: tuple[int, ...]) -> list[Step]:
    """The wrist: t_5, then the angle (or sum of angles) in front of it, then t_6.

    before: how many joints turn in front of the wrist's own rotation M. sum_of: the joints whose angles add
    up to the first angle of the wrist.
    """
    M = form.turned_goal(before)
    turns = [form.about_z(i) for i in sum_of]
    wrist = Product((*turns, form.about_x(4), form.about_z(5), form.about_x(5), form.about_z(6))).matrix()
    name = "t_" + (str(sum_of[0]) if len(sum_of) == 1 else "{" + "".join(map(str, sum_of)) + "}")
    total = " + ".join(f"t_{i}" for i in sum_of)
    angle = f"${name}$" if len(sum_of) == 1 else f"${name} = {total}$"
    front = form.seen_from(before).latex().replace(r" \, ", " ")

    def entry(i: int, j: int) -> Equation:
        return define(f"m_{i}{j}", M[i - 1, j - 1])

    def equals(i: int, j: int) -> Equation:
        return Equation(symbol(f"m_{i}{j}"), wrist[i - 1, j - 1])

    return [
        Step(
            "$t_5$",
            2,
            "subproblem 4",
            f"The remaining orientation, $M = ({front})^T R$, is the rotation of the wrist. Its third "
            "diagonal entry, the cosine between axes 4 and 6, depends only on $t_5$.",
            (entry(3, 3), equals(3, 3)),
        ),
        Step(
            angle,
            1,
            "subproblem 1",
            "The third column of $M$ is the direction of axis 6.",
            (entry(1, 3), entry(2, 3), equals(1, 3), equals(2, 3)),
        ),
        Step(
            "$t_6$",
            1,
            "subproblem 1",
            "The third row of $M$ is the direction of axis 4, seen from the tip.",
            (entry(3, 1), entry(3, 2), equals(3, 1), equals(3, 2)),
        ),
    ]
