"""Robots among obstacles: scenes with what a robot carries, and the spheres of collision checks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.collision import Scene
from cspace.errors import InputError, InputTypeError
from cspace.plot import colors
from cspace.plot.arm_bodies import plain_bodies
from cspace.plot.arm_stage import set_stage
from cspace.plot.axes import space_axes
from cspace.plot.obstacles import Blockers, bodies_of
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.scene import Group, draw_groups
from cspace.plot.raytrace.solids import Body, Solid
from cspace.plot.raytrace.view import look_along
from cspace.plot.skeleton import Skeleton, make_skeleton
from cspace.shapes import Shape
from cspace.spatial.poses import invert_pose, transform_points

SHELL: Final = 0.55
"""Opacity of the spheres of a robot around its links."""
GLASS: Final = 0.30
"""Opacity of obstacles that hide too much of an arm."""
HIDDEN: Final = 0.10
"""The share of the points of an arm from which an obstacle before them is transparent."""
TRIAD: Final = 0.14
"""Length of the arrows of a frame, as a share of the arm's length."""


def scene(
    scene: Any, robot: Any | None = None, q: Any | None = None, *, ax: Any | None = None, title: str = ""
) -> list[Any]:
    """Draw the obstacles of a scene, and a robot among them with the objects that it carries.

    scene: a cspace.Scene. robot: a Robot that is a chain; None draws the obstacles alone. q: (dof,) [rad, m].
    ax: 3-D axes; None makes a figure. A half space is drawn as the floor, or as a plate that is seen from
    outside; of large point clouds and meshes less is drawn. Returns the artists.
    Raises InputTypeError without a scene, InputError on a wrong shape, MissingExtraError without matplotlib.
    """
    check_scene(scene)
    drawn = [] if robot is None else [make_skeleton(robot, one_row(robot, q))]
    carried = [] if robot is None else carried_shapes(robot, q, scene)
    axes = space_axes(ax)
    set_stage(axes, drawn, [each.T_tip for each in drawn], scene.obstacles, box_ends(carried))
    groups = obstacle_groups(axes, scene, drawn)
    for each in drawn:
        groups.append(Group(plain_bodies(each) + shape_bodies(axes, carried, colors.CARRIED)))
        frames = stage.make_triads(np.stack([each.T_base, each.T_tip]), TRIAD * each.length)
        groups.append(Group(frames, shadow=False))
    return draw_groups(axes, groups) + stage.write_title(axes, title)


def spheres(
    robot: Any, q: Any, scene: Any | None = None, *, ax: Any | None = None, title: str = ""
) -> list[Any]:
    """Draw what collision checks use of a robot: its spheres, one colour per link, around its links.

    robot: a Robot that is a chain, with collision geometry. q: (dof,) [rad, m]. scene: a cspace.Scene around
    it. ax: 3-D axes. Returns the artists.
    Raises InputError for a robot without collision geometry and on a wrong shape, MissingExtraError without
    matplotlib.
    """
    check_scene(scene, optional=True)
    row = one_row(robot, q)
    shells = link_spheres(robot, row)
    drawn, carried = make_skeleton(robot, row), carried_shapes(robot, row, scene)
    axes = space_axes(ax)
    set_stage(axes, [drawn], [drawn.T_tip], () if scene is None else scene.obstacles, np.concatenate(shells))
    groups = [Group(plain_bodies(drawn) + shape_bodies(axes, carried, colors.CARRIED), backdrop=True)]
    if scene is not None:
        groups += obstacle_groups(axes, scene, [drawn])
    for tint, balls in zip(colors.make_palette(len(shells)), shells, strict=True):
        groups.append(Group([Solid(ball[:3], ball[:3], ball[3], ball[3], tint) for ball in balls], SHELL))
    return draw_groups(axes, groups) + stage.write_title(axes, title)


def check_scene(scene: Any, *, optional: bool = False) -> None:
    """InputTypeError for what is not a scene."""
    if not (isinstance(scene, Scene) or (optional and scene is None)):
        raise InputTypeError(f"scene is a {type(scene).__name__}; it must be a cspace.Scene")


def one_row(robot: Any, q: Any) -> Array:
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
    axes: Any, scene: Scene, drawn: Sequence[Skeleton], more: Array | None = None
) -> list[Group]:
    """The obstacles; those that hide much of the arms, or of more points (m, 3), are transparent."""
    shapes = scene.obstacles
    points = (
        np.concatenate([each.points for each in drawn] + ([] if more is None else [more])) if drawn else None
    )
    eye = look_along(axes.elev, axes.azim)[2]
    hides = np.zeros(len(shapes)) if points is None else Blockers(shapes).hide(points, eye).mean(axis=1)
    solid: list[Body] = []
    glass = []
    for shape, share in zip(shapes, hides, strict=True):
        bodies = shape_bodies(axes, [shape], colors.OBSTACLE)
        if share > HIDDEN:
            glass.append(Group(bodies, GLASS))
        else:
            solid += bodies
    return [Group(solid, backdrop=True), *glass]


def carried_shapes(robot: Any, q: Any, scene: Scene | None) -> list[Shape]:
    """The objects that a robot carries, where they are at a configuration."""
    if scene is None:
        return []
    return [
        scene[name].placed(robot.fk(q, each.frame) @ each.T_frame_object)
        for name, each in scene.attached.items()
    ]


def box_ends(shapes: Sequence[Shape]) -> Array:
    """The lower and upper corners (2 n, 3) of the boxes around shapes."""
    return np.concatenate([np.zeros((0, 3)), *(shape.bounds for shape in shapes)])


def shape_bodies(axes: Any, shapes: Sequence[Shape], color: Any) -> list[Body]:
    """The bodies of shapes in one colour."""
    around, tint = picture_box(axes), np.asarray(color)
    return [body for shape in shapes for body in bodies_of(shape, tint, around)]


def picture_box(axes: Any) -> Array:
    """The box (2, 3) of the axes [m]."""
    return np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()]).T


def link_spheres(robot: Any, q: Array) -> list[Array]:
    """The spheres (n, 4) of each link at a configuration, in the world."""
    geometry = robot.collision
    if not geometry:
        raise InputError(f"{robot.name} has no spheres to draw: {geometry.reason}")
    found = []
    for number, name in enumerate(geometry.links):
        own = geometry.spheres[geometry.sphere_links == number].copy()
        T_world_body = np.asarray(robot.fk(q, name)) @ invert_pose(geometry.frames[name][1])
        own[:, :3] = transform_points(T_world_body, own[:, :3])
        found.append(own)
    return found
