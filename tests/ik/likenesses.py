"""Arms of every word of turns and slides, and their likenesses: arms made from them with known solutions.

A likeness is a second arm with a map of goals and a map of configurations: q reaches T on the first arm if
and only if to_q(q) reaches to_goal(T) on the second.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cspace.model import from_screws
from cspace.robot import Robot
from ik.geometries import random_pose, unit

MIRROR = np.diag([1.0, -1.0, 1.0])


def arm_of(word, axes, points, T_zero):
    return Robot(from_screws(axes, points, T_zero, joint_types=word, name=f"arm {word}"))


def slides_of(robot):
    return np.array([kind == "P" for kind in robot.joint_types])


def general(word, rng):
    """Axes, points and tip of an arm with nothing special about it."""
    axes = np.array([unit(v) for v in rng.normal(size=(len(word), 3))])
    T_zero = random_pose(rng)
    return axes, rng.uniform(-1, 1, (len(word), 3)), T_zero


def on_a_grid(word, rng):
    """Axes along the coordinate axes, points on a grid: parallel, meeting and square neighbours by chance."""
    axes = np.eye(3)[rng.integers(0, 3, len(word))] * rng.choice([-1.0, 1.0], len(word))[:, None]
    points = np.cumsum(rng.integers(0, 2, (len(word), 3)) * rng.uniform(0.2, 0.5, (len(word), 3)), axis=0)
    T_zero = np.eye(4)
    T_zero[:3, 3] = points[-1] + rng.uniform(0.05, 0.3, 3)
    return axes, points, T_zero


def planar(word, rng):
    """Axes that are all parallel, as those of a SCARA; one of the slides, or none, lies across."""
    axes, points, T_zero = on_a_grid(word, rng)
    axes[:] = np.where(rng.random((len(word), 1)) < 0.3, -1, 1) * np.eye(3)[2]
    slides = np.flatnonzero(np.array(list(word)) == "P")
    if len(slides) > 1 or (len(slides) and rng.random() < 0.3):
        axes[rng.choice(slides)] = np.eye(3)[rng.integers(0, 2)]
    points[:, 0] += np.cumsum(rng.uniform(0.2, 0.5, len(word)))
    return axes, points, T_zero


def with_wrist(word, rng):
    """On a grid or planar, but for a wrist: the last turns, up to three, are square and meet in a point."""
    axes, points, T_zero = (on_a_grid if rng.random() < 0.5 else planar)(word, rng)
    turns = min(len(word) - len(word.rstrip("R")), 3)
    directions = np.eye(3)[rng.permutation(3)]
    for k in range(len(word) - turns, len(word)):
        axes[k], points[k] = directions[(len(word) - k) % 2], points[-1]
    return axes, points, T_zero


def disturbed(axes, points, T_zero, size, rng):
    """The same arm as a calibration would find it."""
    axes = np.array([unit(h + size * rng.normal(size=3)) for h in axes])
    return axes, points + size * rng.normal(size=points.shape), T_zero


MAKERS: dict[str, Callable] = {
    "general": general,
    "grid": on_a_grid,
    "wrist": with_wrist,
    "planar": planar,
    "calibrated": lambda word, rng: disturbed(*on_a_grid(word, rng), 1e-3, rng),
    "nearly special": lambda word, rng: disturbed(*on_a_grid(word, rng), 1e-5, rng),
}


@dataclass
class Likeness:
    robot: Robot
    to_goal: Callable
    to_q: Callable
    from_q: Callable


def same(x):
    """x itself."""
    return x


def scaled(robot, factor):
    """Every length times factor."""
    c = robot.chain
    units = np.where(slides_of(robot), factor, 1.0)

    def to_goal(T):
        out = T.copy()
        out[..., :3, 3] *= factor
        return out

    return Likeness(
        arm_of(robot.joint_types, c.axes, factor * c.points, to_goal(c.T_zero)),
        to_goal,
        lambda q: units * q,
        lambda q: q / units,
    )


def mirrored(robot):
    """In the plane y = 0; turns are axial vectors and slides are not."""
    c, slides = robot.chain, slides_of(robot)

    def to_goal(T):
        out = T.copy()
        out[..., :3, :3], out[..., :3, 3] = MIRROR @ T[..., :3, :3] @ MIRROR, T[..., :3, 3] @ MIRROR
        return out

    axes = np.where(slides[:, None], 1.0, -1.0) * (c.axes @ MIRROR)
    return Likeness(
        arm_of(robot.joint_types, axes, c.points @ MIRROR, to_goal(c.T_zero)), to_goal, same, same
    )


def reversed_(robot):
    """Tip and base exchanged."""
    c = robot.chain
    back = np.linalg.inv(c.T_zero)
    axes = -(c.axes @ back[:3, :3].T)[::-1]
    points = (c.points @ back[:3, :3].T + back[:3, 3])[::-1]
    return Likeness(
        arm_of(robot.joint_types[::-1], axes, points, back),
        np.linalg.inv,
        lambda q: q[..., ::-1],
        lambda q: q[..., ::-1],
    )


def shifted(robot, q_zero):
    """Another configuration called zero."""
    c, n = robot.chain, robot.dof
    axes, points = np.empty((n, 3)), np.empty((n, 3))
    for i in range(n):
        # What the joints before i do: the tip of the arm cut off there, held to the base.
        T = (
            np.eye(4)
            if i == 0
            else arm_of(robot.joint_types[:i], c.axes[:i], c.points[:i], np.eye(4)).fk(q_zero[:i])
        )
        axes[i], points[i] = T[:3, :3] @ c.axes[i], T[:3, :3] @ c.points[i] + T[:3, 3]
    moved = arm_of(robot.joint_types, axes, points, robot.fk(q_zero))
    return Likeness(moved, same, lambda q: q - q_zero, lambda q: q + q_zero)


def mounted(robot, T_world_base, T_tip_tool):
    """On another base, with a tool."""
    other = robot.with_base(T_world_base).with_tool(T_tip_tool)
    return Likeness(other, lambda T: T_world_base @ T @ T_tip_tool, same, same)


def drawn_otherwise(robot, rng):
    """Axes that point the other way and points that lie elsewhere on their axes."""
    c = robot.chain
    sign = rng.choice([-1.0, 1.0], robot.dof)
    points = c.points + rng.uniform(-1, 1, (robot.dof, 1)) * c.axes
    return Likeness(
        arm_of(robot.joint_types, sign[:, None] * c.axes, points, c.T_zero),
        same,
        lambda q: sign * q,
        lambda q: sign * q,
    )


LIKENESSES = {
    "a thousandth": lambda robot, rng: scaled(robot, 1e-3),
    "a thousandfold": lambda robot, rng: scaled(robot, 1e3),
    "mirrored": lambda robot, rng: mirrored(robot),
    "reversed": lambda robot, rng: reversed_(robot),
    "another zero": lambda robot, rng: shifted(robot, rng.uniform(-1, 1, robot.dof)),
    "mounted": lambda robot, rng: mounted(robot, random_pose(rng), random_pose(rng, 0.3)),
    "drawn otherwise": drawn_otherwise,
}


def random_configurations(robot, rng, n):
    slides = slides_of(robot)
    return np.where(slides, rng.uniform(-1, 1, (n, robot.dof)), rng.uniform(-np.pi, np.pi, (n, robot.dof)))


def round_configurations(robot, rng, n):
    """Turns at multiples of 30, 45 or 90 degrees, slides at zero or round lengths, among random ones."""
    slides = slides_of(robot)
    steps = np.where(slides, rng.choice([0.25, 0.5, np.inf], (n, 1)), np.pi / rng.choice([2, 4, 6], (n, 1)))
    q = random_configurations(robot, rng, n)
    rounded = np.where(
        ~np.isfinite(steps),
        0,
        np.where(np.isfinite(steps), steps, 0) * np.round(q / np.where(np.isfinite(steps), steps, 1)),
    )
    return np.where(rng.random((n, robot.dof)) < rng.choice([0.3, 0.7, 1], (n, 1)), rounded, q)


def gap(robot, a, b, length=1.0):
    """Largest difference of configurations, turns on the circle [rad], slides in units of length."""
    d = np.asarray(a) - b
    slides = slides_of(robot)
    return np.abs(np.where(slides, d / length, (d + np.pi) % (2 * np.pi) - np.pi)).max(axis=-1, initial=0)


def size_of(robot):
    """How far axes and tip lie apart at zero."""
    c = robot.chain
    return max(np.abs(np.vstack([c.points, c.T_zero[:3, 3]]) - c.points[0]).max(), 1e-6)


def weakest(robot, q):
    """The smallest singular value of the Jacobian of each q, lengths in units of the arm."""
    J = np.array(robot.jacobian(q))
    J[..., :3, :] /= size_of(robot)
    J = np.where(slides_of(robot), J * size_of(robot), J)
    return np.linalg.svd(J, compute_uv=False)[..., -1]
