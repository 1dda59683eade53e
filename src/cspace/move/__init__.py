"""Motions of a robot: joint paths along Cartesian paths."""

from cspace.move.joint_branches import JointBranch, JointBranches, follow_cartesian

__all__ = ["JointBranch", "JointBranches", "follow_cartesian"]
