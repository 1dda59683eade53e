"""Arms as collision checks take them: the shapes of the links, and the objects that an arm carries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.collision import Scene
from cspace.plot import colors
from cspace.plot.arm_bodies import base_bodies, plain_bodies
from cspace.plot.obstacles import CORNERS, bodies_of
from cspace.plot.raytrace.solids import Body
from cspace.plot.skeleton import Skeleton, make_skeleton
from cspace.shapes import Shape

if TYPE_CHECKING:
    from cspace.robot import Robot

TINT: Final = 0.30
"""How much lighter than the next one every second link is drawn."""
WHITE: Final = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class CheckedArm:
    """What is checked of a robot at one configuration, placed in the world.

    skeleton: from which the view is chosen. links: link → its shapes; those of a robot without collision
    geometry are not known. fixed: the links that do not move. carried: objects on its frames.
    """

    skeleton: Skeleton
    links: Mapping[str, tuple[Shape, ...]]
    fixed: frozenset[str]
    carried: tuple[Shape, ...]

    @cached_property
    def corners(self) -> Array:
        """The lower and upper corners (2 n, 3) of boxes around everything that is checked."""
        shapes = [shape for own in self.links.values() for shape in own] + [*self.carried]
        return np.concatenate([np.zeros((0, 3)), *(shape.bounds for shape in shapes)])

    @cached_property
    def points(self) -> Array:
        """Points (m, 3) that should be seen: those of the skeleton, and the middles of what moves."""
        moving = [shape for name, own in self.links.items() if name not in self.fixed for shape in own]
        middles = [shape.pose[None, :3, 3] for shape in [*moving, *self.carried]]
        return np.concatenate([self.skeleton.points, *middles])

    def link_bodies(self, tints: Mapping[str, Array]) -> list[Body]:
        """The bodies of the links that have a tint."""
        return [
            body
            for name, tint in tints.items()
            for shape in self.links[name]
            for body in bodies_of(shape, tint, CORNERS)
        ]

    def carried_bodies(self, tint: ArrayLike) -> list[Body]:
        """The bodies of the objects that the arm carries."""
        color = np.asarray(tint, dtype=np.float64)
        return [body for shape in self.carried for body in bodies_of(shape, color, CORNERS)]

    def opaque_bodies(self) -> list[Body]:
        """An arm that is there, with what it carries; without collision geometry the arm along its axes."""
        links = self.link_bodies(self.plain_tints()) if self.links else plain_bodies(self.skeleton)
        base = base_bodies(self.skeleton) if self.links and not self.fixed else []
        return [*base, *links, *self.carried_bodies(colors.CARRIED)]

    def plain_tints(self) -> dict[str, Array]:
        """Link → the colour of an arm that is there: links and joints of the skeleton in turn."""
        pair = np.array(colors.LINK), np.array(colors.JOINT)
        return {name: pair[k % 2] for k, name in enumerate(self.links)}

    def ghost_tints(self, tint: Array) -> dict[str, Array]:
        """Link → the colour of an arm that was there: those that move, in one hue."""
        pair = colors.mix_colors(tint, WHITE, TINT), tint
        return {name: pair[k % 2] for k, name in enumerate(self.links) if name not in self.fixed}


def place_arm(robot: Robot, q: Array, scene: Scene | None) -> CheckedArm:
    """A robot and what it carries at a configuration q (dof,) [rad, m]."""
    geometry = robot.collision
    links = {
        name: tuple(shape.moved(robot.fk(q, name)) for shape in shapes)
        for name, shapes in geometry.link_shapes.items()
    }
    fixed = [name for name, body in zip(geometry.links, geometry.link_bodies, strict=True) if body == 0]
    return CheckedArm(make_skeleton(robot, q), links, frozenset(fixed), carried_shapes(robot, q, scene))


def carried_shapes(robot: Robot, q: Array, scene: Scene | None) -> tuple[Shape, ...]:
    """The objects that a robot carries, where they are at a configuration."""
    attached = {} if scene is None else scene.attached
    return tuple(
        scene[name].placed(robot.fk(q, each.frame) @ each.T_frame_object)  # type: ignore[index]
        for name, each in attached.items()
    )
