"""Robots from screw axes at zero: the product of exponentials."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.model.description import Description
from cspace.model.joint import Joint, limit_row
from cspace.model.link import Link
from cspace.model.values import check_placement, check_size, read_joint_names, translation_by, unit_axis


def from_screws(
    axes: Any,
    points: Any,
    T_zero: Any,
    *,
    joint_types: str | None = None,
    lower: Any = None,
    upper: Any = None,
    velocity: Any = None,
    acceleration: Any = None,
    jerk: Any = None,
    effort: Any = None,
    name: str = "robot",
    joint_names: Sequence[str] | None = None,
    base: str = "base",
    tip: str = "tip",
) -> Description:
    """A serial robot from its joint axes at zero.

    T_base_tip(q) = exp(ξ₁ q₁) … exp(ξₙ qₙ) · T_zero; ξ = [−ω × p; ω] for a turn about the axis ω through p,
    ξ = [v; 0] for a slide along v (Murray, Li, Sastry 1994, section 3.2).

    axes (n, 3): directions, made unit; points (n, 3): any point on each axis [m] (of a slide: where its link
    is drawn); T_zero (4, 4): the tip at q = 0. joint_types: "R" and "P", default all "R". lower, upper,
    velocity, acceleration, jerk, effort (n,): limits, default none. Link frames stand on the points,
    parallel to the base at zero.
    Raises InputError for wrong shapes, a zero axis, NaN, limits upside down.
    """
    directions = as_floats(axes, "axes", last=(None, 3))
    n = len(directions)
    places = check_size(as_floats(points, "points", last=(n, 3)), "points")
    if directions.ndim != 2 or places.ndim != 2:
        raise InputError(
            f"axes and points have the shapes {directions.shape}, {places.shape}; expected (n, 3)"
        )
    end = check_placement(T_zero, "T_zero")
    types = check_joint_types("R" * n if joint_types is None else joint_types, n)
    names = read_joint_names(joint_names, n) or [f"joint_{i + 1}" for i in range(n)]
    links = link_names(names, base, tip)
    limits = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk, "effort": effort}
    rows = joint_rows(n, lower=lower, upper=upper, **limits)
    joints = []
    for i in range(n):
        origin = translation_by(places[i] - (places[i - 1] if i else 0.0))
        axis = unit_axis(directions[i], f"axis of joint {names[i]!r}")
        kind = one_freedom_type(types[i], rows[i])
        joints.append(Joint(names[i], kind, links[i], links[i + 1], origin, axis, **rows[i]))
    last = translation_by(-places[-1]) @ end if n else end
    joints.append(Joint(f"{tip}_fixed", "fixed", links[n], tip, last))
    return Description(name, tuple(Link(link) for link in (*links, tip)), tuple(joints))


def twists(axes: Array, points: Array, joint_types: str) -> Array:
    """The screws ξ (n, 6) = [v; ω] of the joints: [−ω × p; ω] for a turn, [v; 0] for a slide."""
    turns = np.array([kind == "R" for kind in joint_types])[:, None]
    linear = np.where(turns, np.cross(points, axes), axes)
    return np.hstack([linear, np.where(turns, axes, 0.0)])


def check_joint_types(types: str, n: int, *, letters: str = "RP") -> str:
    """`types` in capitals, if it holds n of the allowed letters."""
    upper = str(types).upper()
    if len(upper) != n or any(letter not in letters for letter in upper):
        allowed = ", ".join(repr(letter) for letter in letters)
        raise InputError(f"joint_types is {types!r}; expected {n} of the letters {allowed}")
    return upper


def one_freedom_type(letter: str, row: dict[str, Any]) -> str:
    """The joint type of "R", "P" or "F": a turn without limits is continuous."""
    if letter == "R":
        unlimited = row["lower"] == -np.inf and row["upper"] == np.inf
        return "continuous" if unlimited else "revolute"
    return {"P": "prismatic", "F": "fixed"}[letter]


def joint_rows(n: int, **limits: Any) -> list[dict[str, Any]]:
    """One dict of limits per joint; what is None is infinite."""
    if limits["lower"] is None:
        limits["lower"] = np.full(n, -np.inf)
    columns = {field: limit_row(value, field, n) for field, value in limits.items()}
    return [{field: float(column[i]) for field, column in columns.items()} for i in range(n)]


def link_names(joints: Sequence[str], base: str, tip: str) -> list[str]:
    """The base and one link per joint: elbow_joint carries elbow_link, joint_1 link_1, q1 q1_link."""
    links = [base]
    for joint in joints:
        link = re.sub("joint", "link", joint, count=1) if "joint" in joint else f"{joint}_link"
        while link in links or link == tip:
            link += "_"
        links.append(link)
    return links
