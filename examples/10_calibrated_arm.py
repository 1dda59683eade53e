"""A UR5e as its controller measured it: how far the data sheet is off, and every solution all the same."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs

# What ur_calibration of ROS extracts from an arm: x, y, z [m], roll, pitch, yaw [rad] of each joint frame.
MEASURED = {
    "shoulder": (0.0, 0.0, 0.16271, 0.0, 0.0, 2e-5),
    "upper_arm": (1.8e-4, 0.0, 0.0, 1.57131, 0.0, 1e-5),
    "forearm": (-0.42517, 0.0, 0.0, 1.44e-3, -4.3e-4, 0.0),
    "wrist_1": (-0.39265, -4e-4, 0.13311, 3.03e-3, -1.19e-3, 0.0),
    "wrist_2": (-7e-6, -0.0996, 0.0, 1.5708, 0.0, 1e-6),
    "wrist_3": (1.4e-5, 0.09958, 9.5e-5, 1.57175, np.pi, np.pi),
}


def write(path: Path) -> None:
    lines = ["kinematics:"]
    for link, numbers in MEASURED.items():
        lines.append(f"  {link}:")
        keys = ("x", "y", "z", "roll", "pitch", "yaw")
        lines += [f"    {key}: {value}" for key, value in zip(keys, numbers, strict=True)]
    path.write_text("\n".join([*lines, "  hash: calib_0"]))


def main(folder: Path) -> None:
    write(folder / "my_robot_calibration.yaml")
    nominal = cs.load_robot("ur5e")
    robot = cs.load_robot("ur5e", calibration=folder / "my_robot_calibration.yaml")

    q = np.radians([20.0, -80.0, 100.0, -70.0, -60.0, 30.0])
    T = robot.fk(q)
    away = np.linalg.norm(T[:3, 3] - nominal.fk(q)[:3, 3])
    print(f"the data sheet puts the tool {1e3 * away:.2f} mm away")

    # The nominal arm's solutions miss by as much; those of the measured arm do not.
    for name, arm in (("nominal", nominal), ("measured", robot)):
        solutions = arm.ik(T)
        miss = np.linalg.norm(robot.fk(solutions.q)[:, :3, 3] - T[:3, 3], axis=1)
        print(f"{name}: {len(solutions)} solutions, the tool misses by up to {1e3 * miss.max():.3g} mm")

    solutions = robot.ik(T)
    assert solutions.complete
    assert np.abs(solutions.q - q).max(axis=1).min() < 1e-6


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
