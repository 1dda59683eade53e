"""Simulations beside MuJoCo and Pinocchio, from Python, in one process: benchmarks/results/simulation.json.

Usage: python benchmarks/simulation.py [--rounds 9] [--write]

The Panda of example-robot-data, its fingers fixed, without friction, limits and contact, by RK4 with steps
of a millisecond: one motion, and a batch of 256 on one thread. Pinocchio has no simulator: its aba is called
in a loop of Python. States at the end are compared first. Processor time per step and row: medians and 95th
percentiles over rounds in turns. Then the energy of a double pendulum over 400 s, and the memory of ten
thousand roll-outs (Linux).
"""

from __future__ import annotations

import argparse
import gc
import json
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from cspace import model  # noqa: E402
from oracles.example_robots import urdf_files  # noqa: E402

DT, STEPS, ROWS, ROW_STEPS = 1e-3, 1000, 256, 100
SCALE = 3 * 9.81
"""The energy of the double pendulum between its highest and its level position [J]."""

Runs = dict[str, Callable[[], Any]]


def bare_panda(folder: Path) -> Path:
    """The Panda as a file without shapes, limits and moving fingers, which all contenders read."""
    tree = ET.parse(urdf_files()["panda"])
    root = tree.getroot()
    for link in root.findall("link"):
        for part in ("visual", "collision"):
            for element in link.findall(part):
                link.remove(element)
    for joint in root.findall("joint"):
        if joint.get("type") == "prismatic":
            joint.set("type", "fixed")
        elif joint.get("type") == "revolute":
            joint.set("type", "continuous")
        for part in ("dynamics", "mimic", "safety_controller", "limit"):
            for element in joint.findall(part):
                joint.remove(element)
    ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", {"fusestatic": "true", "discardvisual": "true"})
    path = folder / "panda.urdf"
    tree.write(path)
    return path


class Case:
    """One robot in all contenders, and where it starts."""

    def __init__(self, path: Path) -> None:
        import mujoco
        import pinocchio as pin
        from mujoco import rollout

        self.mujoco, self.pin, self.rollout = mujoco, pin, rollout
        self.robot = cs.Robot.from_urdf(path, tip="panda_hand")
        self.scene = mujoco.MjModel.from_xml_path(str(path))
        self.scene.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
        self.scene.opt.timestep = DT
        self.state = mujoco.MjData(self.scene)
        self.pin_model = pin.buildModelFromUrdf(str(path))
        self.pin_data = self.pin_model.createData()
        rng = np.random.default_rng(3)
        self.q = rng.uniform(-1, 1, 7)
        self.many = rng.uniform(-1, 1, (ROWS, 7))

    def single(self) -> Runs:
        robot, mujoco, scene, state = self.robot, self.mujoco, self.scene, self.state

        def ours(method: str) -> Any:
            rest = np.zeros(7)
            run = robot.simulate(
                self.q, rest, duration=STEPS * DT, dt=DT, method=method, every=STEPS, friction=False
            )
            return run.q[-1]

        def by_mujoco() -> Any:
            mujoco.mj_resetData(scene, state)
            state.qpos[:] = self.q
            mujoco.mj_step(scene, state, nstep=STEPS)
            return state.qpos.copy()

        return {
            "cspace": lambda: ours("rk4"),
            "cspace, variational": lambda: ours("variational"),
            "mujoco": by_mujoco,
            "pinocchio": self.by_pinocchio,
        }

    def by_pinocchio(self) -> Any:
        pin, described, data, zero = self.pin, self.pin_model, self.pin_data, np.zeros(7)
        x = pin.neutral(described)
        x[0::2], x[1::2] = np.cos(self.q), np.sin(self.q)
        v, q = np.zeros(7), self.q.copy()
        for _ in range(STEPS):
            k1 = pin.aba(described, data, x, v, zero).copy()
            v2 = v + 0.5 * DT * k1
            k2 = pin.aba(described, data, pin.integrate(described, x, 0.5 * DT * v), v2, zero).copy()
            v3 = v + 0.5 * DT * k2
            k3 = pin.aba(described, data, pin.integrate(described, x, 0.5 * DT * v2), v3, zero).copy()
            v4 = v + DT * k3
            k4 = pin.aba(described, data, pin.integrate(described, x, DT * v3), v4, zero).copy()
            step = DT / 6 * (v + 2 * v2 + 2 * v3 + v4)
            x, q = pin.integrate(described, x, step), q + step
            v = v + DT / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        return q

    def batch(self) -> Runs:
        size = self.mujoco.mj_stateSize(self.scene, self.mujoco.mjtState.mjSTATE_FULLPHYSICS)
        starts = np.zeros((ROWS, size))
        starts[:, 1:8] = self.many

        def ours(method: str) -> Any:
            run = self.robot.simulate(
                self.many,
                np.zeros(7),
                duration=ROW_STEPS * DT,
                dt=DT,
                method=method,
                every=ROW_STEPS,
                friction=False,
                threads=1,
            )
            return run.q[:, -1]

        def by_mujoco() -> Any:
            states, _ = self.rollout.rollout(self.scene, self.state, starts, nstep=ROW_STEPS)
            return states[:, -1, 1:8]

        return {
            "cspace": lambda: ours("rk4"),
            "cspace, variational": lambda: ours("variational"),
            "mujoco": by_mujoco,
        }


def differences(runs: Runs) -> dict[str, float]:
    """How far each ends from our RK4 [rad]."""
    end = runs["cspace"]()
    return {name: float(np.abs(run() - end).max()) for name, run in runs.items() if name != "cspace"}


def measure(runs: Runs, rounds: int, steps: int) -> dict[str, dict[str, float]]:
    """Nanoseconds of processor time per step and row."""
    found: dict[str, list[float]] = {name: [] for name in runs}
    gc.disable()
    for _ in range(rounds):
        for name, run in runs.items():
            start = time.process_time_ns()
            run()
            found[name].append((time.process_time_ns() - start) / steps)
    gc.enable()
    return {
        name: {"median": float(np.median(times)), "p95": float(np.percentile(times, 95))}
        for name, times in found.items()
    }


def double_pendulum() -> cs.Robot:
    """Two points of 1 kg at the ends of rods of 1 m."""
    point = model.Inertial(1.0, (1, 0, 0), np.zeros((3, 3)))
    links = (model.Link("base"), model.Link("upper", point), model.Link("lower", point))
    joints = (
        model.Joint("shoulder", "continuous", "base", "upper", axis=(0, 1, 0)),
        model.Joint("elbow", "continuous", "upper", "lower", cs.pose((1, 0, 0)), axis=(0, 1, 0)),
    )
    return cs.Robot(model.Description("double pendulum", links, joints))


def measure_energy() -> dict[str, Any]:
    """Largest energy errors over 400 s from level, in units of 3mgl, and how they grow: the mean of the last
    tenth over that of the first."""
    found: dict[str, Any] = {}
    for method in ("rk4", "variational"):
        errors, growth = [], []
        for dt in (0.01, 0.005, 0.0025):
            run = double_pendulum().simulate([0, 0], [0, 0], duration=400.0, dt=dt, method=method)
            error = np.abs(run.energy - run.energy[0]) / SCALE
            tenth = len(error) // 10
            errors.append(float(error.max()))
            growth.append(float(error[-tenth:].mean() / error[:tenth].mean()))
        found[method] = {"steps": [0.01, 0.005, 0.0025], "largest": errors, "growth": growth}
    return found


MEMORY = """
import re, numpy as np, cspace as cs
from cspace.dynamics import PD
def most(): return int(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1]) * 1024
robot = cs.load_robot("panda")
q = robot.named_poses["ready"] + np.random.default_rng(0).uniform(-0.2, 0.2, (10_000, 7))
given = {"control": PD(q[0], 20.0, 5.0), "dt": 1e-3}
robot.simulate(q[:64], np.zeros(7), duration=0.01, **given)
before = most()
run = robot.simulate(q, np.zeros(7), duration=1.0, every=10, **given)
print(most() - before, sum(part.nbytes for part in (run.q, run.qd, run.tau, run.energy)))
"""


def measure_memory() -> dict[str, int]:
    """Bytes that ten thousand roll-outs of a thousand steps add to a new process, and those of the answer."""
    words = subprocess.run([sys.executable, "-c", MEMORY], capture_output=True, text=True, check=True)
    peak, answer = (int(word) for word in words.stdout.split())
    return {"peak": peak, "answer": answer}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        case = Case(bare_panda(Path(folder)))
        single, batch = case.single(), case.batch()
        results = {
            "difference": {"single": differences(single), "batch": differences(batch)},
            "single": measure(single, options.rounds, STEPS),
            "batch": measure(batch, options.rounds, ROWS * ROW_STEPS),
            "energy": measure_energy(),
            "memory": measure_memory(),
        }
    print(json.dumps(results, indent=1))
    if options.write:
        (HERE / "results/simulation.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
