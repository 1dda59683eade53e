"""Where is the hand? One call for one configuration or for thousands, for the tip or any other frame."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace import plot


def main(folder: Path) -> None:
    robot = cs.load_robot("panda")
    q = np.radians([0, -45, 0, -135, 0, 90, 45])

    T_base_tip = robot.fk(q)
    print(f"{robot.name}: {robot.dof} joints, from {robot.base} to {robot.tip}")
    print("hand at ", np.round(T_base_tip[:3, 3], 4))

    for frame in robot.frames[1:]:
        print(f"{frame:14} at", np.round(robot.fk(q, frame=frame)[:3, 3], 4))

    # A tool counts in everything: here a gripper 10 cm ahead of the flange.
    gripper = robot.with_tool(cs.pose([0.0, 0.0, 0.1]))
    print("with a tool", np.round(gripper.fk(q)[:3, 3], 4))

    plot.save(plot.robot(gripper, q, title="panda with a tool"), folder / "forward_kinematics.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
