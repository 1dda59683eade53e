"""Trajectories: motions in time, their derivatives, and checks against the limits of joints."""

from cspace.trajectory.limit_check import BindingLimit, TrajectoryCheck, Violation
from cspace.trajectory.move_to import move_to
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.state_to_state import TrajectoryBatch, state_to_state
from cspace.trajectory.trajectory import Extremes, JoinedTrajectory, Samples, Trajectory
from cspace.trajectory.trajectory_files import from_csv, from_json, to_csv, to_json, to_ros

__all__ = [
    "BindingLimit",
    "Extremes",
    "JoinedTrajectory",
    "PolynomialTrajectory",
    "Samples",
    "Trajectory",
    "TrajectoryBatch",
    "TrajectoryCheck",
    "Violation",
    "from_csv",
    "from_json",
    "move_to",
    "state_to_state",
    "to_csv",
    "to_json",
    "to_ros",
]
