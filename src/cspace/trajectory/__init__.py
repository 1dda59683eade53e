"""Trajectories: motions in time, their derivatives, and checks against the limits of joints."""

from cspace.trajectory.cartesian_makers import arc_path, line_path, pose_path, screw_path
from cspace.trajectory.cartesian_path import CartesianPath, CartesianPiece
from cspace.trajectory.limit_check import BindingLimit, TrajectoryCheck, Violation
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.trajectory import Extremes, JoinedTrajectory, Samples, Trajectory

__all__ = [
    "BindingLimit",
    "CartesianPath",
    "CartesianPiece",
    "Extremes",
    "JoinedTrajectory",
    "PolynomialTrajectory",
    "Samples",
    "Trajectory",
    "TrajectoryCheck",
    "Violation",
    "arc_path",
    "line_path",
    "pose_path",
    "screw_path",
]
