"""Invalid polygons: names the defect and repairs it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.tolerances import ON_ONE_LINE


class GeometryError(InputError):
    """An invalid polygon: it crosses itself, or has no area. The message names it and the remedy."""


def check_area(outlines: Sequence[Sequence[Array]], repair: bool) -> list[str]:
    """Polygons without area, which repair keeps as walls without thickness; GeometryError without it."""
    said = []
    for k, rings in enumerate(outlines):
        for ring in rings:
            if not _is_on_one_line(ring):
                continue
            what = f"obstacle {k} has no area: its {len(ring)} corners lie on one line"
            if not repair:
                raise GeometryError(f"{what}; correct its corners, or keep it as a wall with repair=True")
            said.append(f"{what}; kept as a wall without thickness")
    return said


def _is_on_one_line(ring: Array) -> bool:
    """Whether all corners (n, 2) lie on one line, within rounding."""
    away = ring - ring[0]
    far = away[np.argmax(np.sum(away**2, axis=1))]
    distance = np.abs(far[0] * away[:, 1] - far[1] * away[:, 0])
    return bool(np.all(distance <= ON_ONE_LINE * float(far @ far)))


def describe_crossings(core: _core.PolygonCore, repair: bool) -> list[str]:
    """Polygons that cross themselves, which repair reads by the even-odd rule; GeometryError without it."""
    points, pairs = core.crossings()
    own: dict[int, list[Array]] = {}
    for point, (one, other) in zip(points, pairs, strict=True):
        if one == other:
            own.setdefault(one, []).append(point)
    said = []
    for obstacle, places in sorted(own.items()):
        x, y = places[0]
        more = f" and {len(places) - 1} more places" if len(places) > 1 else ""
        what = f"obstacle {obstacle} crosses itself at ({x:g}, {y:g}){more}"
        if not repair:
            raise GeometryError(f"{what}; order its corners, or apply the even-odd rule with repair=True")
        said.append(f"{what}; read by the even-odd rule: what its outline surrounds twice is free")
    return said
