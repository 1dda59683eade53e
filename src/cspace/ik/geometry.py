"""What the axes of an arm share, and which closed form follows from it (Pieper 1968)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.ik.conditions import Condition, NoClosedFormError, explain_missing_form, measure_conditions
from cspace.ik.solver import HasSolver, Solver, as_solver
from cspace.kinematics import KinematicModel
from cspace.tables import show_fields
from cspace.tolerances import ROUNDED_AXES

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
PIEPER_CASES = {
    0: "axes 2 and 3 parallel",
    1: "axes 1 and 2 meet",
    2: "axes 2 and 3 meet",
    3: "axes 1 and 2 parallel",
    4: "three axes in general position (a quartic)",
}
GENERAL = "Every solution comes from the general method: one joint's angle as the root of a determinant"

ROUNDED = (
    "; its axes are off by {:.1e}, as where a file rounds right angles: load_robot(…, right_angles=1e-5)"
    " makes these exact"
)


@show_fields
@dataclass(frozen=True)
class Geometry:
    """The closed form of an arm, truthy if it has one. family: its name, "general" for six joints that are
    solved without one, or "none"; detail: the case within it; reversed: read
    from the tip; idealised: by how much the form differs from the true axes (m over the arm's length,
    rad), corrected by a
    Newton step where it matters; conditions: what was tested; reason: why there is no form, as a sentence.
    """

    family: str
    detail: str
    reversed: bool
    idealised: float
    conditions: tuple[Condition, ...]
    reason: str = ""

    def __bool__(self) -> bool:
        return self.family not in ("none", "general")

    def __str__(self) -> str:
        if not self:
            return self.reason
        end = ", read from the tip" if self.reversed else ""
        rounded = ROUNDED.format(self.idealised) if self.idealised > ROUNDED_AXES else ""
        return f"{self.family} ({self.detail}{end}){rounded}"


def geometry(robot: HasSolver) -> Geometry:
    """The closed form of a Robot or a Solver, or why there is none.

    Raises InputTypeError for what is neither.
    """
    try:
        solver = as_solver(robot)
    except NoClosedFormError as error:
        model = cast(KinematicModel, robot)
        tested = measure_conditions(model) if len(model.chain.axes) >= 3 else ()
        return Geometry("none", "", False, 0.0, tested, str(error))
    tested = measure_conditions(solver) if len(solver.chain.axes) >= 3 else ()
    if solver.is_redundant:
        return redundant_geometry(solver, tested)
    seen = _core._ik_geometry(solver)
    if seen["general"]:
        return Geometry("general", "", False, 0.0, tested, f"{explain_missing_form(solver)}. {GENERAL}")
    if seen["family"] < 0:
        shared = PIEPER_CASES.get(seen["pieper_case"], "up to three joints")
        return Geometry("fewer than six joints", f"{solver.joint_types}, {shared}", False, 0.0, tested)
    family = FAMILIES[seen["family"]]
    detail = PIEPER_CASES[seen["pieper_case"]] if seen["family"] == 1 else PARALLEL[seen["family"]]
    if seen["virtual_joints"]:
        n = seen["virtual_joints"]
        detail += f"; completed to six by {n} joint{'s' * (n > 1)} locked at zero"
    return Geometry(family, detail, bool(seen["reversed"]), float(seen["deviation"]), tested)


def redundant_geometry(solver: Solver, tested: tuple[Condition, ...]) -> Geometry:
    """Of an arm with redundant joints: which of them are locked, and how the others are solved."""
    if not solver.redundant_joints:
        detail = "no closed form, and the general method finds no good condition: descents from many starts"
        return Geometry("redundant", detail, False, 0.0, tested)
    names = ", ".join(solver.joint_names[k] for k in solver.redundant_joints)
    closed = _core._ik_has_closed_form(solver)
    method = "a closed form of the others" if closed else "the general method for the others"
    return Geometry("redundant", f"{names} locked, {method}", False, 0.0, tested)


def as_arrays(value: Any) -> Any:
    """The numbers of a plan as arrays: poses (4, 4) and vectors (3,)."""
    if not isinstance(value, dict):
        return [as_arrays(entry) for entry in value] if isinstance(value, list) else value
    keys = set(value)
    if keys == {"R", "t"}:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = value["R"]["m"], as_arrays(value["t"])
        return T
    if keys == {"x", "y", "z"}:
        return np.array([value["x"], value["y"], value["z"]])
    return {key: as_arrays(entry) for key, entry in value.items()}
