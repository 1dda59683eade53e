"""Tracking: the branches of solutions that follow a path of poses, and where the others end."""

from cspace.ik.tracking.result import Branch, Track
from cspace.ik.tracking.track import COSTS, track

__all__ = ["COSTS", "Branch", "Track", "track"]
