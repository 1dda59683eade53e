"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

from cspace.localization.graph import GraphAnswer, PoseGraph, RejectedLoop
from cspace.localization.log import Fixes, Headings, Landmarks, Log, Readings, Scans
from cspace.localization.logs import read_log
from cspace.mobile import Odometry, TimedPoses

__all__ = [
    "Fixes",
    "GraphAnswer",
    "Headings",
    "Landmarks",
    "Log",
    "Odometry",
    "PoseGraph",
    "Readings",
    "RejectedLoop",
    "Scans",
    "TimedPoses",
    "read_log",
]
