"""Readers of logs: CARMEN, MRCLAM, Victoria Park, TUM, KITTI and CSV, told apart by their content."""

from cspace.localization.logs.pose_files import read_poses, write_poses
from cspace.localization.logs.read_log import read_log

__all__ = ["read_log", "read_poses", "write_poses"]
