"""Poses are 4×4 arrays: made from any form, chained with @, read back in any form."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace import plot


def main(folder: Path) -> None:
    # T_base_tip maps coordinates in the tip frame to coordinates in the base frame.
    T_base_tip = cs.pose([0.4, 0.1, 0.3], rpy=[0.0, np.pi / 2, 0.3])
    T_tip_camera = cs.pose([0.05, 0.0, 0.1], wxyz=[np.cos(0.4), 0.0, np.sin(0.4), 0.0])

    # Read the names from left to right: what stands next to each other cancels.
    T_base_camera = T_base_tip @ T_tip_camera

    print("camera in base, xyz :", np.round(cs.to_xyz(T_base_camera), 4))
    print("as roll, pitch, yaw :", np.round(cs.to_rpy(T_base_camera), 4))
    print("as a quaternion xyzw:", np.round(cs.to_xyzw(T_base_camera), 4))

    # A point seen by the camera, in the base; leading axes are batches everywhere.
    points_camera = np.array([[0.0, 0.0, 0.5], [0.1, 0.0, 0.5]])
    print("points in base      :", np.round(cs.transform_points(T_base_camera, points_camera), 4).tolist())
    assert np.allclose(cs.inverse_pose(T_base_camera) @ T_base_camera, np.eye(4))

    frames = [np.eye(4), T_base_tip, T_base_camera]
    plot.save(plot.frames(frames, names=["base", "tip", "camera"]), folder / "poses.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
