"""The stage of a picture of arms: the view from which they are seen well, the floor, the stand of a base."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot import colors
from cspace.plot.arm_bodies import plain_bodies
from cspace.plot.obstacles import CORNERS, UPRIGHT, Blockers, floor_level
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.canvas import Floor
from cspace.plot.raytrace.scene import Group, artist_type
from cspace.plot.raytrace.solids import Body, make_cylinder
from cspace.plot.skeleton import Skeleton
from cspace.shapes import Shape
from cspace.tolerances import DRAWN_LENGTH

AROUND: Final = 1.2
"""How far obstacles are in the picture, along each axis from the base [lengths of the arm]."""


def set_stage(
    ax: Any, drawn: Sequence[Skeleton], goals: Sequence[Array], shapes: Sequence[Shape] = (), more: Any = ()
) -> None:
    """The empty stage for these skeletons: view, limits, floor; axes that have a stage keep it.

    goals: poses (4, 4) that should be in front. shapes: obstacles around them. more (m, 3) or (m, 4): points,
    or balls, that should be in the picture.
    """
    if any(type(artist) is artist_type() for artist in ax.get_children()):
        return
    inside = [shown_points(each) for each in drawn]
    inside += [T[:3, 3] + 0.2 * drawn[0].length * T[:3, :3].T for T in goals]
    if len(more):
        inside += [more[:, :3] + more[:, 3:].sum(axis=1)[:, None] * side for side in (-1.0, 1.0)]
    around = np.concatenate([*inside, *shape_corners(shapes, drawn)] or [0.5 * CORNERS])
    base = drawn[0].T_base[:3, 3] if drawn else around.mean(axis=0)
    low = floor_height(drawn, shapes)
    points = np.concatenate([each.points for each in drawn]) if drawn else around
    focus = np.array([T[:3, 3] for T in goals]) if len(goals) else points
    blockers = Blockers(shapes)
    elevation, azimuth = stage.choose_view(points, focus, blockers.hidden_share if shapes else None)
    artist = stage.set_up(
        ax, around, round_floor(drawn, around, base, low), elevation=elevation, azimuth=azimuth
    )
    if drawn and drawn[0].T_base[2, 2] > UPRIGHT and base[2] - low > DRAWN_LENGTH:
        artist.scene.groups.append(Group([make_stand(drawn[0], low)]))


def make_stand(drawn: Skeleton, low: float) -> Body:
    """The pillar from the floor to the base of an arm."""
    base, up = drawn.T_base[:3, 3], np.array([0.0, 0.0, 1.0])
    half = 0.5 * (float(base[2]) - low)
    return make_cylinder(base - half * up, up, 0.8 * drawn.radii[0], half, np.array(colors.STAND))


def shown_points(drawn: Skeleton) -> Array:
    """Points (m, 3) around a skeleton that should be in the picture."""
    thick = drawn.radii[-1]
    return np.concatenate([drawn.points + thick, drawn.points - thick])


def shape_corners(shapes: Sequence[Shape], drawn: Sequence[Skeleton]) -> list[Array]:
    """The corners (8, 3) of the boxes around shapes, no farther from a robot than its length."""
    found = [shape.bounds for shape in shapes if np.isfinite(shape.bounds).all()]
    if drawn:
        base, reach = drawn[0].T_base[:3, 3], AROUND * drawn[0].length
        found = [np.clip(box, base - reach, base + reach) for box in found]
    return [np.stack(np.meshgrid(*box.T), axis=-1).reshape(-1, 3) for box in found]


def floor_height(drawn: Sequence[Skeleton], shapes: Sequence[Shape]) -> float:
    """The height of the floor [m]: that of a half space, or below everything, no higher than zero."""
    floors = [level for level in map(floor_level, shapes) if level is not None]
    if floors:
        return max(floors)
    lowest = [body.lowest() for each in drawn for body in plain_bodies(each)]
    lowest += [float(corners[:, 2].min()) for corners in shape_corners(shapes, drawn)]
    return min(0.0, *lowest, 0.0)


def round_floor(drawn: Sequence[Skeleton], around: Array, base: Array, low: float) -> Floor:
    """A floor at a height [m] below points (m, 3) and the foot of an arm."""
    ground = np.concatenate([around[:, :2], base[None, :2]])
    center = 0.5 * (ground.min(axis=0) + ground.max(axis=0))
    foot = float(np.linalg.norm(center - base[:2])) + (3.0 * drawn[0].radii[0] if drawn else 0.0)
    widest = 1.04 * float(np.linalg.norm(ground - center, axis=1).max())
    return stage.floor_under(center, max(widest, foot, 0.4 * float(np.ptp(around[:, 2]))), low)
