"""What ssik's general solver derives for an arm before its first answer: benchmarks/results/derived.json.

Usage: python benchmarks/derive.py [NAME …]. Seconds of processor time in a fresh process, nothing kept from
before. For the arms that it ships this work was done by its makers; a user with an arm of his own waits for
it once. Minutes per arm; arms already in the file are not done again.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import arms

RESULT = Path(__file__).resolve().parent / "results/derived.json"
CODE = """
import sys, time
import arms
from peers import ssik_
robot = ssik_.from_axes(arms.load(sys.argv[1]))
start = time.process_time()
ssik_.derive(robot)
print(time.process_time() - start)
"""


def main() -> None:
    found = json.loads(RESULT.read_text()) if RESULT.exists() else {}
    for name in sys.argv[1:] or arms.GENERAL:
        if name in found:
            continue
        command = [sys.executable, "-c", CODE, name]
        spent = subprocess.run(command, capture_output=True, text=True, check=True, cwd=RESULT.parents[1])
        found[name] = round(float(spent.stdout.split()[-1]), 1)
        RESULT.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
