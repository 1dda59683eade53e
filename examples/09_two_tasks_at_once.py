"""Seven joints, several tasks: a tool that looks down while it moves, its joints drawn to the middle."""

from __future__ import annotations

import numpy as np

import cspace as cs


def main() -> None:
    robot = cs.load_robot("panda")
    q = np.array([0.3, -0.2, 0.4, -1.9, 0.1, 1.8, 0.6])
    middle = 0.5 * (robot.limits.lower + robot.limits.upper)
    down = cs.DirectionTask(None, axis=[0, 0, 1], direction=[0, 0, -1])
    drawn = cs.PostureTask(middle)

    # Where should the joints end? A configuration that serves all tasks, and what is left of each.
    place = cs.PositionTask(None, [0.45, 0.2, 0.3])
    goal = robot.ik_tasks([place, down, drawn], q)
    print(goal.reason)
    print("the tip ends at", robot.fk(goal.q)[:3, 3].round(4))

    # How do they get there? Velocities every 10 ms, inside the limits of joints and speeds at every step.
    dt, slow = 0.01, np.full(robot.dof, 0.8)
    tasks = [
        cs.PositionTask(None, [0.45, 0.2, 0.3], gain=0.05),
        cs.DirectionTask(None, axis=[0, 0, 1], direction=[0, 0, -1], gain=0.05),
        drawn,
    ]
    for step in range(601):
        qd = robot.task_velocity(q, tasks, dt, velocity=slow)
        assert (np.abs(qd) <= slow).all()
        if step % 150 == 0:
            T = robot.fk(q)
            tilt = np.degrees(np.arccos(np.clip(-T[2, 2], -1, 1)))
            print(f"{step * dt:4.1f} s: tip {T[:3, 3].round(3)}, {tilt:5.2f} deg from straight down")
        q = q + qd * dt
        assert (q >= robot.limits.lower).all()
        assert (q <= robot.limits.upper).all()
    assert np.allclose(robot.fk(q)[:3, 3], [0.45, 0.2, 0.3], atol=1e-4)


if __name__ == "__main__":
    main()
