"""Moving pictures: an arm along its trajectory, a localisation; searches are in worlds.py."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import positive_number
from cspace.errors import InputError, InputTypeError
from cspace.plot import worlds
from cspace.plot.axes import space_axes
from cspace.plot.checked_arms import place_arm
from cspace.plot.files import Steps
from cspace.plot.localization_films import PICTURES, animate_run
from cspace.plot.plans import PIECES, TUBE, tip_bodies
from cspace.plot.raytrace.scene import Group, scene_of
from cspace.plot.scenes import check_scene, obstacle_groups, set_arm_stage
from cspace.robot import Robot
from cspace.trajectory import Trajectory

RATE: Final = 20.0
"""Pictures per second."""
MOST_PICTURES: Final = 600
"""Of one animation: more would take minutes to draw."""
STILL: Final = 0.6
"""Seconds at the end, so that a film that repeats shows where the arm stops."""


def animation(
    moving: Any,
    *,
    robot: Robot | None = None,
    scene: Any = None,
    ax: Any | None = None,
    frames: int | None = None,
    rate: float = RATE,
    truth: Any = None,
    world: Any = None,
    scans: Any = None,
) -> Any:
    """An arm along a trajectory, a search or a localisation as it happened: a matplotlib FuncAnimation.

    `cs.plot.save` writes it as a GIF. moving: a Trajectory, which needs its robot=, or a Route, as
    cs.navigate answers, or a localisation, whose drive grows with its ellipse. The arm is drawn by the shapes
    that collision checks take, in real time, with the path of its tip behind it. scene: obstacles around the
    arm. rate: its pictures per second. frames: of a Route, into how many pictures its events are divided; of
    a localisation its time. ax: 3-D axes, or 2-D ones of the others. Of a localisation, truth: TimedPoses;
    world: a grid or Landmarks; scans: of its log, drawn where the answer places them.
    Raises InputTypeError for other objects and a trajectory without robot, InputError for one that is not a
    motion, of another number of joints, or of too many pictures; MissingExtraError without matplotlib.
    """
    if hasattr(moving, "poses") and hasattr(moving, "times"):
        count = PICTURES if frames is None else frames
        return animate_run(moving, ax=ax, frames=count, truth=truth, world=world, scans=scans)
    if not isinstance(moving, Trajectory):
        return worlds.animation(moving, ax=ax, frames=worlds.FRAMES if frames is None else frames)
    if not isinstance(robot, Robot):
        raise InputTypeError("a trajectory moves an arm: pass robot=, as cspace.load_robot returns one")
    check_scene(scene, optional=True)
    if not moving:
        raise InputError(f"there is no motion to show: {moving.reason}")
    if moving.dof != robot.dof:
        raise InputError(f"the trajectory is of {moving.dof} joints, {robot.name} of {robot.dof}")
    per_second = positive_number(rate, "rate")
    count = int(np.ceil(moving.duration * per_second)) + 1
    if count > MOST_PICTURES:
        raise InputError(
            f"rate is {per_second:g}: {count} pictures of {moving.duration:.4g} s;"
            f" {MOST_PICTURES} are allowed, so pass {MOST_PICTURES / moving.duration:.2g} or less"
        )
    return _animate_arm(moving, robot, scene, space_axes(ax), count, per_second)


def _animate_arm(
    motion: Trajectory, robot: Robot, scene: Any, axes: Any, count: int, per_second: float
) -> Any:
    from matplotlib.animation import FuncAnimation

    times = np.linspace(0.0, motion.duration, count)
    arms = [place_arm(robot, q, scene) for q in motion(times)]
    way = motion(np.linspace(0.0, motion.duration, PIECES))
    tip = robot.fk(way)[:, :3, 3]
    set_arm_stage(axes, arms, scene, tip)
    ground = obstacle_groups(axes, scene, arms, [tip])
    radius = TUBE * arms[0].skeleton.length
    artist = scene_of(axes)
    before = list(artist.scene.groups)
    clock = axes.text2D(0.02, 0.96, "", transform=axes.transAxes, fontsize=9)

    def show(picture: int) -> list[Any]:
        at = min(picture, count - 1)
        seen = max(2, int(np.ceil(PIECES * at / max(count - 1, 1))))
        trail = Group(tip_bodies(tip[:seen], tip[:1], radius), shadow=False)
        artist.scene.groups[:] = [*before, *ground, Group(arms[at].opaque_bodies()), trail]
        artist.stale = True
        clock.set_text(f"{times[at]:.2f} s")
        return [artist, clock]

    still, interval = int(np.ceil(STILL * per_second)), 1000.0 / per_second
    film: Any = FuncAnimation(
        axes.figure, show, frames=count + still, interval=interval, blit=False, cache_frame_data=False
    )

    def step(picture: int) -> tuple[list[Any], list[Any]]:
        if picture >= count:
            return [], []
        return (show(picture), []) if picture == count - 1 else ([], show(picture))

    film.steps = Steps(count + still, interval, step)
    return film
