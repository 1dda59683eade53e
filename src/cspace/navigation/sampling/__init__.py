"""Random points of free space, joined where they see each other."""

from cspace.navigation.sampling.problem import Sampled

__all__ = ["Sampled"]
