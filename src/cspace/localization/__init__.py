"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

from cspace.localization.calibrate_sensor import calibrate_sensor
from cspace.localization.filters import Localization, LocalizationStats, localize
from cspace.localization.log import Fixes, Headings, Landmarks, Log, Readings, Scans
from cspace.localization.logs import read_log
from cspace.localization.sensors import Compass, Gps, RangeBearing
from cspace.localization.simulate import simulate
from cspace.mobile import Odometry, TimedPoses

__all__ = [
    "Compass",
    "Fixes",
    "Gps",
    "Headings",
    "Landmarks",
    "Localization",
    "LocalizationStats",
    "Log",
    "Odometry",
    "RangeBearing",
    "Readings",
    "Scans",
    "TimedPoses",
    "calibrate_sensor",
    "localize",
    "read_log",
    "simulate",
]
