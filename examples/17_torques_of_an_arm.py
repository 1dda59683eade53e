"""What a Panda's joints hold at rest, what a motion costs them, and how a payload changes both."""

import numpy as np

import cspace as cs

robot = cs.load_robot("panda")
q = np.radians([0, -45, 0, -135, 0, 90, 45])
print("holds", robot.gravity_torques(q).round(2), "N·m at rest")

loaded = robot.with_payload(2.0, com=(0, 0, 0.05))
print("with 2 kg", loaded.gravity_torques(q).round(2), "N·m")
lever = loaded.gravity_torques(q) - robot.gravity_torques(q)
J = robot.jacobian(q, point=(0, 0, 0.05))
assert np.allclose(lever, J[2] * 2.0 * 9.81)  # the weight of the payload at its point

rng = np.random.default_rng(0)
qd, qdd = rng.normal(size=(2, robot.dof))
tau = robot.inverse_dynamics(q, qd, qdd)
print("a motion takes", tau.round(2), "N·m")
assert np.allclose(robot.forward_dynamics(q, qd, tau), qdd)

# Free of torques and friction the arm falls, and its energy stays: Ė = 0 along the motion.
fall = robot.forward_dynamics(q, qd, np.zeros(robot.dof), friction=False)
h = 1e-6
energy = [
    robot.kinetic_energy(q + s * h * qd, qd + s * h * fall) + robot.potential_energy(q + s * h * qd)
    for s in (-1, 1)
]
print(f"energy {np.mean(energy):.3f} J, changing by {(energy[1] - energy[0]) / (2 * h):.1e} W")
assert abs(energy[1] - energy[0]) / (2 * h) < 1e-3
