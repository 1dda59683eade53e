"""Pictures of robots: every function takes `ax=None`, returns the artists it made and never calls show.

Needs the extra `[plot]` (matplotlib), which is imported when a function is first called.
"""

from __future__ import annotations

from cspace.plot.arms import robot, solutions
from cspace.plot.files import save
from cspace.plot.frames import frames
from cspace.plot.planar import manipulability, workspace

__all__ = ["frames", "manipulability", "robot", "save", "solutions", "workspace"]
