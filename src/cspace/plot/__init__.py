"""Pictures of robots, worlds and routes: every function takes `ax=None`, returns the artists it made and
never calls show.

Needs the extra `[plot]` (matplotlib), which is imported when a function is first called.
"""

from __future__ import annotations

from cspace.plot.animations import animation
from cspace.plot.arms import robot, solutions
from cspace.plot.configuration_space import configuration_space
from cspace.plot.fields import surface
from cspace.plot.files import save
from cspace.plot.frames import frames
from cspace.plot.localization_runs import run
from cspace.plot.mechanisms import mechanism
from cspace.plot.particles import particles
from cspace.plot.planar import manipulability, workspace
from cspace.plot.plans import plan
from cspace.plot.pose_graphs import graph
from cspace.plot.scenes import collision, scene
from cspace.plot.simulations import simulation
from cspace.plot.space_slices import space_projection, space_slice
from cspace.plot.torques import torques
from cspace.plot.trajectories import trajectory
from cspace.plot.vehicles import coverage, drive
from cspace.plot.worlds import route, routes, world

__all__ = [
    "animation",
    "frames",
    "manipulability",
    "mechanism",
    "robot",
    "route",
    "routes",
    "save",
    "solutions",
    "workspace",
]
__all__ += ["coverage", "drive", "graph", "particles", "run", "world"]
__all__ += ["collision", "configuration_space", "plan", "scene", "surface"]
__all__ += ["simulation", "space_projection", "space_slice", "torques", "trajectory"]
