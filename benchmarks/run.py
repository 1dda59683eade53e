"""Runs the benchmarks: every contender in a fresh process, the same seeded problems, interleaved repetitions.

Usage: python benchmarks/run.py [--set measurements|general|calibrated|slides] [--rounds 7] [--only PEER …]
[--python PEER=interpreter …]. Writes benchmarks/results/SET.json. The arms come from the catalogue of cspace,
as numbers (benchmarks/arms.py); see CONTRIBUTING.md for what the peers need.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np

import arms
import chains
import peers
import problems
import score

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results"
TASKS = ["ik", "fk", "jacobian", "fk_jacobian"]
BATCH = 100_000
SLOW_BATCH = 10_000
"""Poses of a batch where one takes more than a few microseconds."""


class Process:
    """A contender's process and the line of talk with it."""

    def __init__(self, peer: str, task: str, folder: Path, python: str, patience: float) -> None:
        self.peer = peer
        command = [
            python,
            str(HERE / "contender.py"),
            peer,
            task,
            str(folder / "arm.npz"),
            str(folder / "q.npz"),
            str(patience),
        ]
        env = one_thread()
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=env,
        )
        if hasattr(os, "sched_setaffinity"):
            os.sched_setaffinity(self.process.pid, {max(os.sched_getaffinity(0))})
        self.first = self.listen()
        self.samples: dict[str, list[float]] = {"call": [], "read": [], "batch": []}

    def listen(self) -> dict:
        line = self.process.stdout.readline() if self.process.stdout else ""
        return json.loads(line) if line else {"refused": f"the process ended with {self.process.wait()}"}

    def ask(self, **words: object) -> dict:
        assert self.process.stdin
        if self.process.poll() is not None:
            return {"refused": "the process has ended"}
        self.process.stdin.write(json.dumps(words) + "\n")
        self.process.stdin.flush()
        return self.listen()

    def quick(self) -> bool:
        """Whether a large batch of this contender takes a blink."""
        return self.peer == "cspace_" and np.median(self.samples["call"]) < 2000

    def quit(self) -> None:
        if self.process.poll() is None and self.process.stdin:
            self.process.stdin.write('{"do": "quit"}\n')
            self.process.stdin.close()
        self.process.wait()


def answers(process: Process, field: str, folder: Path) -> list[np.ndarray] | None:
    """What the contender says to each problem of the field; None if it did not survive."""
    reply = process.ask(do="answers", of=field, to=str(folder / f"{process.peer}.npz"))
    if not reply.get("to"):
        return None
    with np.load(reply["to"]) as data:
        return np.split(data["values"], np.cumsum(data["counts"])[:-1])


def judge_ik(
    arm: chains.Arm, given: problems.Problems, alive: list[Process], folder: Path
) -> dict[str, dict]:
    """Found and true solutions and the worst residual, for random poses and for those next to singular
    ones."""
    judged: dict[str, dict] = {p.peer: {} for p in alive}
    sets = [
        ("random", "T", given.q, given.T, 1e-6),
        ("near_1e-4", "T_near_4", given.q_near_4, given.T_near_4, 5e-5),
    ]
    sets.append(("near_1e-6", "T_near_6", given.q_near_6, given.T_near_6, 5e-7))
    for label, field, q_true, T, tolerance in sets:
        if len(T) == 0:
            continue
        said = {p.peer: answers(p, field, folder) for p in alive}
        said = {peer: found for peer, found in said.items() if found is not None}
        true = [
            score.truth(arm, q_true[i], T[i], [found[i] for found in said.values()], tolerance)
            for i in range(len(T))
        ]
        for peer, found in said.items():
            worst = [score.residuals(arm, found[i], T[i]).max(initial=0.0) for i in range(len(T))]
            judged[peer][label] = {
                "found": sum(score.count_found(arm, true[i], found[i], tolerance) for i in range(len(T))),
                "true": sum(map(len, true)),
                "residual": float(np.max(worst)),
                "wrong": int(
                    sum((score.residuals(arm, found[i], T[i]) > score.VERIFIED).sum() for i in range(len(T)))
                ),
            }
    return judged


def judge_forward(
    arm: chains.Arm, task: str, given: problems.Problems, alive: list[Process], folder: Path
) -> dict:
    """The worst difference from the plain forward kinematics or Jacobian."""
    judge = chains.fk if task == "fk" else chains.jacobian  # of fk_jacobian the Jacobian is read
    wanted = judge(arm, given.q)
    judged = {}
    for process in alive:
        found = answers(process, "q", folder)
        if found is not None:
            error = np.abs(np.concatenate(found).reshape(wanted.shape) - wanted).max()
            judged[process.peer] = {"random": {"residual": float(error)}}
    return judged


def measure(alive: list[Process], rounds: int, seconds: float) -> None:
    """Interleaved: in every round each contender has its turn."""
    for turn in range(rounds):
        for process in alive:
            reply = process.ask(do="single", seconds=seconds)
            for key in ("call", "read"):
                process.samples[key] += reply.get(key, [])
            if turn < 5:
                each = process.ask(do="batch", count=BATCH if process.quick() else SLOW_BATCH)
                if each.get("batch") is not None:
                    process.samples["batch"].append(each["batch"])


def summary(samples: Iterable[float]) -> dict[str, float] | None:
    """Median, 95th and 99th percentile in microseconds."""
    values = np.array(list(samples)) / 1000
    if len(values) == 0:
        return None
    median, p95, p99 = (float(np.percentile(values, share)) for share in (50, 95, 99))
    return {"median": median, "p95": p95, "p99": p99}


def compete(
    name: str,
    task: str,
    names: list[str],
    pythons: dict[str, str],
    rounds: int,
    seconds: float,
    counts: tuple[int, int],
    patience: float,
) -> list[dict]:
    """All contenders at one task on one arm; counts: random poses and poses at each distance."""
    arm = arms.load(name)
    given = problems.make(arm, *counts)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        arm.save(folder / "arm.npz")
        given.save(folder / "q.npz")
        started = [Process(peer, task, folder, pythons.get(peer, sys.executable), patience) for peer in names]
        alive = [p for p in started if "ready" in p.first]
        measure(alive, rounds, seconds)
        if task == "ik":
            judged = judge_ik(arm, given, alive, folder)
        else:
            judged = judge_forward(arm, task, given, alive, folder)
        for process in started:
            process.quit()
    rows = []
    for process in started:
        row = {"arm": name, "task": task, "contender": process.peer, **process.first}
        if process in alive:
            row |= {key: summary(values) for key, values in process.samples.items()}
            row |= {"judged": judged.get(process.peer)}
        rows.append(row)
        print(json.dumps({k: v for k, v in row.items() if k != "judged"}), flush=True)
    return rows


def import_seconds(module: str, python: str) -> float | None:
    """Processor time of a fresh interpreter that imports the module, less that of one that imports nothing.

    The median of 9 pairs [s]; an import runs on one core, so on a quiet machine this is its wall time too.
    """
    pairs = []
    for _ in range(9):
        times = []
        for code in ("pass", f"import {module}"):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            if subprocess.run([python, "-c", code], capture_output=True, env=one_thread()).returncode:
                return None
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            times.append(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
        pairs.append(times[1] - times[0])
    return float(np.median(pairs))


def one_thread() -> dict[str, str]:
    """The environment with one thread for linear algebra."""
    return {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def imports(pythons: dict[str, str], names: list[str]) -> dict[str, float | None]:
    """Peer → seconds; of cspace also with its robots, because `import cspace` alone leaves them for later."""
    modules = {"numpy": "numpy", "cspace.robots": "cspace.robots"}
    for peer in names:
        modules[peer] = declared_module(peer)
    return {
        peer: import_seconds(module, pythons.get(peer, sys.executable)) for peer, module in modules.items()
    }


def declared_module(peer: str) -> str:
    """What a user of the peer imports, read from its adapter without importing it."""
    for line in (HERE / "peers" / f"{peer}.py").read_text().splitlines():
        if line.startswith("NAME, PACKAGE, MODULE ="):
            return line.split("=")[1].split(",")[2].strip().strip('"')
    raise LookupError(f"{peer} declares no MODULE")


def load() -> float | None:
    """Processes that wanted a core in the last five minutes, on average: whether the machine was quiet."""
    return round(os.getloadavg()[1], 1) if hasattr(os, "getloadavg") else None


def machine() -> dict[str, object]:
    """What the numbers were taken on."""
    model = platform.processor()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = [line for line in cpuinfo.read_text().splitlines() if line.startswith("model name")]
        model = lines[0].split(":")[1].strip() if lines else model
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "date": time.strftime("%Y-%m-%d"),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", action="append", default=[], metavar="PEER=PATH")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--seconds", type=float, default=0.3)
    parser.add_argument("--only", nargs="*", default=peers.NAMES)
    parser.add_argument("--set", default="measurements", choices=arms.SETS)
    parser.add_argument("--arms", nargs="*")
    parser.add_argument("--counts", nargs=2, type=int, default=(1000, 200))
    parser.add_argument("--patience", type=float, default=60.0)
    options = parser.parse_args()
    pythons = dict(pair.split("=", 1) for pair in options.python)
    tasks = TASKS if options.set == "measurements" else ["ik"]
    busy = load()
    rows = [
        row
        for name in options.arms or arms.SETS[options.set]
        for task in tasks
        for row in compete(
            name,
            task,
            options.only,
            pythons,
            options.rounds,
            options.seconds,
            tuple(options.counts),
            options.patience,
        )
    ]
    RESULTS.mkdir(exist_ok=True)
    measured: dict[str, object] = {
        "machine": machine(),
        "load": busy,
        "patience": options.patience,
        "rows": rows,
    }
    if options.set == "measurements":
        measured["imports"] = imports(pythons, options.only)
    (RESULTS / f"{options.set}.json").write_text(json.dumps(measured, indent=1) + "\n")


if __name__ == "__main__":
    main()
