"""Seven joints with a spherical shoulder and a spherical wrist, by the swivel of the elbow: the steps of
include/cspace/ik/redundancy/arm_angle.hpp.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.ik.conditions import common_point
from cspace.ik.explain.few_joints import goal_turns, rotation_steps
from cspace.ik.explain.findings import Step
from cspace.ik.explain.screws import (
    dot_product,
    goal_values,
    joint_values,
    number_vector,
    symbol_vector,
    turn_direction,
    vector_text,
)
from cspace.ik.redundancy.arm_angle import swivel
from cspace.ik.solver import Solver
from cspace.math import Equation, TrigPolynomial
from cspace.model import Chain
from cspace.spatial import exp_so3

SHOULDER, ELBOW, WRIST = (0, 1, 2), 3, (4, 5, 6)


def points_of(chain: Chain) -> tuple[Array, Array, Array]:
    """S, E, W at zero, (3,) each [m]."""
    S = common_point(chain.axes[:3], chain.points[:3])[0]
    W = common_point(chain.axes[4:], chain.points[4:])[0]
    h = chain.axes[ELBOW]
    E = chain.points[ELBOW] + ((S - chain.points[ELBOW]) @ h) * h
    return S, E, W


def swivel_steps(chain: Chain) -> tuple[Step, ...]:
    """Wrist, elbow, the plane of the arm, then both spherical joints."""
    S, E, W = points_of(chain)
    p, l = symbol_vector("p"), symbol_vector("l")
    offset = goal_turns((np.linalg.inv(chain.T_zero) @ np.append(W, 1.0))[:3])
    to_wrist = tuple(
        Equation.definition(f"l_{axis}", p[k] + offset[k] - float(S[k]), "m") for k, axis in enumerate("xyz")
    )
    bent = turn_direction(chain, ELBOW, number_vector(W - E))
    square = sum((each * each for each in l), TrigPolynomial())
    reach = 2.0 * dot_product(E - S, bent) + float((E - S) @ (E - S) + (W - E) @ (W - E))
    return (
        Step(
            "$l$",
            f"The shoulder S = ({vector_text(S)}) m, where axes 1, 2 and 3 meet, stays where it is; the "
            "wrist W, where axes 5, 6 and 7 meet, stands still in the tip, so the goal fixes it. $l$ leads "
            "from S to W.",
            to_wrist,
        ),
        Step(
            "$t_4$",
            "Joints 1 to 3 and 5 to 7 do not change the distance from S to W. With the elbow E, the point of "
            f"axis 4 nearest to S, ({vector_text(E)}) m at zero, it depends on $t_4$ alone. The $t_i$ are "
            "the joints' own angles here.",
            (Equation(square, reach, unit="m²"),),
            method="subproblem 3",
            ways=2,
        ),
        Step(
            "$K$",
            "The triangle S, E, W is rigid now and may turn about $l$: that is the freedom. `swivel=` gives "
            "it: the angle about $l$ from the half-plane through the direction of axis 1 to the one through "
            "E. $K$, the rotation of joints 1 to 3, takes the triangle to its place.",
            method="given",
        ),
        *ball_steps(chain, SHOULDER, "K", "$K$ is made by joints 1 to 3."),
        *ball_steps(
            chain,
            WRIST,
            "M",
            "$M$, what $K$ and joint 4 leave of the orientation of the goal, is made by joints 5 to 7.",
        ),
    )


def ball_steps(chain: Chain, joints: tuple[int, int, int], name: str, words: str) -> list[Step]:
    """Three axes through a point make a rotation whose entries are symbols."""
    i, j, k = (joint + 1 for joint in joints)
    entries = [[TrigPolynomial.symbol(f"{name.lower()}_{a}{b}") for b in (1, 2, 3)] for a in (1, 2, 3)]
    ahead = [dot_product(chain.axes[k - 1], row) for row in entries]
    behind = [dot_product(chain.axes[i - 1], list(column)) for column in zip(*entries, strict=True)]
    angle = f"{words} The angle between axis {i} and where it takes axis {k} depends on $t_{j}$ alone."
    onto = f"Where ${name}$ takes axis {k}.", f"Where ${name}^T$ takes axis {i}."
    return rotation_steps(chain, joints, ahead, behind, (angle, *onto))


def swivel_values(solver: Solver, q: Array, T: Array) -> dict[str, Any]:
    """The numeric values of angles, goal, K and M; K from the swivel, not from the joints that make it.

    Where the wrist lies on axis 1 there is no half-plane to measure from, and the numbers are NaN.
    """
    chain = solver.chain
    S, E, W = points_of(chain)
    in_tip = np.linalg.inv(chain.T_zero) @ np.append(W, 1.0)
    l = (T @ in_tip)[..., :3] - S
    R4 = exp_so3(chain.axes[ELBOW] * q[..., ELBOW, None])
    bent = E - S + R4 @ (W - E)
    here = frame_towards(bent, np.broadcast_to(E - S, bent.shape))
    K = frame_at(chain.axes[0], l, swivel(solver, q)) @ np.swapaxes(here, -1, -2)
    M = np.swapaxes(K @ R4, -1, -2) @ T[..., :3, :3] @ chain.T_zero[:3, :3].T
    out = joint_values(chain.joint_types, q) | goal_values(T)
    for name, R in (("k", K), ("m", M)):
        out |= {f"{name}_{i + 1}{j + 1}": R[..., i, j] for i in range(3) for j in range(3)}
    return out


def frame_towards(along: Array, e: Array) -> Array:
    """Frames (..., 3, 3): the first axis along a vector, the second towards e."""
    n = along / np.linalg.norm(along, axis=-1, keepdims=True)
    u = e - np.sum(e * n, axis=-1, keepdims=True) * n
    u = u / np.linalg.norm(u, axis=-1, keepdims=True)
    return np.stack([n, u, np.cross(n, u)], axis=-1)


def frame_at(reference: Array, l: Array, psi: Array) -> Array:
    """The frame along l whose second axis stands at a swivel."""
    zero = frame_towards(l, np.broadcast_to(reference, l.shape))
    c, s = np.cos(psi), np.sin(psi)
    u = c[..., None] * zero[..., 1] + s[..., None] * zero[..., 2]
    return np.stack([zero[..., 0], u, np.cross(zero[..., 0], u)], axis=-1)
