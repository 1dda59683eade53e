"""Forward kinematics and Jacobians of one arm beside Pinocchio, interleaved in one process.

Usage: python benchmarks/kinematics.py [--rounds 200] [--batch 20000]
Both are called as a person would call them from Python, on the same arm; their answers are compared first.
Medians and 95th percentiles of processor time, over rounds that alternate between the two.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import cspace as cs
from cspace.model import to_urdf

ARM = "ur5e"


def pinocchio_calls(robot: cs.Robot, q: np.ndarray) -> dict[str, Callable[[], object]]:
    """What Pinocchio does for the same questions, with the pose and the Jacobian as arrays."""
    import pinocchio as pin

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        path.write_text(to_urdf(robot.description), encoding="utf-8")
        model = pin.buildModelFromUrdf(str(path))
    data, frame = model.createData(), model.getFrameId(robot.tip)
    axes = pin.LOCAL_WORLD_ALIGNED

    def fk() -> object:
        pin.forwardKinematics(model, data, q)
        return pin.updateFramePlacement(model, data, frame).homogeneous

    def jacobian() -> object:
        return pin.computeFrameJacobian(model, data, q, frame, axes)

    def both() -> object:
        J = pin.computeFrameJacobian(model, data, q, frame, axes)
        return pin.updateFramePlacement(model, data, frame).homogeneous, J

    return {"fk": fk, "jacobian": jacobian, "fk_jacobian": both}


def seconds_per_call(call: Callable[[], object], repeats: int) -> float:
    """Processor time: what others do on the machine does not count."""
    start = time.process_time()
    for _ in range(repeats):
        call()
    return (time.process_time() - start) / repeats


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=200)
    parser.add_argument("--batch", type=int, default=20_000)
    options = parser.parse_args()

    robot = cs.load_robot(ARM)
    q = robot.random_configuration(rng=1)
    ours = {
        "fk": lambda: robot.fk(q),
        "jacobian": lambda: robot.jacobian(q),
        "fk_jacobian": lambda: robot.fk_jacobian(q),
    }
    theirs = pinocchio_calls(robot, q)
    T, J = theirs["fk_jacobian"]()
    assert np.allclose(ours["fk"](), T, atol=1e-12)
    assert np.allclose(ours["jacobian"](), J, atol=1e-12)

    many = robot.random_configuration(options.batch, rng=2)
    out = (np.empty((options.batch, 4, 4)), np.empty((options.batch, 6, robot.dof)))
    batch = {
        "fk_jacobian, batch, out=": lambda: robot.fk_jacobian(many, out=out, threads=1),
        "fk_jacobian, batch, fresh": lambda: robot.fk_jacobian(many, threads=1),
    }
    samples: dict[tuple[str, str], list[float]] = {}
    for _ in range(options.rounds):
        for name in ours:
            samples.setdefault((name, "cspace"), []).append(seconds_per_call(ours[name], 1000))
            samples.setdefault((name, "pinocchio"), []).append(seconds_per_call(theirs[name], 1000))
        for name, call in batch.items():
            samples.setdefault((name, "cspace"), []).append(seconds_per_call(call, 5) / options.batch)

    print(f"{ARM}, {options.rounds} rounds, ns per configuration\n")
    print(f"| {'what':26} | {'who':9} | {'median':>7} | {'p95':>7} | {'least':>7} | ratio of medians |")
    print("|---|---|---|---|---|---|")
    for (name, who), values in samples.items():
        median, late, least = (float(x) * 1e9 for x in (*np.percentile(values, [50, 95]), min(values)))
        peer = samples.get((name, "cspace"))
        ratio = f"{np.median(values) / np.median(peer):.2f}" if who != "cspace" and peer else ""
        print(f"| {name:26} | {who:9} | {median:7.1f} | {late:7.1f} | {least:7.1f} | {ratio} |")


if __name__ == "__main__":
    main()
