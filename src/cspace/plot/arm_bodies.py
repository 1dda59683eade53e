"""The bodies of the links and joints of an arm."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from cspace.arrays import Array
from cspace.plot import colors
from cspace.plot.raytrace.solids import Body, Solid, make_cylinder
from cspace.plot.skeleton import WIDTH, Skeleton
from cspace.tolerances import DRAWN_LENGTH


def solids_of(drawn: Skeleton, link: Array, joint: Array) -> list[Solid]:
    """The bodies of the links and joints of one configuration."""
    radii = drawn.radii
    foot, up = drawn.T_base[:3, 3], drawn.T_base[:3, 2]
    solids = [make_cylinder(foot + 0.3 * radii[0] * up, up, 1.7 * radii[0], 0.3 * radii[0], joint)]
    for i, path in enumerate(drawn.paths):
        ends = np.linspace(radii[i], radii[i + 1], len(path))
        for k in range(len(path) - 1):
            if np.linalg.norm(path[k + 1] - path[k]) < DRAWN_LENGTH:
                continue
            if i == 0 and k == 0 and (path[1] - path[0]) @ up > 0.0:  # the pillar stands on its base, flat
                solids.append(Solid(path[0], path[1], ends[0], ends[1], link, round=False))
                solids.append(Solid(path[1], path[1], ends[1], ends[1], link))
            else:
                solids.append(Solid(path[k], path[k + 1], ends[k], ends[k + 1], link))
    for rail in drawn.rails:
        if np.linalg.norm(rail[1] - rail[0]) > DRAWN_LENGTH:
            solids.append(Solid(rail[0], rail[1], 0.6 * radii[-1], 0.6 * radii[-1], joint))
    for i, (place, axis) in enumerate(zip(drawn.joints, drawn.axes, strict=True)):
        solids.append(make_cylinder(place, axis, WIDTH * radii[i + 1], drawn.body_half(i), joint))
    return solids


def plain_bodies(drawn: Skeleton) -> list[Body]:
    """The bodies of an arm in its own colours."""
    return [*solids_of(drawn, np.array(colors.LINK), np.array(colors.JOINT))]


def ghost_bodies(drawn: Skeleton, tint: Array) -> list[Body]:
    """The bodies of an arm in one colour, the links lighter than the joints."""
    return [*solids_of(drawn, colors.mix_colors(tint, (1.0, 1.0, 1.0), 0.25), tint)]


def base_bodies(drawn: Skeleton) -> list[Body]:
    """The base of an arm, up to its first joint."""
    color, radius = np.array(colors.STAND), drawn.radii[0]
    ends = [pair for pair in pairwise(drawn.paths[0]) if np.linalg.norm(pair[1] - pair[0]) > DRAWN_LENGTH]
    return [Solid(a, b, radius, radius, color, round=k > 0) for k, (a, b) in enumerate(ends)]
