"""A straight line for the tip: which solutions follow all of it, and where the others end."""

from __future__ import annotations

import numpy as np

import cspace as cs


def main() -> None:
    robot = cs.load_robot("crx10ia")
    ahead = (0.0, np.pi / 2, 0.0)  # the flange points along x
    first, last = cs.pose([-0.3, -0.5, -0.5], rpy=ahead), cs.pose([-0.7, -0.1, -0.2], rpy=ahead)
    poses = cs.spatial.interpolate_decoupled(first, last, np.linspace(0, 1, 200))

    # Every solution of the first pose begins a branch.
    track = robot.track(poses)
    print(track.reason)
    for branch in track:
        print(f"  {branch.name}: {branch.reason}")

    # The best one, or the one the robot is on, as one row per pose; nothing jumps from row to row.
    print("largest step of a joint:", np.degrees(np.abs(np.diff(track.q, axis=0)).max()).round(2), "deg")
    off = np.abs(robot.fk(track.q) - poses).max()
    print("every row reaches its pose:", off < 1e-12)

    # The same path, and the branch that asks for the least time at half a radian per second.
    def seconds(q: np.ndarray) -> float:
        return float((np.abs(np.diff(q, axis=0)) / 0.5).max(axis=1).sum())

    quickest = robot.track(poses, cost=seconds)
    print(f"quickest: {quickest.cost:.2f} s, shortest: {seconds(track.q):.2f} s")
    assert track
    assert quickest.cost <= seconds(track.q)


if __name__ == "__main__":
    main()
