"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

from cspace.localization.calibrate_sensor import calibrate_sensor
from cspace.localization.evaluation import PoseErrors, ate, rpe
from cspace.localization.filters import Localization, LocalizationStats, localize
from cspace.localization.graph import Certificate, GraphAnswer, IncrementalGraph, PoseGraph, RejectedLoop
from cspace.localization.landmark_slam import (
    EkfSlam,
    FastSlam,
    LandmarkSlam,
    LandmarkSlamStats,
    ReadingOutcomes,
    run_ekf_slam,
    run_fast_slam,
)
from cspace.localization.laser_slam import LaserSlam, LaserSlamStats, LoopClosure, slam
from cspace.localization.log import Fixes, Headings, Landmarks, Log, Readings, Scans
from cspace.localization.logs import read_log, read_poses, write_poses
from cspace.localization.particles import (
    FilterEvent,
    HistogramFilter,
    MapLocalization,
    MapLocalizationStats,
    ParticleFilter,
    PoseMode,
)
from cspace.localization.scans.match import ScanMatch, match_scan
from cspace.localization.scans.search import PoseModes, search_pose
from cspace.localization.sensors import Compass, Gps, LaserScanner, RangeBearing
from cspace.localization.simulate import simulate
from cspace.mobile import Odometry, TimedPoses

__all__ = [
    "Certificate",
    "Compass",
    "EkfSlam",
    "FastSlam",
    "FilterEvent",
    "Fixes",
    "Gps",
    "GraphAnswer",
    "Headings",
    "HistogramFilter",
    "IncrementalGraph",
    "LandmarkSlam",
    "LandmarkSlamStats",
    "Landmarks",
    "LaserScanner",
    "LaserSlam",
    "LaserSlamStats",
    "Localization",
    "LocalizationStats",
    "Log",
    "LoopClosure",
    "MapLocalization",
    "MapLocalizationStats",
    "Odometry",
    "ParticleFilter",
    "PoseErrors",
    "PoseGraph",
    "PoseMode",
    "PoseModes",
    "RangeBearing",
    "ReadingOutcomes",
    "Readings",
    "RejectedLoop",
    "ScanMatch",
    "Scans",
    "TimedPoses",
    "ate",
    "calibrate_sensor",
    "localize",
    "match_scan",
    "read_log",
    "read_poses",
    "rpe",
    "run_ekf_slam",
    "run_fast_slam",
    "search_pose",
    "simulate",
    "slam",
    "write_poses",
]
