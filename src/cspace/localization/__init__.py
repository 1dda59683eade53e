"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

from cspace.localization.calibrate_sensor import calibrate_sensor
from cspace.localization.evaluation import PoseErrors, ate, rpe
from cspace.localization.filters import Localization, LocalizationStats, localize
from cspace.localization.graph import GraphAnswer, PoseGraph, RejectedLoop
from cspace.localization.log import Fixes, Headings, Landmarks, Log, Readings, Scans
from cspace.localization.logs import read_log, read_poses, write_poses
from cspace.localization.sensors import Compass, Gps, RangeBearing
from cspace.localization.simulate import simulate
from cspace.mobile import Odometry, TimedPoses

__all__ = [
    "Compass",
    "Fixes",
    "Gps",
    "GraphAnswer",
    "Headings",
    "Landmarks",
    "Localization",
    "LocalizationStats",
    "Log",
    "Odometry",
    "PoseErrors",
    "PoseGraph",
    "RangeBearing",
    "Readings",
    "RejectedLoop",
    "Scans",
    "TimedPoses",
    "ate",
    "calibrate_sensor",
    "localize",
    "read_log",
    "read_poses",
    "rpe",
    "simulate",
    "write_poses",
]
