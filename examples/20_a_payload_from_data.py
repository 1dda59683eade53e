"""What an arm carries is found from the torques of a motion: mass, centre and inertia, by least squares."""

import numpy as np

import cspace as cs
from cspace.dynamics import ComputedTorque

MASS, CENTER = 1.7, np.array([0.03, -0.02, 0.08])
arm = cs.load_robot("panda")
loaded = arm.with_payload(MASS, com=CENTER, inertia=np.diag([4e-3, 3e-3, 2e-3]))

# The loaded arm follows sines, with torques that know nothing of the payload.
rng = np.random.default_rng(4)
start = arm.named_poses["ready"]
size, speed = rng.uniform(0.2, 0.4, 7), rng.uniform(2, 5, 7)


def wave(t):
    phase = speed * t
    return start + size * np.sin(phase), size * speed * np.cos(phase), -size * speed**2 * np.sin(phase)


def control(t, q, qd):
    return ComputedTorque(wave, kp=400, kd=40)(arm, t, q, qd)


run = loaded.simulate(start, size * speed, control=control, duration=4.0, dt=2e-3, every=10)
qdd = loaded.forward_dynamics(run.q, run.qd, run.tau)
noise = 0.05 * rng.normal(size=run.tau.shape)  # of the sensors [N·m]

# The payload adds Y π to the torques, π its mass, first and second moments. Points of 1 kg at ±p have
# opposite first and equal second moments.
base = arm.inverse_dynamics(run.q, run.qd, qdd)


def torques_of(point):
    return arm.with_payload(1.0, com=point).inverse_dynamics(run.q, run.qd, qdd) - base


axes = np.eye(3)
pairs = [
    (torques_of(p), torques_of(-p)) for p in (*axes, axes[0] + axes[1], axes[0] + axes[2], axes[1] + axes[2])
]
first = [(ahead - behind) / 2 for ahead, behind in pairs[:3]]
second = [(ahead + behind) / 2 - torques_of(np.zeros(3)) for ahead, behind in pairs]
Y = np.stack([torques_of(np.zeros(3)), *first, *second], axis=-1)
found, *_ = np.linalg.lstsq(Y.reshape(-1, 10), (run.tau + noise - base).ravel(), rcond=None)
mass, center = found[0], found[1:4] / found[0]
print(f"mass {mass:.3f} kg (true {MASS}), centre {center.round(4)} m (true {CENTER})")
assert abs(mass - MASS) < 0.02
assert np.abs(center - CENTER).max() < 2e-3
