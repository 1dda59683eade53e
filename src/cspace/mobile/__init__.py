"""Mobile robots of the plane: vehicles on wheels, their odometry, its noise and its calibration."""

from cspace.mobile.arcs import arc_jacobians, drive
from cspace.mobile.calibration import Calibration, WheelCalibration, calibrate, calibrate_wheels
from cspace.mobile.noise import MotionNoise, OdometryNoise, RandomWalk, VelocityNoise
from cspace.mobile.odometry import Odometry, wheel_angles
from cspace.mobile.timed_poses import TimedPoses
from cspace.mobile.umbmark import SquareTest, umbmark
from cspace.mobile.vehicles import Car, Unicycle
from cspace.mobile.wheels import DifferentialDrive, Mecanum, Omni, Tracked, WheelBase

__all__ = [
    "Calibration",
    "Car",
    "DifferentialDrive",
    "Mecanum",
    "MotionNoise",
    "Odometry",
    "OdometryNoise",
    "Omni",
    "RandomWalk",
    "SquareTest",
    "TimedPoses",
    "Tracked",
    "Unicycle",
    "VelocityNoise",
    "WheelBase",
    "WheelCalibration",
    "arc_jacobians",
    "calibrate",
    "calibrate_wheels",
    "drive",
    "umbmark",
    "wheel_angles",
]
