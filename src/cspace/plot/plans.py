"""Planned motions: the sweep of the arm, the path of its tip, and the obstacles around both."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, whole_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.planning import Plan
from cspace.plot import colors
from cspace.plot.axes import space_axes
from cspace.plot.checked_arms import place_arm
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.scene import Group, draw_groups
from cspace.plot.raytrace.solids import Body, Solid
from cspace.plot.scenes import obstacle_groups, set_arm_stage
from cspace.robot import Robot

MOST_POSES: Final = 100
"""Poses of a sweep, which would hide each other long before."""
PIECES: Final = 120
"""Straight pieces of the path of the tip."""
TUBE: Final = 0.006
"""Radius of the path of the tip, as a share of the arm's length; the balls at corners have twice that."""
GHOST: Final = (0.28, 0.50)
"""Opacity of the poses between, and of the start."""


STOP: Final = 6.0
"""Radius of the ball where a descent stopped, in radii of the path of the tip."""


def plan(plan: Plan, *, poses: int = 7, ax: Any | None = None, title: str = "") -> list[Any]:
    """Draw a plan: the arm at poses along its path, the path of its tip, and the scene.

    plan: a Plan with a path, or of a potential's descent that stopped, of a Robot that is a chain. The arm is
    drawn by the shapes that collision checks take, with the objects that it carries: opaque at the goal, and
    transparent at the start and at poses between, which have equal distances along the path: blue at the
    start, then towards green. Balls on the path of the tip are the corners. Of a descent the arm is opaque
    where it stopped, with a dark ball at its tip, and the obstacles that push there are red. Obstacles that
    hide much of the motion are transparent. poses: how many, start and goal included. ax: 3-D axes. Returns
    the artists.
    Raises InputTypeError for what is not a Plan, InputError for one without a path and for fewer than two
    poses, MissingExtraError without matplotlib.
    """
    if not isinstance(plan, Plan):
        raise InputTypeError(f"plan is {name_type(plan)}; give a Plan, as cs.plan answers")
    rest = None if len(plan.path) else plan.stats.get("rest")
    path = plan.path if rest is None else rest.path
    if not len(path):
        raise InputError(f"the plan has no path to draw: {plan.reason}")
    count = whole_number(poses, "poses", 2, MOST_POSES, "start and goal are two")
    robot = plan.space.robot
    scene = plan.space.scene
    if not isinstance(robot, Robot):
        raise InputTypeError("the plan was made for a RobotGeometry; plan with a Robot to draw it")
    arms = [place_arm(robot, q, scene) for q in equal_steps(path, count)]
    tip = robot.fk(equal_steps(path, PIECES))[:, :3, 3]
    axes = space_axes(ax)
    set_arm_stage(axes, arms, scene, tip)
    pushing = () if rest is None else [push.other for push in rest.pushes]
    groups = obstacle_groups(axes, scene, arms, [tip], pushing)
    for arm, tint in zip(arms[:-1], sweep_colors(count - 1), strict=True):
        bodies = arm.link_bodies(arm.ghost_tints(tint)) + arm.carried_bodies(tint)
        groups.append(Group(bodies, GHOST[arm is arms[0]], shadow=arm is arms[0]))
    groups.append(Group(arms[-1].opaque_bodies()))
    radius = TUBE * arms[0].skeleton.length
    corners = robot.fk(plan.path)[:, :3, 3] if rest is None else tip[:0]
    stop = [] if rest is None else [make_ball(tip[-1], STOP * radius, np.array(colors.INK))]
    groups.append(Group(tip_bodies(tip, corners, radius) + stop, shadow=False))
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
    return tube + [make_ball(p, 2.0 * radius, color) for p in corners]


def make_ball(center: Array, radius: float, color: Array) -> Body:
    """A ball."""
    return Solid(center, center, radius, radius, color)
