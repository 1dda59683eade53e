"""Denavit–Hartenberg tables, standard and modified, and robots made from them."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_arrays, as_floats
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.math.wrapping import TURN
from cspace.model.description import Description
from cspace.model.joint import Joint
from cspace.model.link import Inertial, Link
from cspace.model.screws import check_joint_types, joint_rows, link_names, one_freedom_type
from cspace.model.values import IDENTITY, check_placement, check_size, freeze_array, read_joint_names
from cspace.tables import align_cells, markdown_table, one_line, shown

CONVENTIONS: Final = ("standard", "modified")
COLUMNS: Final = ("alpha", "a", "d", "theta")

Z_AXIS: Final[Array] = freeze_array(np.array([0.0, 0.0, 1.0]))


def check_convention(convention: object) -> str:
    """The convention if it is one of CONVENTIONS, else UnknownNameError."""
    if not isinstance(convention, str) or convention not in CONVENTIONS:
        raise suggest("Denavit–Hartenberg convention", convention, CONVENTIONS)
    return str(convention)


def dh_matrix(alpha: Any, a: Any, d: Any, theta: Any, *, convention: str) -> Array:
    """The transform of one row of a Denavit–Hartenberg table.

    standard: A_i = Rz(θ_i) Tz(d_i) Tx(a_i) Rx(α_i) =
        [cθ, −sθ cα, sθ sα, a cθ], [sθ, cθ cα, −cθ sα, a sθ], [0, sα, cα, d], with α, a of link i.
    modified: A_i = Rx(α_{i−1}) Tx(a_{i−1}) Rz(θ_i) Tz(d_i) =
        [cθ, −sθ, 0, a], [sθ cα, cθ cα, −sα, −d sα], [sθ sα, cθ sα, cα, d cα], with α, a of link i−1.

    alpha, theta [rad], a, d [m]: numbers or arrays (...). Returns (..., 4, 4).
    Raises UnknownNameError for another convention, InputError for NaN, inf and shapes that do not broadcast.
    Sources: Denavit, Hartenberg 1955; Craig 1986, section 3.4.
    """
    standard = check_convention(convention) == "standard"
    numbers = as_arrays({name: (x, ()) for name, x in zip(COLUMNS, (alpha, a, d, theta), strict=True)})
    alpha, a, d, theta = np.broadcast_arrays(*numbers.values())
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    zero, one = np.zeros_like(ca), np.ones_like(ca)
    if standard:
        rows = [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [zero, sa, ca, d]]
    else:
        rows = [[ct, -st, zero, a], [st * ca, ct * ca, -sa, -d * sa], [st * sa, ct * sa, ca, d * ca]]
    rows.append([zero, zero, zero, one])
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


@dataclass(frozen=True, eq=False)
class DHTable:
    """A serial arm as a Denavit–Hartenberg table.

    T_base_tip(q) = T_base · A_1(q_1) … A_n(q_n) · T_tool; A_i as in dh_matrix, with θ_i = theta_offset_i +
    q_i for a revolute joint and d_i = d_i + q_i for a prismatic one.

    convention: "standard" or "modified". alpha, a, d, theta_offset (n,): in row i of a modified table α and a
    belong to link i−1. joint_types: n letters "R", "P", or "F" for a row that never moves. T_base, T_tool
    (4, 4). deviation: bound [m] on how far the tip is from that of the robot the table was derived from.
    """

    convention: str
    alpha: Array
    a: Array
    d: Array
    theta_offset: Array
    joint_types: str
    T_base: Array = field(default_factory=lambda: IDENTITY)
    T_tool: Array = field(default_factory=lambda: IDENTITY)
    joint_names: Sequence[str] = ()
    deviation: float = 0.0

    def __post_init__(self) -> None:
        store = object.__setattr__
        store(self, "convention", check_convention(self.convention))
        n = np.asarray(self.alpha).size
        for column in ("alpha", "a", "d", "theta_offset"):
            values = as_floats(getattr(self, column), f"column {column}")
            if values.shape != (n,):
                raise InputError(f"column {column} has shape {values.shape}, expected ({n},)")
            store(self, column, freeze_array(check_size(values, f"column {column}").copy()))
        store(self, "joint_types", check_joint_types(self.joint_types, n, letters="RPF"))
        store(self, "T_base", check_placement(self.T_base, "T_base"))
        store(self, "T_tool", check_placement(self.T_tool, "T_tool"))
        numbered = tuple(f"joint_{i + 1}" for i in range(n))
        store(self, "joint_names", read_joint_names(self.joint_names or numbered, n))

    def __len__(self) -> int:
        return len(self.joint_types)

    @property
    def rows(self) -> Array:
        """The table (n, 4), columns alpha, a, d, theta offset."""
        return np.column_stack([self.alpha, self.a, self.d, self.theta_offset])

    def matrices(self, q: Any) -> Array:
        """The transforms A_i (..., n, 4, 4) at the values q (..., moving joints)."""
        moving = np.array([kind != "F" for kind in self.joint_types], dtype=bool)
        values = as_floats(q, "q", last=(int(moving.sum()),))
        full = np.zeros((*values.shape[:-1], len(self)))
        full[..., moving] = values
        turns = np.array([kind == "R" for kind in self.joint_types], dtype=bool)
        theta = self.theta_offset + np.where(turns, full, 0.0)
        d = self.d + np.where(turns, 0.0, full)
        return dh_matrix(self.alpha, self.a, d, theta, convention=self.convention)

    def fk(self, q: Any) -> Array:
        """The tip in the base, T_base · A_1 … A_n · T_tool, (..., 4, 4); q (..., moving joints)."""
        matrices = self.matrices(q)
        T = np.broadcast_to(self.T_base, (*matrices.shape[:-3], 4, 4))
        for i in range(len(self)):
            T = T @ matrices[..., i, :, :]
        return T @ self.T_tool

    def __repr__(self) -> str:
        return one_line("DHTable", f"of {len(self)} joints, {self.convention} convention")

    def _cells(self) -> list[list[str]]:
        """Titles and rows: degrees and metres, q for the joint variable."""
        indexed = ("α_i", "a_i") if self.convention == "standard" else ("α_i-1", "a_i-1")
        cells = [["i", "joint", f"{indexed[0]} [°]", f"{indexed[1]} [m]", "d_i [m]", "θ_i [°]"]]
        for i, (alpha, a, d, theta) in enumerate(self.rows.tolist()):
            kind = self.joint_types[i]
            shift, turn = shown(d), shown(np.degrees(theta))
            shift += f" + q{i + 1}" if kind == "P" else ""
            turn += f" + q{i + 1}" if kind == "R" else ""
            cells.append([str(i + 1), self.joint_names[i], shown(np.degrees(alpha)), shown(a), shift, turn])
        return cells

    def to_markdown(self) -> str:
        """The rows as a table in Markdown, then T_base and T_tool unless they are identities."""
        titles, *cells = self._cells()
        text = markdown_table(titles, cells) + "\n"
        for name, T in (("T_base", self.T_base), ("T_tool", self.T_tool)):
            if not np.array_equal(T, IDENTITY):
                rows = [list(map(shown, row)) for row in T.tolist()]
                text += f"\n{markdown_table([name, '', '', ''], rows)}\n"
        return text

    _repr_markdown_ = to_markdown

    def __str__(self) -> str:
        """The table as text: degrees and metres, q for the joint variable."""
        text = f"Denavit–Hartenberg, {self.convention}\n{align_cells(self._cells())}"
        for name, T in (("T_base", self.T_base), ("T_tool", self.T_tool)):
            if not np.array_equal(T, IDENTITY):
                text += f"\n{name}\n" + align_cells([["", *map(shown, row)] for row in T.tolist()])
        return text


def from_dh(
    table: Any,
    *,
    convention: str | None = None,
    joint_types: str | None = None,
    T_base: Any = None,
    T_tool: Any = None,
    lower: Any = None,
    upper: Any = None,
    velocity: Any = None,
    acceleration: Any = None,
    jerk: Any = None,
    effort: Any = None,
    damping: Sequence[float | None] | None = None,
    friction: Sequence[float | None] | None = None,
    armature: Sequence[float | None] | None = None,
    inertials: Sequence[Inertial | None] | None = None,
    name: str = "robot",
    joint_names: Sequence[str] | None = None,
    base: str = "base",
    tip: str = "tip",
) -> Description:
    """A serial robot from a Denavit–Hartenberg table.

    table: a DHTable, or rows (n, 4) in the order (alpha, a, d, theta) [rad, m, m, rad], or n mappings with
    these keys (absent ones count as 0). theta of a revolute row is the offset added to q, d of a prismatic
    row likewise. convention: "standard" or "modified", demanded for plain rows because the two are never
    told apart by the numbers. joint_types: n letters "R", "P" or "F" (fixed row), default all "R". T_base,
    T_tool (4, 4): before the first and after the last row. lower, upper, velocity, acceleration,
    jerk, effort (n,): limits. damping, friction, armature (n,): as in Joint. inertials (n,): the mass
    properties of link i in frame i of the table, as books print them (standard: at the far end of the link;
    modified: on its axis). None stands for an unknown number or body.
    Warns (UserWarning) if an angle of the rows exceeds 2π, since it is probably in degrees.
    Raises InputError for a wrong shape or NaN, UnknownNameError for another convention or column,
    InputTypeError for inertials that are none.
    """
    if isinstance(table, DHTable):
        dh = table
    else:
        if convention is None:
            raise InputError(
                "the convention of the table is missing; give convention='standard' or 'modified'"
            )
        rows = _rows(table)
        types = "R" * len(rows) if joint_types is None else joint_types
        before, after = (IDENTITY if T is None else T for T in (T_base, T_tool))
        alpha, a, d, theta = rows.T
        if np.abs(rows[:, [0, 3]]).max(initial=0.0) > TURN:
            text = "the table has angles beyond 2π: they are in radians; np.radians converts degrees"
            warnings.warn(text, stacklevel=2)
        dh = DHTable(convention, alpha, a, d, theta, types, before, after, joint_names or ())
    limits = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk, "effort": effort}
    n = len(dh)
    opposed = {"damping": damping, "friction": friction, "armature": armature}
    columns = {key: _one_per_row(values, key, n) for key, values in opposed.items()}
    values = [
        row | {key: column[i] for key, column in columns.items()}
        for i, row in enumerate(joint_rows(n, lower=lower, upper=upper, **limits))
    ]
    return _describe(dh, values, _bodies(inertials, n), name, base, tip)


def _one_per_row(values: Sequence[Any] | None, name: str, n: int) -> list[Any]:
    """The values as a list, one per row of the table; all None if there are none."""
    if values is None:
        return [None] * n
    given = list(values) if isinstance(values, Iterable) else [values]
    if len(given) != n:
        raise InputError(f"{name} has {len(given)} entries for {n} rows of the table; give one per row")
    return given


def _bodies(inertials: Sequence[Inertial | None] | None, n: int) -> list[Inertial | None]:
    """The mass properties per row, None where unknown."""
    bodies = _one_per_row(inertials, "inertials", n)
    for body in bodies:
        if body is not None and not isinstance(body, Inertial):
            raise InputTypeError(
                f"inertials contains {name_type(body)}; each entry must be an Inertial or None"
            )
    return bodies


def _rows(table: Any) -> Array:
    """The rows (n, 4) of a table given as numbers or as mappings."""
    if isinstance(table, Sequence) and table and all(isinstance(row, Mapping) for row in table):
        for row in table:
            for key in row:
                if key not in COLUMNS:
                    raise suggest("column", key, COLUMNS, owner="a Denavit–Hartenberg row")
        table = [[row.get(column, 0.0) for column in COLUMNS] for row in table]
    rows = as_floats(table, "Denavit–Hartenberg table")
    if rows.ndim != 2 or rows.shape[1] != 4:
        raise InputError(
            f"the Denavit–Hartenberg table has shape {rows.shape}, expected (n, 4)"
            f" with the columns {', '.join(COLUMNS)}"
        )
    return rows


def _describe(
    dh: DHTable,
    values: list[dict[str, Any]],
    inertials: list[Inertial | None],
    name: str,
    base: str,
    tip: str,
) -> Description:
    """The description of a table: the frame of each joint is at the start of its row, z along its axis.

    values: what each row says of its joint, by the fields of Joint. inertials: of each link in its frame of
    the table.
    """
    rows = dh_matrix(dh.alpha, dh.a, dh.d, dh.theta_offset, convention=dh.convention)
    still = np.broadcast_to(IDENTITY, rows.shape)
    before, after = (rows, still) if dh.convention == "modified" else (still, rows)
    links = link_names(dh.joint_names, base, tip)
    carried = dh.T_base
    joints = []
    for i, joint in enumerate(dh.joint_names):
        kind = one_freedom_type(dh.joint_types[i], values[i])
        row = values[i] if kind != "fixed" else {}
        joints.append(Joint(joint, kind, links[i], links[i + 1], carried @ before[i], Z_AXIS, **row))
        carried = after[i]
    joints.append(Joint(f"{tip}_fixed", "fixed", links[-1], tip, carried @ dh.T_tool))
    moved = (body and body.in_frame(T) for body, T in zip(inertials, after, strict=True))
    parts = zip((*links, tip), (None, *moved, None), strict=True)
    return Description(name, tuple(Link(*part) for part in parts), tuple(joints))
