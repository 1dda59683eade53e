"""How many of the recorded complete solution sets we find: benchmarks/results/recorded.json.

Usage: python benchmarks/recorded.py. Needs the shared data folder ($CSPACE_DATA, default ../shared/data).
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np

import score

HERE = Path(__file__).resolve().parent
FAMILIES = {"6R spherical", "6R three-parallel"}


def main() -> None:
    import cspace as cs

    folder = Path(os.environ.get("CSPACE_DATA") or HERE.parents[1] / "shared/data") / "arms"
    classes = json.loads((folder / "solutions_meta.json").read_text())
    chains = {record["name"]: record for record in json.loads((folder / "chains.json").read_text())}
    results = {}
    with np.load(folder / "solutions.npz") as data:
        for name in (name for name, entry in classes.items() if entry["klass"] in FAMILIES):
            joints = chains[name]["joints"]
            axes, points = ([joint[key] for joint in joints] for key in ("axis", "point"))
            robot = cs.Robot(cs.model.from_screws(axes, points, chains[name]["tool_zero"]))
            found = true = 0
            for T, count, Q in zip(data[f"{name}/T"], data[f"{name}/nsol"], data[f"{name}/Q"], strict=True):
                known = Q[:count]
                answer = robot.ik(T).q
                found += sum(bool(len(answer)) and bool(score.same(answer, q, 1e-6).any()) for q in known)
                true += int(count)
            results[name] = {"found": found, "true": true}
    (HERE / "results/recorded.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
