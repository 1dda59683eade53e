"""Runs the C++ benchmarks: benchmarks/results/cpp.json.

Usage: python benchmarks/microbench.py build/bench/benchmarks/cpp
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import arms

HERE = Path(__file__).resolve().parent
ARMS = arms.CLASSIC


def arms_as_text() -> str:
    """The arms as the C++ programs read them: name, n, axes, points, tip at zero."""
    lines = []
    for arm in map(arms.load, ARMS):
        numbers = [*arm.axes.ravel(), *arm.points.ravel(), *arm.T_zero.ravel()]
        lines.append(f"{arm.name} {arm.dof} " + " ".join(repr(float(x)) for x in numbers))
    return "\n".join(lines) + "\n"


def main() -> None:
    results = {}
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.write(arms_as_text())
        file.flush()
        for program in sorted(Path(sys.argv[1]).glob("bench_*")):
            if not program.is_file() or not os.access(program, os.X_OK):
                continue
            output = subprocess.run([program, file.name], capture_output=True, text=True, check=True).stdout
            for line in output.splitlines():
                entry = json.loads(line)
                results[entry.pop("name")] = entry
    (HERE / "results/cpp.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
