"""Robots without a map: they feel or see walls, and know where they and the goal are."""

from cspace.navigation.bugs.walk import BugEvidence

__all__ = ["BugEvidence"]
