"""A robot of your own: written as URDF, read with cs.load_robot, asked like any other."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace import plot

URDF = """
<robot name="desk_lamp">
  <link name="foot"/> <link name="lower"/> <link name="upper"/> <link name="bulb"/>
  <joint name="turn" type="revolute">
    <parent link="foot"/> <child link="lower"/>
    <origin xyz="0 0 0.05"/> <axis xyz="0 0 1"/> <limit lower="-3" upper="3" velocity="1" effort="1"/>
  </joint>
  <joint name="lean" type="revolute">
    <parent link="lower"/> <child link="upper"/>
    <origin xyz="0 0 0.30"/> <axis xyz="0 1 0"/> <limit lower="-1.5" upper="1.5" velocity="1" effort="1"/>
  </joint>
  <joint name="stretch" type="prismatic">
    <parent link="upper"/> <child link="bulb"/>
    <origin xyz="0 0 0.20"/> <axis xyz="0 0 1"/> <limit lower="0" upper="0.2" velocity="1" effort="1"/>
  </joint>
</robot>
"""


def main(folder: Path) -> None:
    path = folder / "desk_lamp.urdf"
    path.write_text(URDF, encoding="utf-8")
    lamp = cs.load_robot(path)
    print(lamp)
    q = np.array([0.8, 0.9, 0.15])
    print("bulb at", np.round(lamp.fk(q)[:3, 3], 4))
    print("limits ", np.round(lamp.limits.lower, 2), np.round(lamp.limits.upper, 2))

    # The bulb swings around with `turn`, on a circle as wide as it is away from the axis.
    swing = lamp.fk(q + np.linspace(0, 1, 5)[:, None] * [1.0, 0.0, 0.0])[:, :2, 3]
    assert np.allclose(np.linalg.norm(swing, axis=1), 0.35 * np.sin(0.9))

    plot.save(plot.robot(lamp, q, title=lamp.name), folder / "own_urdf.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
