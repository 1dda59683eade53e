"""Robots among obstacles: the shapes that are checked, and what a robot carries."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.collision import Scene
from cspace.errors import InputError, InputTypeError, name_type
from cspace.plot import colors
from cspace.plot.arm_bodies import solids_of
from cspace.plot.arm_stage import set_stage
from cspace.plot.axes import space_axes
from cspace.plot.checked_arms import CheckedArm, place_arm
from cspace.plot.obstacles import Blockers, bodies_of
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.scene import Group, draw_groups
from cspace.plot.raytrace.solids import Body
from cspace.plot.raytrace.view import look_along

if TYPE_CHECKING:
    from cspace.robot import Robot

SHELL: Final = 0.55
"""Opacity of the shapes of a robot around its links."""
GLASS: Final = 0.30
"""Opacity of obstacles that hide too much of an arm."""
HIDDEN: Final = 0.10
"""The share of the points of an arm from which an obstacle before them is transparent."""
NO_POINTS: Final = np.zeros((0, 3))
TRIAD: Final = 0.14
"""Length of the arrows of a frame, as a share of the arm's length."""


def scene(
    scene: Scene,
    robot: Robot | None = None,
    q: ArrayLike | None = None,
    *,
    ax: Any | None = None,
    title: str = "",
) -> list[Any]:
    """Draw the obstacles of a scene, and a robot among them with the objects that it carries.

    scene: a cspace.Scene. robot: a Robot that is a chain; None draws the obstacles alone. It is drawn by the
    shapes that collision checks take, or without any by its joint axes. q: (dof,) [rad, m].
    ax: 3-D axes; None makes a figure. A half space is drawn as the floor, or as a plate that is seen from
    outside; of large point clouds and meshes less is drawn. Returns the artists.
    Raises InputTypeError without a scene, InputError on a wrong shape, MissingExtraError without matplotlib.
    """
    check_scene(scene)
    arms = [] if robot is None else [place_arm(robot, one_row(robot, q), scene)]
    axes = space_axes(ax)
    set_arm_stage(axes, arms, scene)
    groups = obstacle_groups(axes, scene, arms)
    for arm in arms:
        groups.append(Group(arm.opaque_bodies()))
        frames = np.stack([arm.skeleton.T_base, arm.skeleton.T_tip])
        groups.append(Group(stage.make_triads(frames, TRIAD * arm.skeleton.length), shadow=False))
    return draw_groups(axes, groups) + stage.write_title(axes, title)


def collision(
    robot: Robot, q: ArrayLike, scene: Scene | None = None, *, ax: Any | None = None, title: str = ""
) -> list[Any]:
    """Draw what collision checks take of a robot: solids and spheres, one colour per link, around its axes.

    robot: a Robot that is a chain, with collision geometry. q: (dof,) [rad, m]. scene: a cspace.Scene around
    it. ax: 3-D axes. Returns the artists.
    Raises InputError for a robot without collision geometry and on a wrong shape, MissingExtraError without
    matplotlib.
    """
    check_scene(scene, optional=True)
    arm = place_arm(robot, one_row(robot, q), scene)
    if not arm.links:
        raise InputError(f"{robot.name} has no shapes to draw: {robot.collision.reason}")
    axes = space_axes(ax)
    set_arm_stage(axes, [arm], scene)
    axis_bodies = solids_of(arm.skeleton, np.array(colors.LINK), np.array(colors.STAND))
    groups = [Group([*axis_bodies, *arm.carried_bodies(colors.CARRIED)], backdrop=True)]
    groups += obstacle_groups(axes, scene, [arm])
    for name, tint in zip(arm.links, colors.make_palette(len(arm.links)), strict=True):
        groups.append(Group(arm.link_bodies({name: tint}), SHELL))
    return draw_groups(axes, groups) + stage.write_title(axes, title)


def set_arm_stage(
    axes: Any, arms: Sequence[CheckedArm], scene: Scene | None, more: Array = NO_POINTS
) -> None:
    """The empty stage for arms, a scene and more points (m, 3); the first and last tip are in front."""
    drawn = [arm.skeleton for arm in arms]
    corners = np.concatenate([more, *(arm.corners for arm in arms)])
    goals = [each.T_tip for each in (drawn[0], drawn[-1])] if drawn else []
    set_stage(axes, drawn, goals, () if scene is None else scene.obstacles, corners)


def check_scene(scene: object, *, optional: bool = False) -> None:
    """InputTypeError for what is not a scene."""
    if not (isinstance(scene, Scene) or (optional and scene is None)):
        raise InputTypeError(f"scene is {name_type(scene)}; it must be a cspace.Scene")


def one_row(robot: Robot, q: ArrayLike | None) -> Array:
    """One configuration (dof,)."""
    if q is None:
        raise InputError(f"q is missing; give the configuration ({robot.dof},) of {robot.name}")
    row = as_floats(q, "q", last=(robot.dof,))
    if row.ndim != 1:
        raise InputError(
            f"q has shape {row.shape}; one picture shows one configuration, expected ({robot.dof},)"
        )
    return row


def obstacle_groups(
    axes: Any,
    scene: Scene | None,
    arms: Sequence[CheckedArm],
    more: Sequence[Array] = (),
    marked: Collection[str] = (),
) -> list[Group]:
    """The obstacles; those that hide much of the arms, or of the last one, are transparent.

    more: points (m, 3) that count with all arms. marked: names of obstacles in the colour of pushes.
    """
    if scene is None:
        return []
    shapes = scene.obstacles
    around = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()]).T
    eye = look_along(axes.elev, axes.azim)[2]
    drawn = [arm.points for arm in arms]
    seen = [np.concatenate([*drawn, *more]), drawn[-1]] if drawn else []
    blockers = Blockers(shapes)
    hides = np.max([np.zeros(len(shapes)), *(blockers.hide(each, eye).mean(axis=1) for each in seen)], axis=0)
    solid: list[Body] = []
    glass = []
    for shape, share in zip(shapes, hides, strict=True):
        color = colors.PUSHING if shape.name in marked else colors.OBSTACLE
        bodies = bodies_of(shape, np.array(color), around)
        if share > HIDDEN:
            glass.append(Group(bodies, GLASS))
        else:
            solid += bodies
    return [Group(solid, backdrop=True), *glass]
