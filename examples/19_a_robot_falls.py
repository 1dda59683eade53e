"""An arm that nobody holds falls and keeps its energy; a controller with its gravity torques stops it."""

import numpy as np

import cspace as cs
from cspace.dynamics import PD

robot = cs.load_robot("panda")
q = robot.named_poses["ready"]
rest = np.zeros(robot.dof)

for method in ("rk4", "variational"):
    fall = robot.simulate(q, rest, duration=10.0, dt=1e-3, method=method, every=10)
    error = np.abs(fall.energy - fall.energy[0]).max()
    print(f"{fall}: energy {fall.energy[0]:.3f} J, off by at most {error:.1e} J")
    assert fall
    assert error < 1e-2 * fall.energy[0]

# The same arm adrift: its base floats, and without gravity its momentum stays.
adrift = cs.load_robot("panda", floating=True)
qd = np.concatenate([np.zeros(6), np.linspace(-1, 1, 7)])
run = adrift.simulate(q, qd, duration=5.0, dt=0.005, method="variational", gravity=(0, 0, 0))
T = run.T_world_base
linear, about_center = np.split(adrift.centroidal_momentum(run.q, run.qd, T_world_base=T), 2, axis=1)
angular = about_center + np.cross(adrift.center_of_mass(run.q, T_world_base=T), linear)  # about the origin
errors = [np.abs(each - each[0]).max() for each in (linear, angular)]
print(f"{run}: momentum off by at most {errors[0]:.1e} N·s and {errors[1]:.1e} N·m·s")
assert max(errors) < 1e-11

# A hundred falls that a controller catches, in one call.
M = robot.mass_matrix(q)
inertia = 1 / np.diagonal(np.linalg.inv(M))  # of each joint alone
starts = q + np.random.default_rng(0).uniform(-0.3, 0.3, (100, 7))
caught = robot.simulate(
    starts, rest, control=PD(q, 400 * inertia, 40 * inertia), duration=8.0, dt=1e-3, every=100
)
worst = np.abs(caught.q - q).max(axis=(0, 2))
print(f"{caught}: {worst[0]:.2f} rad off at first, {worst[-1]:.1e} rad at last")
assert worst[-1] < 1e-3
