"""Draws the figures of the page on simulation: `python docs/figures/simulation.py` writes them here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs
from cspace import model

HERE = Path(__file__).parent
SCALE = 3 * 9.81
"""The energy of a double pendulum between its highest and its level position [J]."""


def double_pendulum() -> cs.Robot:
    """Two points of 1 kg at the ends of rods of 1 m."""
    point = model.Inertial(1.0, (1, 0, 0), np.zeros((3, 3)))
    links = (model.Link("base"), model.Link("upper", point), model.Link("lower", point))
    joints = (
        model.Joint("shoulder", "continuous", "base", "upper", axis=(0, 1, 0)),
        model.Joint("elbow", "continuous", "upper", "lower", cs.pose((1, 0, 0)), axis=(0, 1, 0)),
    )
    return cs.Robot(model.Description("double pendulum", links, joints))


def brick() -> cs.Robot:
    """A free body with three different moments of inertia."""
    body = model.Inertial(1.0, (0, 0, 0), np.diag([1.0, 2.0, 3.0]))
    return cs.Robot(model.Description("brick", (model.Link("body", body),), ()), floating=True)


def semi_implicit_euler(robot: cs.Robot, dt: float, steps: int) -> np.ndarray:
    """The energies of the method that many simulators use: q̇ ← q̇ + h q̈(q, q̇), then q ← q + h q̇."""
    q, qd = np.zeros(2), np.zeros(2)
    energy = np.zeros(steps + 1)
    for k in range(steps):
        qd = qd + dt * robot.forward_dynamics(q, qd, np.zeros(2))
        q = q + dt * qd
        energy[k + 1] = float(robot.kinetic_energy(q, qd) + robot.potential_energy(q))
    return energy


def running_maximum(energy: np.ndarray) -> np.ndarray:
    """The largest error of the energy so far."""
    return np.maximum.accumulate(np.abs(energy - energy[0])) / SCALE


def draw_energy(ax: Any) -> None:
    """The energy error of the methods over time, at the same step."""
    robot, dt, duration = double_pendulum(), 0.01, 200.0
    times = np.arange(round(duration / dt) + 1) * dt
    runs = {
        "semi-implicit Euler (not in cspace)": semi_implicit_euler(robot, dt, len(times) - 1),
        **{
            method: robot.simulate([0, 0], [0, 0], duration=duration, dt=dt, method=method).energy
            for method in ("variational", "rk4")
        },
    }
    for (name, energy), color in zip(runs.items(), ("0.55", "tab:blue", "tab:orange"), strict=True):
        ax.loglog(times[1:], np.maximum(running_maximum(energy)[1:], 1e-12), label=name, color=color)
    ax.set(
        xlabel="time [s]", ylabel="largest energy error / 3 m g l", title="double pendulum, steps of 10 ms"
    )
    ax.set_xlim(0.1, duration)
    ax.set_ylim(1e-9, 10)
    ax.legend(loc="lower right", fontsize=8)
    ax.grid(alpha=0.3)


def draw_spin(ax: Any) -> None:
    """The angular velocity of a body that spins about its middle axis, in its own axes."""
    spin = np.array([0, 0, 0, 1e-3, 5.0, 0])
    run = brick().simulate([], spin, duration=12.0, dt=0.01, method="variational", gravity=np.zeros(3))
    assert run.T_world_base is not None
    spins = np.einsum("kij,ki->kj", run.T_world_base[:, :3, :3], run.qd[:, 3:])
    for values, name in zip(spins.T, ("least", "middle", "greatest"), strict=True):
        ax.plot(run.times, values, label=f"axis of {name} inertia")
    ax.set(xlabel="time [s]", ylabel="angular velocity [rad/s]", title="a free body turns over, variational")
    ax.legend(loc="center", bbox_to_anchor=(0.57, 0.3), fontsize=8)
    ax.grid(alpha=0.3)


def draw_roll_outs(ax: Any) -> None:
    """Double pendulums that a controller brings from many starts to one goal."""
    goal, starts = np.array([0.5, -1.0]), np.random.default_rng(1).normal(size=(60, 2)) * 1.5
    control = cs.dynamics.PD(goal, kp=40, kd=25)
    run = double_pendulum().simulate(starts, [0, 0], control=control, duration=10.0, dt=0.01)
    ax.plot(*run.q.transpose(2, 1, 0), color="tab:blue", linewidth=0.6, alpha=0.7)
    ax.plot(*starts.T, ".", color="0.4", markersize=4, label="starts")
    ax.plot(*goal, "o", color="tab:red", markersize=6, label="goal")
    ax.set(xlabel="shoulder [rad]", ylabel="elbow [rad]", title="60 roll-outs under PD with gravity")
    ax.legend(loc="upper left", fontsize=8)
    ax.grid(alpha=0.3)


def draw_friction(ax: Any) -> None:
    """The velocity of a rotor with stiff damping at steps far longer than its decay time."""
    links = (model.Link("base"), model.Link("disk", model.Inertial(1.0, (0, 0, 0), 0.2 * np.eye(3))))
    for damping, color in ((1.0, "tab:blue"), (10.0, "tab:orange"), (100.0, "tab:green")):
        joint = model.Joint("axis", "continuous", "base", "disk", axis=(0, 0, 1), damping=damping)
        rotor = cs.Robot(model.Description("rotor", links, (joint,)))
        run = rotor.simulate([0], [1.0], duration=0.5, dt=0.05, method="variational")
        exact = np.linspace(0, 0.5, 400)
        ax.plot(exact, np.exp(-damping / 0.2 * exact), color=color, linewidth=1.0)
        ax.plot(run.times, run.qd[:, 0], "o", color=color, markersize=4, label=f"{damping:g} N m s")
    ax.set(xlabel="time [s]", ylabel="velocity [rad/s]", title="damping, variational, steps of 50 ms")
    ax.legend(loc="upper right", fontsize=8)
    ax.grid(alpha=0.3)


def draw_motion() -> None:
    """A Panda that a controller brings to a goal, with a payload that the controller does not know."""
    robot = cs.load_robot("panda")
    loaded = robot.with_payload(2.0)
    start, goal = np.array([0, -0.785, 0, -2.356, 0, 1.571, 0.785]), np.array([1, 0, 0.3, -1.571, 0, 2, 0])
    inertia = 1 / np.diagonal(np.linalg.inv(robot.mass_matrix(start)))

    def control(t: float, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        return inertia * (100 * (goal - q) - 20 * qd) + robot.gravity_torques(q)

    run = loaded.simulate(start, np.zeros(7), control=control, duration=2.0, dt=0.002)
    title = "panda with 2 kg more than its controller knows"
    cs.plot.save(cs.plot.simulation(run, robot=loaded, title=title), HERE / "simulated_motion.png", dpi=110)


def main() -> None:
    draw_motion()
    for name, left, right in (
        ("simulation.png", draw_energy, draw_spin),
        ("simulation_control.png", draw_roll_outs, draw_friction),
    ):
        figure, axes = plt.subplots(1, 2, figsize=(9.6, 3.8), dpi=110, layout="constrained")
        left(axes[0])
        right(axes[1])
        cs.plot.save(figure, HERE / name)


if __name__ == "__main__":
    main()
