"""How far estimated poses are from true ones: absolute and relative errors of trajectories."""

from cspace.localization.evaluation.pose_errors import PoseErrors, ate, rpe

__all__ = ["PoseErrors", "ate", "rpe"]
