"""Random points of free space, joined where they are mutually visible."""

from cspace.navigation.sampling.planners import PRM, RRT, RRTStar, Sampled

__all__ = ["PRM", "RRT", "RRTStar", "Sampled"]
