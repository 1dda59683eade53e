"""Motions of a robot: joint paths along Cartesian paths."""

from cspace.move.free_turn import follow_free_turn
from cspace.move.joint_branches import JointBranch, JointBranches, follow_cartesian
from cspace.move.redundant_path import follow_redundant

__all__ = ["JointBranch", "JointBranches", "follow_cartesian", "follow_free_turn", "follow_redundant"]
