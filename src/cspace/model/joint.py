"""Joints as data: what may move against what, about which axis and how far."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats, positive_number, warn_of_degrees
from cspace.errors import InputError, suggest
from cspace.model.values import (
    IDENTITY,
    X_AXIS,
    check_number,
    check_placement,
    finite_number,
    freeze_array,
    name_of,
    unit_axis,
)
from cspace.tables import align_cells, html_table, one_line, show_fields, shown
from cspace.tolerances import DEGREE_LIMITS

FREEDOMS: Final[dict[str, int]] = {
    "fixed": 0,
    "revolute": 1,
    "continuous": 1,
    "prismatic": 1,
    "helical": 1,
    "universal": 2,
    "cylindrical": 2,
    "planar": 3,
    "spherical": 3,
    "distance": 5,
    "floating": 6,
}
"""How many independent motions each kind of joint allows; "distance" is a rod with a ball at each end."""

JOINT_TYPES: Final = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
"""The joint types of a tree; loops may be closed by any of FREEDOMS."""

LIMIT_UNITS: Final = "limits [rad or m, s, N·m or N]"

LIMIT_FIELDS: Final = ("lower", "upper", "velocity", "acceleration", "jerk", "effort")
"""The limits of a joint, in the order of Limits."""

RESISTANCES: Final = ("damping", "friction", "armature")
"""What a joint itself opposes to motion."""


@show_fields
@dataclass(frozen=True)
class Mimic:
    """A joint that follows another: its value is multiplier · q(joint) + offset.

    joint: name of the joint that leads. multiplier: unitless (or m/rad, rad/m). offset: rad or m.
    """

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        name_of(self.joint, "joint to mimic")
        object.__setattr__(self, "multiplier", finite_number(self.multiplier, "mimic multiplier"))
        object.__setattr__(self, "offset", finite_number(self.offset, "mimic offset"))


@show_fields
@dataclass(frozen=True, eq=False)
class Joint:
    """A joint of the tree: the child link moves against the parent link.

    T_parent_child(q) = origin · motion(q), motion along or about `axis` in the joint frame.

    name, parent, child: the joint and the two links by name. type: one of JOINT_TYPES.
    origin (4, 4): joint frame in the parent link [m]. axis (3,): unit direction in the joint frame (the
    normal of a planar joint). lower, upper: range [rad or m], ±inf where unlimited. velocity [rad/s or
    m/s], acceleration, jerk, effort [N·m or N]: largest magnitudes, inf where unknown. damping [N·m·s/rad or
    N·s/m], friction [N·m or N]: as in URDF, None where unknown. armature: the inertia of the rotor as the
    joint feels it, n² J behind a gear of ratio n [kg·m² or kg], None where unknown. mimic: the joint it
    follows.

    Raises InputError for limits upside down, a zero axis, NaN, negative damping, friction or armature;
    UnknownNameError for an unknown type.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Array = field(default_factory=lambda: IDENTITY)
    axis: Array = field(default_factory=lambda: X_AXIS)
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    acceleration: float = math.inf
    jerk: float = math.inf
    effort: float = math.inf
    damping: float | None = None
    friction: float | None = None
    armature: float | None = None
    mimic: Mimic | None = None

    def __post_init__(self) -> None:
        name_of(self.name, "joint")
        subject = f"joint {self.name!r}"
        if self.type not in JOINT_TYPES:
            raise suggest("joint type", self.type, JOINT_TYPES, owner=subject)
        name_of(self.parent, f"parent link of {subject}")
        name_of(self.child, f"child link of {subject}")
        store = object.__setattr__
        store(self, "origin", check_placement(self.origin, f"origin of {subject}"))
        if self.type in ("fixed", "floating"):  # neither has an axis
            store(self, "axis", X_AXIS)
        elif self.axis is not X_AXIS:
            store(self, "axis", unit_axis(self.axis, f"axis of {subject}"))
        for name in LIMIT_FIELDS:
            store(self, name, check_number(getattr(self, name), f"{name} limit of {subject}"))
        for name in RESISTANCES:
            value = getattr(self, name)
            if value is not None:
                store(self, name, finite_number(value, f"{name} of {subject}"))
                if getattr(self, name) < 0.0:
                    raise InputError(f"{name} of {subject} is {value:g}; it must not be negative")
        self._check_limits(subject)

    def _check_limits(self, subject: str) -> None:
        lower, upper = self.lower, self.upper
        if lower > upper:
            raise InputError(f"limits of {subject} are reversed: lower {lower:g} is above upper {upper:g}")
        if lower == math.inf or upper == -math.inf:
            raise InputError(f"limits of {subject} allow no finite value: lower {lower:g}, upper {upper:g}")
        for name in LIMIT_FIELDS[2:]:
            value = getattr(self, name)
            if value < 0.0:
                raise InputError(f"{name} limit of {subject} is {value:g}; it must not be negative")

    @property
    def moving(self) -> bool:
        """Whether the joint moves at all."""
        return self.type != "fixed"

    @property
    def freedoms(self) -> int:
        """The independent motions it allows; a mimic joint adds none."""
        return 0 if self.mimic is not None else FREEDOMS[self.type]


@show_fields
@dataclass(frozen=True, eq=False)
class Loop:
    """A joint that closes a loop: it connects two links that the tree already contains.

    type: any key of FREEDOMS. origin (4, 4): joint frame in the parent link. child_origin (4, 4): joint frame
    in the child link. axis (3,): unit direction in the joint frame. second_axis (3,): of a universal joint
    the axis that is fixed to the child, in its joint frame; at right angles to the first one. length [m]: of
    a rod (type "distance"), from the origin of one joint frame to that of the other.

    Raises UnknownNameError for an unknown type; InputError for a zero axis, NaN, a rod without a positive
    length, and for a length or a second axis of another type.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Array = field(default_factory=lambda: IDENTITY)
    child_origin: Array = field(default_factory=lambda: IDENTITY)
    axis: Array = field(default_factory=lambda: X_AXIS)
    second_axis: Array | None = None
    length: float | None = None

    def __post_init__(self) -> None:
        subject = f"loop {name_of(self.name, 'loop')!r}"
        if self.type not in FREEDOMS:
            raise suggest("joint type", self.type, FREEDOMS, owner=subject)
        name_of(self.parent, f"parent link of {subject}")
        name_of(self.child, f"child link of {subject}")
        object.__setattr__(self, "origin", check_placement(self.origin, f"origin of {subject}"))
        object.__setattr__(
            self, "child_origin", check_placement(self.child_origin, f"child origin of {subject}")
        )
        object.__setattr__(self, "axis", unit_axis(self.axis, f"axis of {subject}"))
        if self.second_axis is not None:
            self._refuse_other("second_axis", "universal", subject)
            second = unit_axis(self.second_axis, f"second axis of {subject}")
            object.__setattr__(self, "second_axis", second)
        if self.length is not None:
            self._refuse_other("length", "distance", subject)
            length = positive_number(self.length, f"length of {subject}", "it must be above zero [m]")
            object.__setattr__(self, "length", length)
        elif self.type == "distance":
            raise InputError(f"{subject} is a rod without a length; give length= [m]")

    def _refuse_other(self, name: str, kind: str, subject: str) -> None:
        if self.type != kind:
            raise InputError(f"{subject} is {self.type}; {name}= is for loops of type {kind!r}")


@dataclass(frozen=True, eq=False)
class Limits:
    """The limits of all coordinates of a robot, each (dof,); ±inf where absent.

    lower, upper [rad or m], velocity [rad/s or m/s], acceleration, jerk, effort [N·m or N].
    Omitted fields are filled with infinities. Limits of many turns, which look like degrees, cause a warning.
    Raises InputError for different lengths, NaN, lower > upper.
    """

    lower: Array
    upper: Array
    velocity: Array = None  # type: ignore[assignment]
    acceleration: Array = None  # type: ignore[assignment]
    jerk: Array = None  # type: ignore[assignment]
    effort: Array = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        n = as_floats(self.lower, "lower limits", finite=False).size
        for name in LIMIT_FIELDS:
            object.__setattr__(self, name, limit_row(getattr(self, name), name, n))
        upside_down = np.flatnonzero(self.lower > self.upper)
        if upside_down.size:
            i = int(upside_down[0])
            raise InputError(
                f"limits of coordinate {i} are reversed:"
                f" lower {self.lower[i]:g} is above upper {self.upper[i]:g}"
            )
        if sys._getframe(2).f_globals.get("__name__", "").partition(".")[0] != "cspace":  # typed by a person
            values = np.concatenate([self.lower, self.upper])
            remedy = "np.radians converts them; of prismatic joints these are metres, not millimetres"
            warn_of_degrees("Limits", values, DEGREE_LIMITS, remedy)

    def __len__(self) -> int:
        return int(self.lower.size)

    @cached_property
    def range(self) -> Array:
        """lower and upper as rows, (2, dof)."""
        return freeze_array(np.array([self.lower, self.upper]))

    def __repr__(self) -> str:
        pairs = (f"{shown(a)} … {shown(b)}" for a, b in zip(self.lower, self.upper, strict=True))
        return one_line("Limits", f"of {len(self)} joints: " + ", ".join(pairs))

    def _cells(self) -> tuple[list[str], list[list[str]]]:
        """A row per coordinate; a dash for an absent limit, and no column without limits."""
        fields = {name: getattr(self, name) for name in LIMIT_FIELDS}
        always = ("lower", "upper")
        columns = {name: row for name, row in fields.items() if name in always or np.isfinite(row).any()}
        rows = [[str(i), *(shown(row[i]) for row in columns.values())] for i in range(len(self))]
        return ["i", *columns], rows

    def __str__(self) -> str:
        titles, rows = self._cells()
        return f"{LIMIT_UNITS}\n{align_cells([titles, *rows])}"

    def _repr_html_(self) -> str:
        return html_table(LIMIT_UNITS, *self._cells())

    @classmethod
    def of(cls, joints: tuple[Joint, ...] | list[Joint]) -> Limits:
        """The limits of one-freedom joints, in their order."""
        rows = ([getattr(joint, name) for joint in joints] for name in LIMIT_FIELDS)
        return cls(*(np.array(row, dtype=np.float64) for row in rows))


def limit_row(value: Any, name: str, n: int) -> Array:
    """The limits of n joints, read-only; infinite where the value is None."""
    if value is None:
        return freeze_array(np.full(n, np.inf))
    row = as_floats(value, f"{name} limits", finite=False)
    if row.shape != (n,):
        raise InputError(f"{name} limits have shape {row.shape}, expected ({n},)")
    if np.isnan(row).any():
        raise InputError(f"{name} limits contain NaN; use inf for an absent limit")
    return freeze_array(row.copy())
