"""Poses: planar and spatial displacements and every way to write their rotations, as arrays."""

from cspace.spatial.checks import as_pose, as_pose_2d, as_rotation, as_rotation_2d
from cspace.spatial.poses import (
    inverse_pose,
    pose,
    rotation,
    to_xyz,
    transform_directions,
    transform_points,
)
from cspace.spatial.quaternions import to_wxyz, to_xyzw
from cspace.spatial.rotations import exp_so3, hat_so3, log_so3, to_axis_angle, to_rotvec, vee_so3
from cspace.spatial.sequences import SEQUENCES, to_euler, to_fixed, to_rpy

__all__ = [
    "SEQUENCES",
    "as_pose",
    "as_pose_2d",
    "as_rotation",
    "as_rotation_2d",
    "exp_so3",
    "hat_so3",
    "inverse_pose",
    "log_so3",
    "pose",
    "rotation",
    "to_axis_angle",
    "to_euler",
    "to_fixed",
    "to_rotvec",
    "to_rpy",
    "to_wxyz",
    "to_xyz",
    "to_xyzw",
    "transform_directions",
    "transform_points",
    "vee_so3",
]
