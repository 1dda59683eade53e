"""Cartesian motion: the joints that move a tip along lines, arcs and polylines."""

from cspace.cartesian.free_turn import follow_free_turn
from cspace.cartesian.joint_branches import JointBranch, JointBranches, follow_cartesian
from cspace.cartesian.motion import CartesianMotion, move_arc, move_cartesian, move_linear, move_through
from cspace.cartesian.redundant_path import follow_redundant

__all__ = [
    "CartesianMotion",
    "JointBranch",
    "JointBranches",
    "follow_cartesian",
    "follow_free_turn",
    "follow_redundant",
    "move_arc",
    "move_cartesian",
    "move_linear",
    "move_through",
]
