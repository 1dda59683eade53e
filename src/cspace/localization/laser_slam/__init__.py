"""SLAM with a laser: matched scans, loops, and a pose graph."""

from cspace.localization.laser_slam.answer import LaserSlam, LaserSlamStats, LoopClosure
from cspace.localization.laser_slam.front import slam

__all__ = ["LaserSlam", "LaserSlamStats", "LoopClosure", "slam"]
