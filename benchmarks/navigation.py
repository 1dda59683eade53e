"""All benchmarks of navigation but one in one command, in some six minutes; `--only exact` is the other.

Usage: python benchmarks/navigation.py [--only NAME …] [--python ompl=PATH …]. Peers not installed are left
out; --python names interpreters for the peers of curves (see navigation_curves.py). Ends with
benchmarks/report.py, which needs matplotlib.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
RUNS: dict[str, list[str]] = {
    "degenerate": [],
    "any_angle": [],
    "fields": ["--rounds", "9"],
    "polygons": [],
    "grid": ["--rounds", "3", "arena", "brc202d", "random-400-33", "maze-400-4", "Berlin_1_256"],
    "sampling": ["--queries", "20"],
    "bugs": [],
    "large": ["--patience", "300"],
    "curves": ["--rounds", "3"],
    "exact": [],
}
LONG = "exact"
"""Run by name alone: all lines of all maps take the peers minutes."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", choices=RUNS, default=[name for name in RUNS if name != LONG])
    parser.add_argument("--python", action="append", default=[], metavar="NAME=PATH")
    options = parser.parse_args()
    failed = 0
    for name in options.only:
        begin = time.monotonic()
        more = [f"--python={one}" for one in options.python] if name == "curves" else []
        command = [sys.executable, str(HERE / f"navigation_{name}.py"), *RUNS[name], *more]
        code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
        failed += code != 0
        verdict = "done" if code == 0 else f"FAILED with {code}"
        print(f"{name}: {verdict} in {time.monotonic() - begin:.0f} s", flush=True)
    return int(subprocess.run([sys.executable, str(HERE / "report.py")]).returncode != 0 or failed > 0)


if __name__ == "__main__":
    sys.exit(main())
