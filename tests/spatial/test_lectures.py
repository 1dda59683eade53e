"""The worked examples of the lectures on displacements, with their printed numbers."""

from collections import Counter
from itertools import product

import numpy as np

import cspace as cs
from spatial.draws import close


def test_planar_frames_there_and_back():
    T_A_B = cs.pose_2d((-1.0, 0.0), theta=np.pi / 2)
    T_B_A = cs.inverse_pose_2d(T_A_B)
    close(T_A_B, [[0, -1, -1], [1, 0, 0], [0, 0, 1]])
    close(T_B_A, [[0, 1, 0], [-1, 0, -1], [0, 0, 1]])
    close(T_A_B @ T_B_A, np.eye(3))


def test_one_matrix_read_three_ways():
    T = cs.pose_2d((-1.0, 0.0), theta=np.pi / 2)
    p = np.array([2.0, 1.0])
    close(cs.transform_points_2d(T, p), [-2.0, 2.0])
    turned_then_moved = cs.rotation_2d(np.pi / 2) @ p + [-1.0, 0.0]
    close(cs.transform_points_2d(T, p), turned_then_moved)
    origin, x_axis, y_axis = T[:2, 2], T[:2, 0], T[:2, 1]
    close(cs.transform_points_2d(T, p), origin + p[0] * x_axis + p[1] * y_axis)


def test_a_tip_turned_a_quarter_and_moved():
    for x1, y1, z1 in np.random.default_rng(1).normal(size=(5, 3)):
        T = cs.pose((x1, y1, z1), axis_angle=((0, 0, 1), np.pi / 2))
        close(T, [[0, -1, 0, x1], [1, 0, 0, y1], [0, 0, 1, z1], [0, 0, 0, 1]])


def test_every_displacement_is_a_translation_or_a_turn_about_a_pole_or_a_screw():
    T_A_B = cs.pose_2d((-1.0, 0.0), theta=np.pi / 2)
    pole = cs.pole_of(T_A_B)
    close(pole.point, [-0.5, -0.5])
    close(pole.angle, np.pi / 2)
    assert not cs.pole_of(cs.pose_2d((3.0, 4.0)))
    screw = cs.screw_of(cs.pose((1.0, 0.0, 2.0), axis_angle=((0, 0, 1), np.pi / 2)))
    close(screw.axis, [0, 0, 1])
    close(screw.point, [0.5, 0.5, 0.0])
    close(screw.pitch, 2.0 / (np.pi / 2))
    close(screw.magnitude, np.pi / 2)


def symbol(name, sign=1):
    """A polynomial: how often each product of symbols is summed, the product written as a sorted tuple."""
    return Counter({(name,): sign})


def multiply(A, B):
    """The product of matrices of polynomials, exact."""
    C = [[Counter() for _ in B[0]] for _ in A]
    for i, j, k in product(range(len(A)), range(len(B[0])), range(len(B))):
        for (a, m), (b, n) in product(A[i][k].items(), B[k][j].items()):
            C[i][j][tuple(sorted(a + b))] += m * n
    return C


def turn(axis, angle):
    """The matrix of a turn about a coordinate axis in the symbols c‹angle› and s‹angle›."""
    zero, one, c = Counter(), Counter({(): 1}), symbol("c" + angle)
    R = [[one if i == j == axis else zero for j in range(3)] for i in range(3)]
    u, v = (axis + 1) % 3, (axis + 2) % 3
    R[u][u] = R[v][v] = c
    R[u][v], R[v][u] = symbol("s" + angle, -1), symbol("s" + angle)
    return R


def evaluate(matrix, values):
    return np.array(
        [
            [sum(n * np.prod([values[s] for s in term]) for term, n in e.items()) for e in row]
            for row in matrix
        ]
    )


PRINTED = [
    ["+cα cβ", "+cα sβ sγ -sα cγ", "+cα sβ cγ +sα sγ"],
    ["+sα cβ", "+sα sβ sγ +cα cγ", "+sα sβ cγ -cα sγ"],
    ["-sβ", "+cβ sγ", "+cβ cγ"],
]


def polynomial(text):
    terms = text.replace("+", "|+").replace("-", "|-").split("|")[1:]
    return Counter({tuple(sorted(t[1:].split())): 1 if t[0] == "+" else -1 for t in terms})


def test_fixed_axes_xyz_are_rz_ry_rx_symbol_by_symbol():
    R = multiply(multiply(turn(2, "α"), turn(1, "β")), turn(0, "γ"))
    assert [[polynomial(entry) for entry in row] for row in PRINTED] == R
    for gamma, beta, alpha in np.random.default_rng(2).uniform(-np.pi, np.pi, (20, 3)):
        values = {
            **{"cα": np.cos(alpha), "cβ": np.cos(beta), "cγ": np.cos(gamma)},
            **{"sα": np.sin(alpha), "sβ": np.sin(beta), "sγ": np.sin(gamma)},
        }
        expected = evaluate(R, values)
        close(cs.rotation(fixed=("XYZ", (gamma, beta, alpha))), expected)
        close(cs.rotation(euler=("ZYX", (alpha, beta, gamma))), expected)
        close(cs.rotation(rpy=(gamma, beta, alpha)), expected)
