"""Damages robot files for as long as you like: python tests/fuzz/robot_files.py [seconds] [seed].

Prints the bytes that got through to anything but a CspaceError, or took longer than a second.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from model.mutation import exercise, exercise_srdf, mutant
from model.test_fuzz import SEEDS, damaged_srdf
from model.test_srdf import panda


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else int(time.time())
    rng = np.random.default_rng(seed)
    end = time.monotonic() + seconds
    tried = accepted = faults = 0
    slowest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        while time.monotonic() < end:
            semantic = rng.random() < 0.2
            data = damaged_srdf(rng) if semantic else mutant(rng, SEEDS)
            start = time.perf_counter()
            try:
                accepted += exercise_srdf(data, panda()) if semantic else exercise(data, Path(folder) / "x")
            except Exception as error:
                faults += 1
                print(f"{type(error).__name__}: {error}\n{data!r}\n")
            took = time.perf_counter() - start
            slowest = max(slowest, took)
            if took > 1.0:
                faults += 1
                print(f"{took:.1f} s\n{data!r}\n")
            tried += 1
    print(f"seed {seed}: {tried} files, {accepted} readable, {faults} faults, slowest {slowest * 1e3:.0f} ms")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
