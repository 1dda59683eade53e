"""The configuration space of a robot: exact for planar arms with two joints, else in pictures and samples."""

from __future__ import annotations

from typing import Any, Literal, cast, overload

import numpy as np

from cspace.collision import Scene
from cspace.collision.checks import HasGeometry
from cspace.errors import InputError, InputTypeError, name_type
from cspace.planning.joint_space.space import JointSpace
from cspace.planning.two_joints.configuration_space import ConfigurationSpace, Obstacles, exact_space
from cspace.planning.two_joints.planar_arm import is_planar_arm


@overload
def configuration_space(
    robot: HasGeometry,
    obstacles: Obstacles = None,
    *,
    link_radius: float = 0.0,
    limits: bool = True,
    height: float | None = None,
    exact: Literal[True],
    margin: float = 0.0,
) -> ConfigurationSpace: ...
@overload
def configuration_space(
    robot: HasGeometry,
    obstacles: Obstacles = None,
    *,
    link_radius: float = 0.0,
    limits: bool = True,
    height: float | None = None,
    exact: Literal[False],
    margin: float = 0.0,
) -> JointSpace: ...
@overload
def configuration_space(
    robot: HasGeometry,
    obstacles: Obstacles = None,
    *,
    link_radius: float = 0.0,
    limits: bool = True,
    height: float | None = None,
    exact: bool | None = None,
    margin: float = 0.0,
) -> Any: ...


def configuration_space(
    robot: HasGeometry,
    obstacles: Obstacles = None,
    *,
    link_radius: float = 0.0,
    limits: bool = True,
    height: float | None = None,
    exact: bool | None = None,
    margin: float = 0.0,
) -> Any:
    """The configuration space of a robot among obstacles.

    Of a robot with two revolute joints about parallel axes a ConfigurationSpace, which is exact: links are
    the segments from the first axis to the second and from there to the tip, and everything within
    link_radius [m] of them. Mounting, tool and limits count. Of any other robot a JointSpace, whose links are
    the collision geometry of the robot and keep a margin [m]: slices, projections and volumes.

    obstacles: a Scene; None, without obstacles, for a JointSpace. For a planar arm a Scene is cut with its
    plane, and polygons (n, 2) [m] in that plane will do, as a list or a PolygonWorld, whose bounds do not
    count. In a horizontal plane x and y are those of the world; in another one x is horizontal and y points
    up. A Scene that is cut may contain boxes, hulls, spheres, half spaces and point clouds anywhere,
    cylinders and capsules that are upright or lie in the plane.

    limits: whether the limits of revolute joints count; a joint without limits turns around and around.
    height [m]: of the plane over the origin along its normal; by default that of the tip. exact: whether the
    space must be exact; by default it is where it can be. With exact=False a planar arm takes scenes of every
    kind, with its collision geometry.

    Raises InputError for axes that are not parallel where polygons are given, a negative radius, a tilted
    cylinder, an attached object and links in different planes; for a JointSpace of a robot without collision
    geometry; InputTypeError for shapes without a known section, such as meshes; GeometryError for a polygon
    that crosses itself.
    """
    for name, value in (("limits", limits), ("exact", exact)):
        if not isinstance(value, (bool, np.bool_)) and not (name == "exact" and value is None):
            raise InputTypeError(f"{name} is {name_type(value)}; it must be True or False")
    if exact is None:
        takes_all = obstacles is None or isinstance(obstacles, Scene)
        exact = is_planar_arm(robot) or not takes_all
    if exact:
        refuse_option("margin", margin != 0.0, "of a JointSpace; give a larger link_radius")
        return exact_space(robot, obstacles, link_radius=link_radius, limits=bool(limits), height=height)
    refuse_option("link_radius", link_radius != 0.0, "of planar arms; links have their collision geometry")
    refuse_option("height", height is not None, "of planar arms; a JointSpace takes the whole scene")
    return JointSpace(robot, cast("Scene | None", obstacles), margin=margin, limits=bool(limits))


def refuse_option(name: str, is_given: bool, rule: str) -> None:
    """InputError for an option of the other kind of space."""
    if is_given:
        raise InputError(f"{name} is an option {rule}")
