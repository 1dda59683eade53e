"""Planar arm with two revolute joints: its links and the plane in which they move, read from a chain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics import KinematicModel
from cspace.math.wrapping import TURN
from cspace.tables import show_fields
from cspace.tolerances import PLANAR_AXES

WHOLE: Final = (-np.pi, np.pi)
"""The range [rad] in which a joint without limits is described."""


MOST_TURNS: Final = 100
"""Turns between the limits of a joint: each is swept anew; robots have two, winches ten."""


@show_fields
@dataclass(frozen=True, eq=False)
class PlanarArm:
    """Two links in a plane, each a segment.

    lengths (2,) [m]. base (2,): the first joint in the plane [m]. signs, offsets (2,): the angle of joint i
    in the plane, of link 1 against the x axis and of link 2 against link 1, is signs[i] q[i] + offsets[i].
    lower, upper (2,): limits [rad]; of a joint that wraps, −π and π. wraps (2,): joints without limits.
    axes (2, 3): the x and y axes of the plane in the world. height: of the tip over the origin along the
    normal of the plane [m], x × y. step: how far the elbow lies above the tip [m].
    """

    name: str
    joint_names: tuple[str, ...]
    lengths: Array
    base: Array
    signs: Array
    offsets: Array
    lower: Array
    upper: Array
    wraps: npt.NDArray[np.bool_]
    axes: Array
    height: float
    step: float

    @property
    def normal(self) -> Array:
        """The unit normal (3,) of the plane, x × y."""
        return np.cross(self.axes[0], self.axes[1])

    @property
    def reach(self) -> float:
        """The length of the stretched arm [m]."""
        return float(self.lengths.sum())

    def points(self, q: Array) -> Array:
        """Base, elbow and tip in the plane (..., 3, 2) [m] at configurations q (..., 2)."""
        angles = np.cumsum(self.signs * q + self.offsets, axis=-1)
        links = self.lengths[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        start = np.broadcast_to(self.base, (*links.shape[:-2], 1, 2))
        return np.cumsum(np.concatenate([start, links], axis=-2), axis=-2)


def is_planar_arm(robot: object) -> bool:
    """Whether a robot has two revolute joints about parallel axes; True for a value that is not a robot."""
    if not isinstance(robot, KinematicModel):
        return not hasattr(robot, "collision")
    if robot.tip is None or robot.chain.joint_types != "RR" or robot.chain.dof != 2:
        return False
    return bool(np.abs(np.cross(*robot.chain.axes)).max() <= PLANAR_AXES)


def read_planar_arm(robot: object, use_limits: bool) -> PlanarArm:
    """The planar arm that a robot is; InputError for other joints and for axes that are not parallel."""
    if not isinstance(robot, KinematicModel):
        raise InputTypeError(
            f"robot is {name_type(robot)}; configuration_space takes a Robot, as cs.load_robot gives"
        )
    chain = robot.chain
    if chain.joint_types != "RR" or chain.dof != 2:
        raise InputError(
            f"{robot.name} has {chain.dof} joints of types {chain.joint_types!r}; an exact"
            " configuration space, and obstacles as polygons, need two revolute joints ('RR'): give the"
            " obstacles as a cs.Scene and leave exact= out, or use Robot(description, base=, tip=)"
            " for a part of the robot"
        )
    if np.abs(np.cross(*chain.axes)).max() > PLANAR_AXES:
        angle = np.degrees(np.arccos(np.clip(np.abs(chain.axes[0] @ chain.axes[1]), 0.0, 1.0)))
        raise InputError(
            f"the axes of {' and '.join(chain.joint_names)} of {robot.name} enclose {angle:.6g} degrees;"
            " they must be parallel, so that the arm moves in a plane"
        )
    lower, upper, wraps = read_limits(robot, use_limits)
    axes = find_plane(chain.axes[0])
    tip = chain.T_zero[:3, 3]
    corners = np.vstack([chain.points, tip]) @ axes.T
    links = np.diff(corners, axis=0) @ (1.0, 1j)
    links[np.abs(links) <= PLANAR_AXES * np.abs(links).sum()] = 0.0
    normal = np.cross(axes[0], axes[1])
    return PlanarArm(
        name=robot.name,
        joint_names=tuple(chain.joint_names),
        lengths=np.abs(links),
        base=corners[0],
        signs=np.sign(chain.axes @ normal),
        offsets=np.diff(np.angle(links), prepend=0.0),
        lower=lower,
        upper=upper,
        wraps=wraps,
        axes=axes,
        height=float(tip @ normal),
        step=float((chain.points[1] - tip) @ normal),
    )


def read_limits(robot: KinematicModel, use_limits: bool) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Lower and upper limits (2,), and which joints wrap because they have none."""
    lower, upper = np.array(robot.limits.lower), np.array(robot.limits.upper)
    if not use_limits:
        lower[:], upper[:] = -np.inf, np.inf
    wraps = np.isinf(lower) & np.isinf(upper)
    for name, low, high, wrap in zip(robot.joint_names, lower, upper, wraps, strict=True):
        if not wrap and not np.isfinite(high - low):
            raise InputError(
                f"joint {name} of {robot.name} has a limit on one side only, {low:g} to {high:g} rad; give it"
                " both limits or none, or use limits=False"
            )
        if not wrap and high <= low:
            raise InputError(
                f"joint {name} of {robot.name} cannot move: its limits are {low:g} and {high:g} rad; give it"
                " a range, or use limits=False"
            )
        if not wrap and high - low > MOST_TURNS * TURN:
            raise InputError(
                f"joint {name} of {robot.name} has limits {low:g} and {high:g} rad, more than {MOST_TURNS}"
                " turns apart; use limits=False for a continuous joint"
            )
    lower[wraps], upper[wraps] = WHOLE
    return lower, upper, wraps


def find_plane(axis: Array) -> Array:
    """The x and y axes (2, 3) of the plane normal to a unit axis.

    In a horizontal plane those of the world. Else x is horizontal where it can be, and y points up.
    """
    x, up = np.eye(3)[0], np.eye(3)[2]
    if abs(axis @ up) > 1.0 - PLANAR_AXES:
        return np.eye(3)[:2]
    if abs(axis @ x) > 1.0 - PLANAR_AXES:
        return np.eye(3)[1:]
    y = up - (up @ axis) * axis
    y /= np.linalg.norm(y)
    x = np.cross(y, axis)
    return np.array([x if x.sum() > 0.0 else -x, y])
