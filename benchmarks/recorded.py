"""How many of the recorded complete solution sets we find: benchmarks/results/recorded.json.

Usage: python benchmarks/recorded.py. Needs the shared data folder ($CSPACE_DATA, default ../shared/data).
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

import arms
import score
from chains import Arm, Array

HERE = Path(__file__).resolve().parent


def chain(record: dict[str, Any]) -> Arm:
    """An arm of chains.json."""
    joints = record["joints"]
    axes, points = (np.array([joint[key] for joint in joints], dtype=float) for key in ("axis", "point"))
    types = "".join("P" if joint["type"] == "prismatic" else "R" for joint in joints)
    free = np.full(len(joints), np.inf)
    return arms.numbers(record["name"], axes, points, np.array(record["tool_zero"]), types, -free, free)


def count(arm: Arm, T: Array, known: Array) -> int:
    """How many of the known configurations (k, n) of a pose we list."""
    import cspace as cs

    screws = cs.model.from_screws(arm.axes, arm.points, arm.T_zero, joint_types=arm.joint_types)
    answer = cs.Robot(screws).ik(T).q
    return sum(bool(len(answer)) and bool(score.same(arm, answer, q, 1e-6).any()) for q in known)


def main() -> None:
    folder = Path(os.environ.get("CSPACE_DATA") or HERE.parents[1] / "shared/data") / "arms"
    facts = json.loads((folder / "solutions_meta.json").read_text())
    records = {record["name"]: record for record in json.loads((folder / "chains.json").read_text())}
    results = {}
    with np.load(folder / "solutions.npz") as data:
        for name, fact in facts.items():
            arm, locked = chain(records[name]), fact["locked_joint"]
            found = true = 0
            for i, T in enumerate(data[f"{name}/T"]):
                known, solved = data[f"{name}/Q"][i][: data[f"{name}/nsol"][i]], arm
                if locked is not None:
                    solved = arms.locked(arm, locked, data[f"{name}/q_true"][i][locked], name)
                    known = np.delete(known, locked, axis=1) if known.shape[1] > solved.dof else known
                found += count(solved, T, known)
                true += len(known)
            label = name if locked is None else f"{name}, joint {locked + 1} locked"
            results[label] = {"found": found, "true": true}
            print(label, f"{found}/{true}", flush=True)
    (HERE / "results/recorded.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
