"""Coverage: a robot sweeps all of free space."""

from cspace.navigation.coverage.boustrophedon import Coverage, coverage

__all__ = ["Coverage", "coverage"]
