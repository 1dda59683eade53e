"""The conditions of closed forms on the axes of an arm, measured, and the reason if an arm has none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import CspaceError
from cspace.kinematics import KinematicModel
from cspace.tables import show_fields


class NoClosedFormError(CspaceError, NotImplementedError):
    """No geometry that this version solves fits the arm; the message lists the conditions that failed."""


@show_fields
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


def arm_length(robot: KinematicModel) -> float:
    """The scale of tolerances [m]: the longest way from axis to axis, or to the tip; 1 if all meet."""
    points = np.vstack([robot.chain.points, robot.chain.T_zero[:3, 3]])
    axes = robot.chain.axes
    steps = [np.linalg.norm(np.cross(points[i + 1] - points[i], axes[i])) for i in range(len(axes))]
    return float(max(steps)) or 1.0


def measure_conditions(robot: KinematicModel) -> tuple[Condition, ...]:
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


def best_conditioning(robot: KinematicModel) -> float:
    """The best smallest singular value of the Jacobian at some configurations (lengths over the arm's)."""
    n = len(robot.chain.axes)
    steps = np.arange(1, 9)[:, None] * np.sqrt([2.0, 3.0, 5.0, 7.0, 11.0, 13.0])[:n]
    q = 2 * np.pi * (steps - np.floor(steps)) - np.pi
    slides = np.array([kind == "P" for kind in robot.chain.joint_types])
    J = np.array(robot.jacobian(np.where(slides, arm_length(robot), 1) * q))
    J[:, :3] /= arm_length(robot)
    J[..., slides] *= arm_length(robot)
    return float(np.linalg.svd(J, compute_uv=False)[:, -1].max())


def explain_missing_form(robot: KinematicModel) -> str:
    """The first reason why `robot` has no closed form, as a sentence."""
    kinds = robot.chain.joint_types
    count = "1 joint" if len(kinds) == 1 else f"{len(kinds)} joints"
    subject = f"no closed form for {robot.name} ({f'{kinds}, ' if kinds else ''}{count})"
    if robot.chain.dof != len(kinds):
        return f"{subject}: mimic joints are not supported; robot.ik_numeric(T) finds one configuration"
    if not kinds:
        return f"{subject}: no joint moves"
    if robot.floating:
        return f"{subject}: its base is floating; load the robot without floating=True"
    if len(kinds) > 16:
        return f"{subject}: arms with up to sixteen joints are supported"
    best = best_conditioning(robot)
    if best < _core.AXIS_RELATION:
        return (
            f"{subject}: every configuration is singular, because two joints have the same effect (the "
            "largest "
            f"smallest singular value of the Jacobian is {best:.2g}); lock one joint"
        )
    if "P" in kinds:
        return f"{subject}: it has prismatic joints"
    tested = "; ".join(str(c) for c in measure_conditions(robot) if not c.holds)
    return (
        f"{subject}: the first or last three axes must meet in a point, or three adjacent axes must be "
        f"parallel. {tested}"
    )
