"""Planned motions: the sweep of the arm, the path of its tip, and the obstacles around both."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, whole_number
from cspace.errors import InputError, InputTypeError
from cspace.plot import colors
from cspace.plot.arm_bodies import ghost_bodies, plain_bodies
from cspace.plot.arm_stage import set_stage
from cspace.plot.axes import space_axes
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.scene import Group, draw_groups
from cspace.plot.raytrace.solids import Body, Solid
from cspace.plot.scenes import box_ends, carried_shapes, obstacle_groups, shape_bodies
from cspace.plot.skeleton import make_skeleton

MOST_POSES: Final = 100
"""Poses of a sweep, which would hide each other long before."""
PIECES: Final = 120
"""Straight pieces of the path of the tip."""
TUBE: Final = 0.006
"""Radius of the path of the tip, as a share of the arm's length; the balls at corners have twice that."""
GHOST: Final = (0.28, 0.50)
"""Opacity of the poses between, and of the start."""


def plan(plan: Any, *, poses: int = 7, ax: Any | None = None, title: str = "") -> list[Any]:
    """Draw a plan: the arm at poses along its path, the path of its tip, and the scene.

    plan: a Plan with a path, of a Robot that is a chain. The arm is opaque at the goal, and transparent at
    the start and at poses between, which have equal distances along the path: blue at the start, then towards
    green. Balls on the path of the tip are the corners. Objects that the robot carries move with it.
    Obstacles that hide much of the motion are transparent. poses: how many, start and goal included. ax: 3-D
    axes. Returns the artists.
    Raises InputTypeError for what is not a Plan, InputError for one without a path and for fewer than two
    poses, MissingExtraError without matplotlib.
    """
    if not hasattr(plan, "space") or not hasattr(plan, "path"):
        raise InputTypeError(f"plan is a {type(plan).__name__}; give a Plan, as cs.plan answers")
    if not len(plan.path):
        raise InputError(f"the plan has no path to draw: {plan.reason}")
    count = whole_number(poses, "poses", 2, MOST_POSES, "start and goal are two")
    robot, scene = plan.space.robot, plan.space.scene
    if not hasattr(robot, "fk"):
        raise InputTypeError("the plan was made for a RobotGeometry; plan with a Robot to draw it")
    rows = equal_steps(plan.path, count)
    drawn = [make_skeleton(robot, q) for q in rows]
    carried = [carried_shapes(robot, q, scene) for q in rows]
    tip = np.asarray(robot.fk(equal_steps(plan.path, PIECES)))[:, :3, 3]
    shown = np.concatenate([tip, *map(box_ends, carried)])
    axes = space_axes(ax)
    set_stage(axes, drawn, [drawn[0].T_tip, drawn[-1].T_tip], () if scene is None else scene.obstacles, shown)
    groups = [] if scene is None else obstacle_groups(axes, scene, drawn, tip)
    for each, shapes, tint in zip(drawn[:-1], carried[:-1], sweep_colors(count - 1), strict=True):
        first = each is drawn[0]
        bodies = ghost_bodies(each, tint) + shape_bodies(axes, shapes, tint)
        groups.append(Group(bodies, GHOST[first], shadow=first))
    groups.append(Group(plain_bodies(drawn[-1]) + shape_bodies(axes, carried[-1], colors.CARRIED)))
    corners = np.asarray(robot.fk(plan.path))[:, :3, 3]
    groups.append(Group(tip_bodies(tip, corners, TUBE * drawn[0].length), shadow=False))
    return draw_groups(axes, groups) + stage.write_title(axes, title)


def equal_steps(path: Array, count: int) -> Array:
    """Configurations (count, dof) at equal distances along a path (m, dof), both ends included."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    places = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(places, along, column) for column in path.T], axis=1)


def sweep_colors(count: int) -> list[Array]:
    """Colours from the start of a motion to its goal."""
    first, last = (colors.color_of_oklch(0.66, 0.145, hue) for hue in (252.0, 152.0))
    return [colors.mix_colors(first, tuple(last), share) for share in np.linspace(0.0, 1.0, count)]


def tip_bodies(tip: Array, corners: Array, radius: float) -> list[Body]:
    """The path of the tip (k, 3) as a tube, with balls at corners (m, 3)."""
    color = np.array(colors.PATH)
    tube: list[Body] = [Solid(a, b, radius, radius, color) for a, b in pairwise(tip)]
    return tube + [Solid(p, p, 2.0 * radius, 2.0 * radius, color) for p in corners]
