"""Denavit–Hartenberg tables derived from any serial chain, mechanically."""

from __future__ import annotations

import math

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputTypeError
from cspace.model.chain import Chain
from cspace.model.dh import DHTable, check_convention, dh_matrix
from cspace.model.values import freeze_array
from cspace.spatial.poses import invert_pose
from cspace.tolerances import DH_COINCIDENT, DH_PARALLEL

Row = tuple[float, float, float, float]

ROUNDING = 8.0 * 2.0**-52
"""How much of the longest link a product of two matrices may lose."""


def to_dh(chain: Chain, *, convention: str) -> DHTable:
    """The Denavit–Hartenberg table of a chain by the common normals of consecutive axes.

    Axis i is z of the frame on it, x_i points along the common normal from axis i to axis i+1, so a ≥ 0.
    The two conventions hold the same numbers: a standard row has (α, a) of link i, a modified row those of
    link i−1. Where the normal is a choice:

    - parallel axes: the normal through the origin of the frame before, so d = 0;
    - intersecting axes: of the two normals the one nearer to the x before (|θ offset| ≤ 90°); a = 0;
    - axes on one line: x stays as it was; a = d = 0;
    - first axis: frame 0 is the base if the first axis is its z; else it stands on the first axis at the
      foot of the perpendicular from the base origin, x as near to x of the base as it can be (y if that is
      along the axis). Row 1 of a modified table then has α = a = 0;
    - last frame: z of the tip serves as axis n+1, and d reaches the tip where it is parallel to axis n;
      on one line with it, x is that of the tip. What remains goes into T_tool;
    - prismatic joints have a direction and no place; the axis passes through the point of the chain.

    Axes within tolerances.DH_PARALLEL of parallel are taken as parallel, since their true normal is far away;
    `deviation` of the table bounds the error in metres. Raises UnknownNameError for another convention.
    Source: Denavit, Hartenberg 1955; choices as in Craig 1986, section 3.4, and Spong, Hutchinson, Vidyasagar
    2006, section 3.2.
    """
    check_convention(convention)
    if not isinstance(chain, Chain):
        raise InputTypeError(
            f"to_dh takes a Chain, got {type(chain).__name__}; a robot has robot.to_dh() and robot.chain"
        )
    n = len(chain.joint_types)
    T_base = _first_frame(chain)
    frame = T_base
    rows: list[Row] = []
    frames = []
    for i in range(n):
        frames.append(frame)
        to_frame = invert_pose(frame)
        if i + 1 < n:
            direction = to_frame[:3, :3] @ chain.axes[i + 1]
            row = _row(direction, to_frame[:3, :3] @ chain.points[i + 1] + to_frame[:3, 3])
        else:
            row = _last_row(to_frame @ chain.T_zero)
        rows.append(row)
        frame = frame @ dh_matrix(*row, convention="standard")
    table = np.array(rows).reshape(n, 4)
    T_tool = invert_pose(frame) @ chain.T_zero
    if convention == "modified" and n:
        last_link = dh_matrix(table[-1, 0], table[-1, 1], 0.0, 0.0, convention="standard")
        T_tool = last_link @ T_tool
        table[:, :2] = np.vstack([[0.0, 0.0], table[:-1, :2]])
    bound = _deviation(chain, frames) + ROUNDING * n * float(np.abs(table[:, 1:3]).max(initial=0.0))
    (alpha, a, d, theta), types, names = table.T, chain.joint_types, chain.joint_names
    return DHTable(convention, alpha, a, d, theta, types, T_base, T_tool, names, bound)


def _first_frame(chain: Chain) -> Array:
    """Frame 0: z along the first axis."""
    if not chain.joint_types:
        return freeze_array(np.eye(4))
    axis, point = chain.axes[0], chain.points[0]
    foot = point - axis * (axis @ point)
    upright = math.hypot(axis[0], axis[1]) <= DH_PARALLEL and axis[2] > 0.0
    if upright and np.linalg.norm(foot) <= DH_COINCIDENT:
        return freeze_array(np.eye(4))
    x, y = (guide - axis * (axis @ guide) for guide in np.eye(3)[:2])
    x = x if np.linalg.norm(x) > DH_PARALLEL else y
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3] = np.column_stack([x, np.cross(axis, x), axis, foot])
    return freeze_array(frame)


def _row(direction: Array, point: Array) -> Row:
    """(α, a, d, θ) of the standard row that leads from a frame to the line `point` + t·`direction`.

    In the frame, the line of A = Rz(θ) Tz(d) Tx(a) Rx(α) has the direction (sθ sα, −cθ sα, cα).
    """
    ux, uy, uz = direction.tolist()
    px, py, pz = point.tolist()
    across = math.hypot(ux, uy)
    if across <= DH_PARALLEL:
        distance = math.hypot(px, py)
        coincident = distance <= DH_COINCIDENT
        theta = 0.0 if coincident else math.atan2(py, px)
        return (0.0 if uz > 0.0 else math.pi), 0.0 if coincident else distance, 0.0, theta
    alpha, theta = math.atan2(across, uz), math.atan2(ux, -uy)
    a = (px * -uy + py * ux) / across
    d = pz - uz * (px * ux + py * uy) / across**2
    meet = abs(a) <= DH_COINCIDENT
    a = 0.0 if meet else a
    if (meet and abs(theta) > math.pi / 2 * (1 + DH_PARALLEL)) or a < 0.0:
        alpha, a, theta = -alpha, abs(a), theta - math.copysign(math.pi, theta)
    return alpha, a, d, theta


def _last_row(tip: Array) -> Row:
    """The row that leads from the last axis to the tip `tip` (4, 4), as near as a row can."""
    alpha, a, d, theta = _row(tip[:3, 2], tip[:3, 3])
    if math.hypot(tip[0, 2], tip[1, 2]) <= DH_PARALLEL:
        d = float(tip[2, 3])
        if a == 0.0:
            theta = math.atan2(tip[1, 0], tip[0, 0])
    return alpha, a, d, theta


def _deviation(chain: Chain, frames: list[Array]) -> float:
    """A bound [m] on how far snapped axes carry the tip: Σ 2 (offset + angle · reach beyond)."""
    total = 0.0
    reach = 0.0
    beyond = chain.T_zero[:3, 3]
    links = list(zip(chain.axes, chain.points, chain.joint_types, frames, strict=True))
    for axis, point, kind, frame in reversed(links):
        reach += float(np.linalg.norm(beyond - point))
        beyond = point
        angle = float(np.linalg.norm(np.cross(frame[:3, 2], axis)))
        gap = np.cross(frame[:3, 3] - point, axis)
        offset = float(np.linalg.norm(gap)) if kind == "R" else 0.0
        total += 2.0 * (offset + angle * reach)
    return total
