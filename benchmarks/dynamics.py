"""Dynamics beside Pinocchio and dynibo, from Python, in one process: benchmarks/results/dynamics.json.

Usage: python benchmarks/dynamics.py [--rounds 60] [--batch 100000] [--robots panda ur5 g1] [--write]

The same URDF files with masses (package example-robot-data); the fingers of the panda are locked, the
humanoid floats. Arguments and outputs are prepared. Answers are compared first. Processor time per call:
medians and 95th percentiles over rounds in turns; batches on one thread. Pinocchio has parallel calls of
inverse and forward dynamics alone: batches of all else, as large as a cache, stand beside its single calls.
"""

from __future__ import annotations

import argparse
import gc
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from oracles.example_robots import PinocchioRobot, urdf_files  # noqa: E402

Calls = dict[str, dict[str, Callable[[], Any]]]

ROBOTS: dict[str, dict[str, Any]] = {
    "panda": {"tip": "panda_hand"},
    "ur5": {"file": "ur5_robot", "tip": "tool0"},
    "g1": {"file": "g1_29dof_rev_1_0", "floating": True},
}
CHUNK = 50
"""Calls per reading of the clock."""
MATRICES = ("mass matrix", "Coriolis matrix", "inverse derivatives", "forward derivatives", "regressor")
REPEAT = 5
"""Batches of these per reading of the clock."""
CACHE = 1 << 19
"""Bytes of answers per batch of functions that give matrices, which then stay in the second-level cache."""
LEAST = 64
"""Rows of such a batch at least."""


class Case:
    """A robot and the same robot of the peers, with random arguments."""

    def __init__(self, name: str) -> None:
        import pinocchio as pin

        options = dict(ROBOTS[name])
        self.path = urdf_files()[options.pop("file", name)]
        self.robot = cs.Robot.from_urdf(self.path, **options)
        self.oracle = PinocchioRobot(self.path, self.robot)
        locked = [
            j
            for j in self.oracle.model.names
            if j not in self.oracle.law and j not in ("universe", "root_joint")
        ]
        model = self.oracle.model
        if locked:
            ids = [model.getJointId(joint) for joint in locked]
            model = pin.buildReducedModel(model, ids, pin.neutral(model))
        self.oracle.model, self.oracle.data = model, model.createData()
        self.pin, self.model, self.data = pin, model, self.oracle.data
        rng = np.random.default_rng(5)
        n, dof, robot = len(self.robot.joint_names), self.robot.dof, self.robot
        self.q, self.qd, self.qdd = rng.uniform(-2, 2, n), *rng.normal(size=(2, dof))
        self.T = np.eye(4)
        self.frame = robot.tip or robot.leaves[0]
        self.placed = {"T_world_base": self.T} if robot.floating else {}
        self.tau = robot.inverse_dynamics(self.q, self.qd, self.qdd, friction=False, **self.placed)

    def calls(self) -> Calls:
        """Function → contender → a call of it."""
        pin, model, data, robot = self.pin, self.model, self.data, self.robot
        pin_q = self.oracle.configuration(self.q, self.T)
        S = self.oracle.velocity_map(self.T)
        v, a, tau = S @ self.qd, S @ self.qdd, np.linalg.pinv(S).T @ self.tau
        q, qd, qdd = self.q, self.qd, self.qdd
        ours, T = self.tau, self.T
        peer: dict[str, Callable[[], Any]] = {
            "inverse dynamics": lambda: pin.rnea(model, data, pin_q, v, a),
            "mass matrix": lambda: pin.crba(model, data, pin_q),
            "forward dynamics": lambda: pin.aba(model, data, pin_q, v, tau),
            "Coriolis matrix": lambda: pin.computeCoriolisMatrix(model, data, pin_q, v),
            "inverse derivatives": lambda: pin.computeRNEADerivatives(model, data, pin_q, v, a),
            "forward derivatives": lambda: pin.computeABADerivatives(model, data, pin_q, v, tau),
            "regressor": lambda: pin.computeJointTorqueRegressor(model, data, pin_q, v, a),
        }
        fixed: dict[str, Callable[[], Any]] = {
            "inverse dynamics": lambda: robot.inverse_dynamics(q, qd, qdd),
            "mass matrix": lambda: robot.mass_matrix(q),
            "forward dynamics": lambda: robot.forward_dynamics(q, qd, ours),
            "Coriolis matrix": lambda: robot.coriolis_matrix(q, qd),
            "inverse derivatives": lambda: robot.inverse_dynamics_derivatives(q, qd, qdd),
            "forward derivatives": lambda: robot.forward_dynamics_derivatives(q, qd, ours),
            "regressor": lambda: robot.regressor(q, qd, qdd),
        }
        floating: dict[str, Callable[[], Any]] = {
            "inverse dynamics": lambda: robot.inverse_dynamics(q, qd, qdd, T_world_base=T),
            "mass matrix": lambda: robot.mass_matrix(q, T_world_base=T),
            "forward dynamics": lambda: robot.forward_dynamics(q, qd, ours, T_world_base=T),
            "Coriolis matrix": lambda: robot.coriolis_matrix(q, qd, T_world_base=T),
            "inverse derivatives": lambda: robot.inverse_dynamics_derivatives(q, qd, qdd, T_world_base=T),
            "forward derivatives": lambda: robot.forward_dynamics_derivatives(q, qd, ours, T_world_base=T),
            "regressor": lambda: robot.regressor(q, qd, qdd, T_world_base=T),
        }
        own = floating if robot.floating else fixed
        calls: Calls = {task: {"pinocchio": peer[task], "cspace": own[task]} for task in peer}
        if not robot.floating:
            self.add_dynibo(calls)
        return calls

    def add_dynibo(self, calls: Calls) -> None:
        """dynibo with prepared outputs, where it reads the file and has the same joints."""
        try:
            import dynibo

            peer = dynibo.Robot.from_urdf(str(self.path))
        except Exception as error:
            return print(f"dynibo: {type(error).__name__}: {str(error)[:120]}")
        n = len(self.q)
        if peer.joint_count != n:
            return print(f"dynibo: has {peer.joint_count} joints, not {n}")
        out, q, qd, qdd, tau = np.empty(n), self.q, self.qd, self.qdd, self.tau
        calls["inverse dynamics"]["dynibo"] = lambda: peer.inverse_dynamics(q, qd, qdd, out=out)
        calls["mass matrix"]["dynibo"] = lambda: peer.mass_matrix(q)
        calls["forward dynamics"]["dynibo"] = lambda: peer.forward_dynamics(q, qd, tau, out=out)
        return None

    def batches(self, count: int) -> Calls:
        """The same for many rows on one thread."""
        pin, robot = self.pin, self.robot
        rng = np.random.default_rng(6)
        q = rng.uniform(-2, 2, (count, len(self.q)))
        qd, qdd = rng.normal(size=(2, count, robot.dof))
        out = np.empty((count, robot.dof))
        T = {"T_world_base": self.T} if robot.floating else {}
        tau = robot.inverse_dynamics(q, qd, qdd, **T)
        S = self.oracle.velocity_map(self.T)
        pin_q = np.asfortranarray(np.array([self.oracle.configuration(row, self.T) for row in q]).T)
        v, a, force = (np.asfortranarray(S @ row.T) for row in (qd, qdd, tau))
        result = np.empty_like(v, order="F")
        pool = pin.ModelPool(self.model, 1)
        wrench = {self.frame: np.random.default_rng(7).normal(size=(count, 6))}
        floats: dict[str, Any] = {"threads": 1, "dtype": np.float32, **T}
        q32, qd32, qdd32, tau32 = (x.astype(np.float32) for x in (q, qd, qdd, tau))
        out32, args, loads = np.empty_like(out, dtype=np.float32), {"threads": 1, **T}, (q, qd, qdd)
        return {
            "inverse dynamics": {
                "pinocchio": lambda: pin.rneaInParallel(1, pool, pin_q, v, a, result),
                "cspace": lambda: robot.inverse_dynamics(q, qd, qdd, out=out, **args),
                "float32": lambda: robot.inverse_dynamics(q32, qd32, qdd32, out=out32, **floats),
                "wrenches": lambda: robot.inverse_dynamics(*loads, wrenches=wrench, out=out, **args),
            },
            "forward dynamics": {
                "pinocchio": lambda: pin.abaInParallel(1, pool, pin_q, v, force, result),
                "cspace": lambda: robot.forward_dynamics(q, qd, tau, out=out, **args),
                "float32": lambda: robot.forward_dynamics(q32, qd32, tau32, out=out32, **floats),
                "wrenches": lambda: robot.forward_dynamics(q, qd, tau, wrenches=wrench, out=out, **args),
            },
        }

    def matrices(self, task: str) -> tuple[int, dict[str, Callable[[], Any]]]:
        """A function that gives a matrix per row, for about so many rows as stay in the cache."""
        robot, n = self.robot, self.robot.dof
        columns = robot.regressor(self.q, self.qd, self.qdd, **self.placed).shape[1]
        size = {"regressor": columns * n}.get(task, (3 if "derivatives" in task else 1) * n * n)
        count = max(LEAST, CACHE // (8 * size) // 16 * 16)
        rng = np.random.default_rng(8)
        q = rng.uniform(-2, 2, (count, len(self.q)))
        qd, qdd = rng.normal(size=(2, count, n))
        args: dict[str, Any] = {"threads": 1, **({"T_world_base": self.T} if robot.floating else {})}
        tau = robot.inverse_dynamics(q, qd, qdd, **args)
        q32, M32 = q.astype(np.float32), np.empty((count, n, n), np.float32)
        square, three, Y = (np.empty((count, *shape)) for shape in ((n, n), (3, n, n), (n, columns)))
        data = (q, qd, qdd)
        calls: Calls = {
            "mass matrix": {
                "cspace": lambda: robot.mass_matrix(q, out=square, **args),
                "float32": lambda: robot.mass_matrix(q32, out=M32, dtype=np.float32, **args),
            },
            "Coriolis matrix": {"cspace": lambda: robot.coriolis_matrix(q, qd, out=square, **args)},
            "inverse derivatives": {
                "cspace": lambda: robot.inverse_dynamics_derivatives(*data, out=three, **args)
            },
            "forward derivatives": {
                "cspace": lambda: robot.forward_dynamics_derivatives(q, qd, tau, out=three, **args)
            },
            "regressor": {"cspace": lambda: robot.regressor(*data, out=Y, **args)},
        }
        return count, calls[task]

    def difference(self) -> float:
        """Largest difference to Pinocchio, relative to the largest torque."""
        pin, T = self.pin, self.T
        S = self.oracle.velocity_map(T)
        change = S @ self.qdd + self.oracle.velocity_map_rate(T, self.qd) @ self.qd
        tau = S.T @ pin.rnea(self.model, self.data, self.oracle.configuration(self.q, T), S @ self.qd, change)
        return float(np.abs(tau - self.tau).max() / np.abs(tau).max())


def spend(call: Callable[[], Any], repeat: int) -> float:
    """Nanoseconds of processor time per call."""
    start = time.process_time_ns()
    for _ in range(repeat):
        call()
    return (time.process_time_ns() - start) / repeat


def measure(calls: Calls, rounds: int, repeat: int) -> dict[str, dict[str, dict[str, float]]]:
    found: dict[str, dict[str, list[float]]] = {
        task: {peer: [] for peer in contenders} for task, contenders in calls.items()
    }
    gc.disable()
    for _ in range(rounds):
        for task, contenders in calls.items():
            for peer, call in contenders.items():
                found[task][peer].append(spend(call, repeat))
    gc.enable()
    return {
        task: {
            peer: {"median": float(np.median(times)), "p95": float(np.percentile(times, 95))}
            for peer, times in contenders.items()
        }
        for task, contenders in found.items()
    }


def per_row(found: dict[str, dict[str, dict[str, float]]], count: int) -> dict[str, Any]:
    """Times of a whole batch as those of one row."""
    return {
        task: {peer: {key: t / count for key, t in times.items()} for peer, times in contenders.items()}
        for task, contenders in found.items()
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--batch", type=int, default=100_000)
    parser.add_argument("--robots", nargs="+", choices=ROBOTS, default=list(ROBOTS))
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    results: dict[str, Any] = {"machine": "", "robots": {}}
    for name in options.robots:
        case, few = Case(name), max(3, options.rounds // 12)
        row = {
            "dof": case.robot.dof,
            "single": measure(case.calls(), options.rounds, CHUNK),
            "batch": per_row(measure(case.batches(options.batch), few, 1), options.batch),
            "difference": case.difference(),
        }
        for task in MATRICES:
            count, calls = case.matrices(task)
            row["batch"] |= per_row(measure({task: calls}, options.rounds, REPEAT), count)
        for task, contenders in row["batch"].items():
            contenders.setdefault("pinocchio", row["single"][task]["pinocchio"])
        results["robots"][name] = row
        print(f"{name}: {row['dof']} velocities, difference to Pinocchio {row['difference']:.1e}")
        for kind in ("single", "batch"):
            for task, contenders in row[kind].items():
                times = ", ".join(
                    f"{peer} {t['median']:.0f} ({t['p95']:.0f})" for peer, t in sorted(contenders.items())
                )
                print(f"  {kind:6} {task:19} {times} ns")
    if options.write:
        (HERE / "results/dynamics.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
