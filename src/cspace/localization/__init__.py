"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

from cspace.localization.calibrate_sensor import calibrate_sensor
from cspace.localization.filters import Localization, LocalizationStats, localize
from cspace.localization.graph import GraphAnswer, PoseGraph, RejectedLoop
from cspace.localization.landmark_slam import (
    EkfSlam,
    FastSlam,
    LandmarkSlam,
    LandmarkSlamStats,
    ReadingOutcomes,
    run_ekf_slam,
    run_fast_slam,
)
from cspace.localization.log import Fixes, Headings, Landmarks, Log, Readings, Scans
from cspace.localization.logs import read_log
from cspace.localization.sensors import Compass, Gps, RangeBearing
from cspace.localization.simulate import simulate
from cspace.mobile import Odometry, TimedPoses

__all__ = [
    "Compass",
    "EkfSlam",
    "FastSlam",
    "Fixes",
    "Gps",
    "GraphAnswer",
    "Headings",
    "LandmarkSlam",
    "LandmarkSlamStats",
    "Landmarks",
    "Localization",
    "LocalizationStats",
    "Log",
    "Odometry",
    "PoseGraph",
    "RangeBearing",
    "ReadingOutcomes",
    "Readings",
    "RejectedLoop",
    "Scans",
    "TimedPoses",
    "calibrate_sensor",
    "localize",
    "read_log",
    "run_ekf_slam",
    "run_fast_slam",
    "simulate",
]
