"""Mechanisms with closed loops: bars from joint to joint, rods, rails and platforms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, name_type
from cspace.mechanisms import Mechanism
from cspace.plot.axes import flat_axes, space_axes, write_title
from cspace.plot.colors import INK, WALL, make_palette, mix_colors
from cspace.tolerances import DRAWN_PLANE

GROUND: Final = {"color": WALL, "linewidth": 1.5, "linestyle": (0, (4, 3)), "zorder": 1}
RAIL: Final = {"color": WALL, "linewidth": 2.5, "zorder": 1}
PIN: Final = {
    "marker": "o",
    "linestyle": "none",
    "mfc": "white",
    "mec": INK,
    "mew": 1.2,
    "ms": 5,
    "zorder": 5,
}
TICKS: Final = 4
"""Numbers along each axis in space, where more would run into each other."""
FADED: Final = 0.65
"""How much white the colours of further configurations have."""


@dataclass(frozen=True)
class Parts:
    """What is drawn of a mechanism at one configuration: bars by link, rods, rails and pins, (m, 3) each."""

    bars: dict[str, Array]
    rods: list[Array]
    rails: list[Array]
    pins: Array

    @property
    def points(self) -> Array:
        """Every corner (m, 3)."""
        return np.concatenate([self.pins, *self.bars.values(), *self.rods, *self.rails])


def mechanism(drawn: Mechanism, q: ArrayLike, *, ax: Any = None, title: str = "") -> list[Any]:
    """A mechanism at a configuration, or at several, of which all but the first are pale.

    Planar ones in the plane of x and z are drawn in it, others in space. Links without mass are not drawn.

    drawn: the mechanism. q (..., n) [rad or m]. ax: axes, 2-D or 3-D as the mechanism is. title: above them.
    Returns the artists.
    Raises InputTypeError for anything but a Mechanism, InputError for a wrong shape or NaN.
    """
    if not isinstance(drawn, Mechanism):
        raise InputTypeError(f"the first argument is {name_type(drawn)}, expected a cs.Mechanism")
    rows = as_floats(q, "q", last=(len(drawn.joint_names),)).reshape(-1, len(drawn.joint_names))
    if not len(rows):
        raise InputError("q has no configurations to draw")
    many = [find_parts(drawn, row) for row in rows]
    points = np.concatenate([parts.points for parts in many])
    is_flat = bool(np.ptp(points[:, 1]) <= DRAWN_PLANE * np.ptp(points, axis=0).max())
    axes = flat_axes(ax) if is_flat else space_axes(ax)
    columns = [0, 2] if is_flat else [0, 1, 2]
    artists: list[Any] = []
    for k in range(len(many) - 1, -1, -1):
        artists += draw_parts(axes, many[k], columns, drawn.robot.base, is_pale=k > 0)
    if is_flat:
        axes.set(aspect="equal", xlabel="x [m]", ylabel="z [m]")
    else:
        axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", aspect="equal")
        axes.locator_params(nbins=TICKS)
    return artists + write_title(axes, title)


def draw_parts(axes: Any, parts: Parts, columns: list[int], base: str, *, is_pale: bool) -> list[Any]:
    """The lines of one configuration."""
    palette = make_palette(max(len(parts.bars), 1))
    artists: list[Any] = []

    def draw(path: Array, **style: Any) -> None:
        artists.extend(axes.plot(*path[:, columns].T, solid_capstyle="round", **style))

    for rail in parts.rails:
        draw(rail, **RAIL)
    for rod in parts.rods:
        draw(rod, color=mix_colors(INK, (1.0, 1.0, 1.0), FADED if is_pale else 0.2), linewidth=1.6)
    for color, (name, bar) in zip(palette, parts.bars.items(), strict=True):
        if name == base:
            draw(bar, **GROUND)
            continue
        shade = mix_colors(color, (1.0, 1.0, 1.0), FADED) if is_pale else color
        draw(bar, color=shade, linewidth=4.0, zorder=2 if is_pale else 3)
    if not is_pale:
        draw(parts.pins, **PIN)
    return artists


def find_parts(drawn: Mechanism, q: Array) -> Parts:
    """The parts of a mechanism at one configuration q (n,)."""
    robot = drawn.robot
    frames = dict(
        zip(robot.frames, robot.fk_all(q, T_world_base=np.eye(4) if robot.floating else None), strict=True)
    )
    description = robot.description
    solid = [link.name for link in description.links if link.inertial is not None or link.name == robot.base]
    ends: dict[str, list[Array]] = {name: [] for name in solid if name in frames}
    rods, rails, pins = [], [], []
    for joint in description.joints:
        if joint.child not in frames or joint.parent not in frames:
            continue
        at, tip = (frames[joint.parent] @ joint.origin)[:3, 3], frames[joint.child][:3, 3]
        if joint.parent in ends:
            ends[joint.parent].append(at)
            if joint.moving and joint.type != "prismatic":
                pins.append(at)
        if joint.child in ends:
            ends[joint.child].append(tip)
            if joint.type == "prismatic":
                rails.append(np.array([at, tip]))
    for loop in drawn.loops:
        tips = [(frames[loop.parent] @ loop.origin)[:3, 3], (frames[loop.child] @ loop.child_origin)[:3, 3]]
        pins += tips
        for name, tip in zip((loop.parent, loop.child), tips, strict=True):
            if name in ends:
                ends[name].append(tip)
        if loop.type == "distance":
            rods.append(np.array(tips))
    bars = {name: outline_bar(points) for name, points in ends.items() if len(points) > 1}
    return Parts(
        {name: bar for name, bar in bars.items() if len(bar) > 1}, rods, rails, np.array(pins).reshape(-1, 3)
    )


def outline_bar(points: list[Array]) -> Array:
    """A line (2, 3) through two points, or a closed polygon (m + 1, 3) through more, ordered around their
    middle."""
    apart: list[Array] = []
    for point in points:
        if all(np.linalg.norm(point - other) > DRAWN_PLANE for other in apart):
            apart.append(point)
    corners = np.array(apart)
    if len(corners) < 3:
        return corners
    if len(corners) > 3:  # the origin of a platform, or of its joint, lies in its middle
        middle = corners.mean(axis=0)
        away = np.linalg.norm(corners - middle, axis=1)
        corners = corners[away > 0.5 * away.max()]
    from_middle = corners - corners.mean(axis=0)
    _, _, directions = np.linalg.svd(from_middle, full_matrices=False)
    angles = np.arctan2(from_middle @ directions[1], from_middle @ directions[0])
    corners = corners[np.argsort(angles)]
    return np.concatenate([corners, corners[:1]])
