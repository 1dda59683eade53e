"""How the tip moves with the joints, and where an arm loses a freedom."""

from __future__ import annotations

import numpy as np

import cspace as cs
from cspace import kinematics


def main() -> None:
    robot = cs.load_robot("ur5e")
    q = np.array([0.2, -1.2, 1.4, -0.5, 0.9, 0.1])

    # Rows are [v; omega] in the base; a small step of the joints moves the tip by J dq.
    J = robot.jacobian(q)
    dq = 1e-6 * np.array([1.0, -2.0, 0.5, 1.0, 0.0, 3.0])
    moved = robot.fk(q + dq)[:3, 3] - robot.fk(q)[:3, 3]
    print("J dq       :", J[:3] @ dq)
    print("true motion:", moved)
    assert np.allclose(J[:3] @ dq, moved, atol=1e-10)

    # Straighten the wrist step by step: the smallest singular value falls to zero with it.
    for q5 in (0.9, 0.3, 0.1, 0.01, 0.0):
        q[4] = q5
        print(f"q5 = {q5:4}: {kinematics.singularity(robot, q)}")
    assert kinematics.singularity(robot, q), "a straight wrist is singular"

    # A whole batch at once: how far from singular are random configurations?
    many = robot.random_configuration(1000, rng=7)
    distance = kinematics.distance_to_singularity(robot, many)
    print(f"median of {len(many)}: {np.median(distance):.3f}, nearest {distance.min():.4f}")


if __name__ == "__main__":
    main()
