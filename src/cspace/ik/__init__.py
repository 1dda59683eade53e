"""Inverse kinematics: which joint values bring the tip to a goal."""

from cspace.ik import subproblems

__all__ = ["subproblems"]
