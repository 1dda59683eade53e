"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

from cspace.localization.calibrate_sensor import calibrate_sensor
from cspace.localization.filters import Localization, LocalizationStats, localize
from cspace.localization.graph import Certificate, GraphAnswer, IncrementalGraph, PoseGraph, RejectedLoop
from cspace.localization.log import Fixes, Headings, Landmarks, Log, Readings, Scans
from cspace.localization.logs import read_log
from cspace.localization.sensors import Compass, Gps, RangeBearing
from cspace.localization.simulate import simulate
from cspace.mobile import Odometry, TimedPoses

__all__ = [
    "Certificate",
    "Compass",
    "Fixes",
    "Gps",
    "GraphAnswer",
    "Headings",
    "IncrementalGraph",
    "Landmarks",
    "Localization",
    "LocalizationStats",
    "Log",
    "Odometry",
    "PoseGraph",
    "RangeBearing",
    "Readings",
    "RejectedLoop",
    "Scans",
    "TimedPoses",
    "calibrate_sensor",
    "localize",
    "read_log",
    "simulate",
]
