"""Runs the C++ benchmarks: benchmarks/results/cpp.json.

Usage: python benchmarks/microbench.py build/bench/benchmarks/cpp
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main() -> None:
    results = {}
    for program in sorted(Path(sys.argv[1]).glob("bench_*")):
        if program.is_file() and os.access(program, os.X_OK):
            output = subprocess.run([program], capture_output=True, text=True, check=True).stdout
            for line in output.splitlines():
                entry = json.loads(line)
                results[entry.pop("name")] = entry
    (HERE / "results/cpp.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
