"""One contender in its own process: reads commands as JSON lines, answers as JSON lines.

Usage: python contender.py PEER TASK ARM_FILE PROBLEMS_FILE [PATIENCE]. Commands: {"do": "single", "seconds":
…}, {"do": "batch", "count": …}, {"do": "answers", "of": field, "to": file}, {"do": "quit"}.
"""

from __future__ import annotations

import gc
import importlib.metadata
import json
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

import peers
from chains import Arm
from problems import Problems

CHUNK = 10
"""Quick calls per timed sample: enough that the clock costs nothing."""

SLOW = 2000.0
"""Calls of more than this [ns] are timed one by one, so that the slowest poses show."""


PATIENCE = 60.0
"""Seconds of processor time that a contender has to get ready for an arm, unless told otherwise."""


@contextmanager
def patience(seconds: float) -> Iterator[None]:
    """Raises Refused inside once the processor time is up.

    Looks now and then: a limit of the system's on processor time would make the clock of it coarse for ever.
    """
    start = time.process_time()

    def look(*_: object) -> None:
        if time.process_time() - start > seconds:
            raise peers.Refused(f"not ready after {seconds:g} s of processor time")

    signal.signal(signal.SIGALRM, look)
    signal.setitimer(signal.ITIMER_REAL, 1.0, 1.0)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def chunks(step: Callable[[Any], Any], inputs: list[Any], seconds: float) -> list[float]:
    """Nanoseconds per call, one number per chunk of calls, until the time is up."""
    found: list[float] = []
    clock = time.perf_counter_ns
    end = clock() + int(seconds * 1e9)
    while clock() < end:
        for i in range(0, len(inputs) - CHUNK + 1, CHUNK):
            chunk = inputs[i : i + CHUNK]
            start = clock()
            for x in chunk:
                step(x)
            found.append((clock() - start) / CHUNK)
            if clock() > end:
                break
    return found


def clock_cost() -> float:
    """What reading the clock of processor time costs [ns], in the middle."""
    clock = time.process_time_ns
    return -float(np.median([clock() - clock() for _ in range(1000)]))


def one_by_one(step: Callable[[Any], Any], inputs: list[Any], seconds: float, first: int = 0) -> list[float]:
    """Nanoseconds of processor time per call, less what reading that clock costs, until the time is up.

    What else runs on the machine does not count. Begins at the input numbered first and goes round.
    """
    clock = time.process_time_ns
    reading = clock_cost()
    found: list[float] = []
    end = time.perf_counter_ns() + int(seconds * 1e9)
    while time.perf_counter_ns() < end:
        x = inputs[(first + len(found)) % len(inputs)]
        start = clock()
        step(x)
        found.append(clock() - start - reading)
    return found


class Contender:
    """A task of a peer on one arm, ready to be timed."""

    def __init__(
        self, peer: str, task: str, arm_file: str, problems_file: str, limit: str = str(PATIENCE)
    ) -> None:
        self.arm, self.problems = Arm.load(arm_file), Problems.load(problems_file)
        self.poses = task == "ik"
        module = peers.load(peer)
        self.version = getattr(module, "VERSION", None) or importlib.metadata.version(module.PACKAGE)
        factory = getattr(module, task, None)
        if factory is None:
            raise peers.Refused("does not offer this")
        start = time.perf_counter()
        with patience(float(limit)):
            self.task = factory(self.arm)
        self.setup_seconds = time.perf_counter() - start
        self.inputs = [self.task.prepare(np.ascontiguousarray(x)) for x in self.given()]
        self.turn = 0

    def given(self) -> np.ndarray:
        return self.problems.T if self.poses else self.problems.q

    def single(self, seconds: float) -> dict[str, list[float]]:
        call, read = self.task.call, self.task.read

        def both(x: Any) -> Any:
            return read(call(x))

        for x in self.inputs[:50]:
            both(x)
        gc.disable()
        try:
            return {"call": self.samples(call, seconds), "read": self.samples(both, seconds)}
        finally:
            gc.enable()

    def samples(self, step: Callable[[Any], Any], seconds: float) -> list[float]:
        """Nanoseconds per call; slow calls go on where the turn before stopped, so that all poses come."""
        quick = self.inputs[:500]
        if np.median(chunks(step, quick, 0.01)) <= SLOW:
            return chunks(step, quick, seconds)
        found = one_by_one(step, self.inputs, seconds, self.turn)
        self.turn += len(found)
        return found

    def batch(self, count: int) -> dict[str, float | None]:
        if self.task.batch is None:
            return {"batch": None}
        given = self.given()
        given = np.ascontiguousarray(np.tile(given, (-(-count // len(given)), 1, 1)[: given.ndim])[:count])
        prepared = self.task.prepare_batch(given)
        start = time.process_time_ns()  # of one core; what else runs on the machine does not count
        answer = self.task.batch(prepared)
        spent = time.process_time_ns() - start
        del answer
        return {"batch": spent / count}

    def answers(self, of: str, to: str) -> dict[str, str]:
        task = self.task
        read = task.exact or task.read
        found = [read(task.call(task.prepare(np.ascontiguousarray(x)))) for x in getattr(self.problems, of)]
        if not found:
            return {"to": ""}
        np.savez(to, counts=[len(a) for a in found], values=np.concatenate(found))
        return {"to": to}


def main() -> None:
    reply = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever a peer prints goes to the error stream

    def say(**words: object) -> None:
        print(json.dumps(words), file=reply, flush=True)

    try:
        contender = Contender(*sys.argv[1:])
    except peers.Refused as reason:
        return say(refused=str(reason))
    except Exception as error:
        return say(
            refused=f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"[:160]
        )
    say(ready=True, version=contender.version, setup_seconds=contender.setup_seconds)
    for line in sys.stdin:
        words = json.loads(line)
        action = words.pop("do")
        if action == "quit":
            return None
        say(**getattr(contender, action)(**words))
    return None


if __name__ == "__main__":
    main()
