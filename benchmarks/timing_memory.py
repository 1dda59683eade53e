"""Memory of timing 10⁴ waypoints of seven joints: benchmarks/results/timing_memory.json.

Usage: python benchmarks/timing_memory.py [--write]

The largest memory of a process of its own, interpreter, numpy and path included. Waypoints are spread over
|q| ≤ 2; those of corners that meet are a random walk with steps of 0.3 rad. |q̇| ≤ 2, |q̈| ≤ 5, jerks ≤ 50.
"""

from __future__ import annotations

import argparse
import json
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
COUNT, DOF = 10_000, 7
MADE = {
    "splines": "cs.spline(apart)",
    "B-splines": "cs.trajectory.b_spline(apart)",
    "blends": "cs.blend(apart, 0.1)",
    "blends that meet": "cs.blend(near, 0.1)",
}
JERK = ("splines", "blends")
"""Those that are timed under limits of jerk, too."""

PROGRAM = """
import resource, time, numpy as np, cspace as cs
rng = np.random.default_rng(1)
apart = rng.uniform(-2, 2, ({count}, {dof}))
near = np.cumsum(0.3 * rng.normal(size=({count}, {dof})), axis=0)
path = {path}
begin = time.process_time()
timed = cs.time_parametrize(path, velocity=2.0, acceleration=5.0, {more})
assert timed and timed.proved, timed.reason
seconds = time.process_time() - begin
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6, seconds, len(timed.rises))
"""


def measure(path: str, more: str) -> dict[str, float]:
    """Megabytes of a process, seconds and intervals of the timing."""
    text = PROGRAM.format(count=COUNT, dof=DOF, path=path, more=more)
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    megabytes, seconds, intervals = map(float, done.stdout.split())
    return {"MB": megabytes, "seconds": seconds, "intervals": intervals}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    results: dict[str, Any] = {"machine": platform.processor(), "rows": {}}
    for name, path in MADE.items():
        results["rows"][name] = measure(path, "")
        if name in JERK:
            results["rows"][f"{name}, limits of jerk"] = measure(path, "jerk=50.0")
    for name, row in results["rows"].items():
        print(f"{name:26}", {key: float(f"{value:.3g}") for key, value in row.items()})
    if options.write:
        text = json.dumps(results, indent=1) + "\n"
        (HERE / "results/timing_memory.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
