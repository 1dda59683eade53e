"""Trajectories: paths, motions in time, and checks against the limits of joints."""

from cspace.trajectory.blends import blend
from cspace.trajectory.cartesian_makers import arc_path, line_path, pose_path, screw_path
from cspace.trajectory.cartesian_path import CartesianPath, CartesianPiece
from cspace.trajectory.fit_path import fit_path
from cspace.trajectory.jerk_timed_path import JerkTimedPath
from cspace.trajectory.json_files import from_json, to_json
from cspace.trajectory.limit_check import BindingLimit, TrajectoryCheck, Violation
from cspace.trajectory.path import Path
from cspace.trajectory.point_to_point import move_to
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.ros_files import from_ros, to_ros
from cspace.trajectory.splines import b_spline, spline
from cspace.trajectory.state_to_state import TrajectoryBatch, state_to_state
from cspace.trajectory.time_parametrize import time_parametrize
from cspace.trajectory.timed_motion import TimedMotion
from cspace.trajectory.timed_path import SlowStretch, TimedPath
from cspace.trajectory.trajectory import Extremes, JoinedTrajectory, Samples, Trajectory
from cspace.trajectory.trajectory_files import from_csv, to_csv

__all__ = [
    "BindingLimit",
    "CartesianPath",
    "CartesianPiece",
    "Extremes",
    "JerkTimedPath",
    "JoinedTrajectory",
    "Path",
    "PolynomialTrajectory",
    "Samples",
    "SlowStretch",
    "TimedMotion",
    "TimedPath",
    "Trajectory",
    "TrajectoryBatch",
    "TrajectoryCheck",
    "Violation",
    "arc_path",
    "b_spline",
    "blend",
    "fit_path",
    "from_csv",
    "from_json",
    "from_ros",
    "line_path",
    "move_to",
    "pose_path",
    "screw_path",
    "spline",
    "state_to_state",
    "time_parametrize",
    "to_csv",
    "to_json",
    "to_ros",
]
