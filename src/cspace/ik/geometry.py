"""What the axes of an arm share, and which closed form follows from it (Pieper 1968)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import CspaceError

__all__ = ["Condition", "Geometry", "NoClosedFormError", "geometry"]

FAMILIES = {
    0: "none",
    1: "spherical wrist",
    2: "three parallel axes",
    3: "three parallel axes",
    4: "three parallel axes",
}
PARALLEL = {
    2: "axes 2, 3, 4; axes 5 and 6 meet",
    3: "axes 2, 3, 4; axes 5 and 6 apart (a quartic)",
    4: "axes 1, 2, 3 (a quartic)",
}
FIRST_THREE = {
    0: "axes 2 and 3 parallel",
    1: "axes 1 and 2 meet",
    2: "axes 2 and 3 meet",
    3: "axes 1 and 2 parallel",
    4: "three axes in general position (a quartic)",
}


class NoClosedFormError(CspaceError, NotImplementedError):
    """The arm has none of the geometries that this version solves; the message lists the conditions that
    failed.
    """


@dataclass(frozen=True)
class Condition:
    """One geometric condition: what it says, whether it holds, the measured miss and its limit [rad or m]."""

    text: str
    holds: bool
    measured: float
    allowed: float
    unit: str

    def __str__(self) -> str:
        verdict = "holds" if self.holds else "fails"
        return f"{self.text}: {verdict} (off by {self.measured:.3g} {self.unit}, allowed {self.allowed:.3g})"


@dataclass(frozen=True)
class Geometry:
    """The closed form of an arm. family: its name or "none"; detail: the case within it; reversed: read
    from the tip; idealised: by how much the form differs from the true axes (m over the arm's length,
    rad), corrected by a
    Newton step where it matters; conditions: what was tested."""

    family: str
    detail: str
    reversed: bool
    idealised: float
    conditions: tuple[Condition, ...]

    def __bool__(self) -> bool:
        return self.family != "none"

    def __str__(self) -> str:
        if not self:
            return "no closed form: " + "; ".join(str(c) for c in self.conditions)
        end = ", read from the tip" if self.reversed else ""
        return f"{self.family} ({self.detail}{end})"


def angle_between(h1: Array, h2: Array) -> float:
    """The angle between two lines [rad], 0 to π/2."""
    return float(np.arctan2(np.linalg.norm(np.cross(h1, h2)), abs(h1 @ h2)))


def common_point(axes: Array, points: Array) -> tuple[Array, float]:
    """The point nearest to some lines (least squares), and its largest distance from one [m]."""
    projectors = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    A, b = projectors.sum(axis=0), np.einsum("nij,nj->i", projectors, points)
    p = np.linalg.lstsq(A, b, rcond=None)[0]
    away = np.einsum("nij,nj->ni", projectors, p - points)
    return cast(Array, p), float(np.linalg.norm(away, axis=1).max())


def arm_length(robot: Any) -> float:
    """The longest distance between neighbouring axes or to the tip [m], 1 if all meet; the scale of
    tolerances.
    """
    points = np.vstack([robot.chain.points, robot.chain.T_zero[:3, 3]])
    axes = robot.chain.axes
    steps = [np.linalg.norm(np.cross(points[i + 1] - points[i], axes[i])) for i in range(len(axes))]
    return float(max(steps)) or 1.0


def conditions(robot: Any) -> tuple[Condition, ...]:
    """Every condition that a closed form could rest on, measured."""
    axes, points = robot.chain.axes, robot.chain.points
    allowed = _core.AXIS_RELATION * arm_length(robot)
    out = []
    for first in range(len(axes) - 2):
        three = slice(first, first + 3)
        names = f"axes {first + 1}, {first + 2}, {first + 3}"
        away = common_point(axes[three], points[three])[1]
        out.append(Condition(f"{names} meet in a point", away <= allowed, away, allowed, "m"))
        bent = max(
            angle_between(axes[first], axes[first + 1]), angle_between(axes[first + 1], axes[first + 2])
        )
        out.append(
            Condition(f"{names} are parallel", bent <= _core.AXIS_RELATION, bent, _core.AXIS_RELATION, "rad")
        )
    return tuple(out)


def best_conditioning(robot: Any) -> float:
    """The largest, over some configurations, of the Jacobian's smallest singular value (lengths over the
    arm's length).
    """
    n = len(robot.chain.axes)
    steps = np.arange(1, 9)[:, None] * np.sqrt([2.0, 3.0, 5.0, 7.0, 11.0, 13.0])[:n]
    J = np.array(robot.jacobian(2 * np.pi * (steps - np.floor(steps)) - np.pi))
    J[:, :3] /= arm_length(robot)
    return float(np.linalg.svd(J, compute_uv=False)[:, -1].max())


def explain_missing_form(robot: Any) -> str:
    kinds = robot.chain.joint_types
    subject = f"no closed form for {robot.name} ({kinds}, {len(kinds)} joints)"
    if robot.chain.dof != len(kinds):
        return f"{subject}: joints that mimic others are not solved by this version"
    if not kinds:
        return f"{subject}: no joint moves"
    if "P" in kinds:
        return f"{subject}: arms with prismatic joints are not solved by this version"
    if len(kinds) > 6:
        return f"{subject}: this version solves full poses for four to six revolute joints"
    best = best_conditioning(robot)
    if best < _core.AXIS_RELATION:
        return (
            f"{subject}: every configuration is singular, two of its joints do one's work (the Jacobian's "
            f"smallest singular value is {best:.2g} at best); hold one joint still"
        )
    tested = "; ".join(str(c) for c in conditions(robot) if not c.holds)
    return (
        f"{subject}: it needs the first or last three axes to meet in a point, or three neighbouring axes "
        f"to be parallel. {tested}"
    )


def geometry(robot: Any) -> Geometry:
    """The closed form that serves `robot`, or which conditions failed."""
    from cspace.ik.solve import prepare

    tested = conditions(robot) if len(robot.chain.axes) >= 3 else ()
    try:
        prepare(robot)
    except NoClosedFormError:
        return Geometry("none", "", False, 0.0, tested)
    seen = _core._ik_geometry(robot)
    if seen["family"] < 0:
        shared = FIRST_THREE.get(seen["first_three"], "up to three joints")
        return Geometry("short arm", f"{robot.chain.joint_types}, {shared}", False, 0.0, tested)
    family = FAMILIES[seen["family"]]
    detail = FIRST_THREE[seen["first_three"]] if seen["family"] == 1 else PARALLEL[seen["family"]]
    if seen["virtual_joints"]:
        detail += f"; completed to six by {seen['virtual_joints']} joints held at zero"
    return Geometry(family, detail, bool(seen["reversed"]), float(seen["deviation"]), tested)
