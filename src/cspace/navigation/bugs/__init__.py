"""Bug algorithms: robots without a map that sense walls, and know their own position and the goal's."""

from cspace.navigation.bugs.voronoi_bug import VoronoiBug, VoronoiBugEvidence
from cspace.navigation.bugs.wall_followers import Bug1, Bug2, BugEvidence, TangentBug

__all__ = ["Bug1", "Bug2", "BugEvidence", "TangentBug", "VoronoiBug", "VoronoiBugEvidence"]
