"""A pendulum swings with the period of the elliptic integral, and its energy does not drift."""

import sys
from pathlib import Path

import numpy as np

import cspace as cs
from cspace import model

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
point = model.Inertial(1.0, np.array([1.0, 0.0, 0.0]), np.zeros((3, 3)))  # 1 kg at the end of a rod of 1 m
links = (model.Link("ceiling"), model.Link("rod", point))
pivot = model.Joint("pivot", "continuous", "ceiling", "rod", axis=np.array([0.0, 1.0, 0.0]))
pendulum = cs.Robot(model.Description("pendulum", links, (pivot,)))
DOWN = np.pi / 2


def period(amplitude):
    """4 √(l/g) K(sin ½ amplitude), by the arithmetic-geometric mean (Gauss 1799)."""
    a, b = 1.0, np.cos(amplitude / 2)
    for _ in range(8):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return 2 * np.pi / a / np.sqrt(9.81)


amplitudes = np.radians([5, 30, 60, 90, 120, 150, 170, 179])
run = pendulum.simulate(DOWN + amplitudes[:, None], [0], duration=8.0, dt=1e-3)  # all in one call
for amplitude, qd in zip(amplitudes, run.qd[..., 0], strict=True):
    back = np.flatnonzero((qd[:-1] > 0) & (qd[1:] <= 0))[0]  # at rest again where it began
    simulated = run.times[back] + 1e-3 * qd[back] / (qd[back] - qd[back + 1])
    exact = period(amplitude)
    print(f"{np.degrees(amplitude):4.0f}°  period {simulated:.6f} s, in theory {exact:.6f} s")
    assert abs(simulated - exact) < 1e-6

long = pendulum.simulate([0], [0], duration=600.0, dt=0.01, method="variational", every=10)
print(f"{long}; its energy stays within {np.abs(long.energy).max():.4f} J of 0")
assert np.abs(long.energy).max() < 0.01

try:
    import matplotlib as mpl
except ImportError:
    sys.exit("pip install matplotlib draws the picture")
mpl.use("Agg")
cs.plot.save(cs.plot.simulation(run), folder / "pendulum.png")
