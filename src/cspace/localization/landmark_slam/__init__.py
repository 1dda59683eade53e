"""SLAM of landmarks: an extended Kalman filter on pose and landmarks, and particles with maps of their own."""

from cspace.localization.landmark_slam.answer import LandmarkSlam, LandmarkSlamStats
from cspace.localization.landmark_slam.filters import EkfSlam, FastSlam
from cspace.localization.landmark_slam.front import run_ekf_slam, run_fast_slam
from cspace.localization.landmark_slam.outcomes import ReadingOutcomes

__all__ = [
    "EkfSlam",
    "FastSlam",
    "LandmarkSlam",
    "LandmarkSlamStats",
    "ReadingOutcomes",
    "run_ekf_slam",
    "run_fast_slam",
]
