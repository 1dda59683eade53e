"""A four-bar over a full turn of its crank: assembly modes, dead points of its rocker, torques."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs
from cspace.mechanisms import FourBar

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
linkage = FourBar(ground=1.0, crank=0.3, coupler=0.9, rocker=0.7)
modes = linkage.assembly_modes({"crank": 0.0})
print(f"a {linkage.kind}, {linkage.dof(modes.q[0])} degree of freedom, {len(modes)} assembly modes")

# The crank goes around; the rocker turns back where crank and coupler are in line.
turns = np.linspace(0, 2 * np.pi, 361)
motion = linkage.follow({"crank": turns}, modes.q[0])
assert motion
dead = [q for q in linkage.dead_points("rocker") if q[2] > 0]
print("the rocker swings between", *(f"{q[2]:.3f} rad (crank at {q[0] % (2 * np.pi):.3f})" for q in dead))
stuck = linkage.follow({"rocker": np.linspace(motion.q[0, 2], 3, 100)}, modes.q[0])
print("driven by its rocker:", stuck.reason)

# Torques at a constant speed of the crank, and what the rocker would have to give instead.
qd = linkage.velocities(motion.q, {"crank": np.full(361, 3.0)})
qdd = linkage.accelerations(motion.q, qd, {"crank": np.zeros(361)})
crank = linkage.inverse_dynamics(motion.q, qd, qdd, ["crank"])[:, 0]
regular = np.abs(qd[:, 2]) > 0.05
rocker = np.full(361, np.nan)
rocker[regular] = linkage.inverse_dynamics(motion.q[regular], qd[regular], qdd[regular], ["rocker"])[:, 2]
assert np.allclose((crank * qd[:, 0])[regular], (rocker * qd[:, 2])[regular])  # both do the same work
largest = [np.nanmax(np.abs(tau)) for tau in (crank, rocker)]
print(f"torques: at the crank up to {largest[0]:.1f} N·m, at the rocker {largest[1]:.0f} N·m")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
cs.plot.mechanism(linkage, motion.q[::45], ax=left, title="a full turn")
right.plot(turns, crank, label="at the crank [N·m]")
right.plot(turns, rocker, label="at the rocker instead [N·m]")
for q in dead:
    right.axvline(q[0] % (2 * np.pi), color="0.6", linestyle="--")
right.set(xlabel="crank [rad]", ylim=(-40, 40))
right.legend()
figure.savefig(folder / "four_bar.png")
