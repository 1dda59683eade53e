"""Questions timed turn by turn in one process: processor time, so that a busy machine counts little."""

from __future__ import annotations

import gc
import json
import os
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import run
from contender import clock_cost, one_by_one

RESULTS = Path(__file__).resolve().parent / "results"


@dataclass
class Question:
    """What is asked of a contender about an arm.

    step: the timed call, of one input. items: how many goals, values or poses one call answers; times are
    told per item. judged: what a judge says of the answers.
    """

    arm: str
    what: str
    contender: str
    version: str
    step: Callable[[Any], Any]
    inputs: list[Any]
    items: int = 1
    judged: dict[str, float] = field(default_factory=dict)
    spent: list[float] = field(default_factory=list)

    def turn(self, seconds: float) -> None:
        """Goes on where the turn before stopped, so that all inputs come."""
        gc.disable()
        try:
            self.spent += one_by_one(self.step, self.inputs, seconds, len(self.spent))
        finally:
            gc.enable()

    def row(self) -> dict[str, Any]:
        names = {key: getattr(self, key) for key in ("arm", "what", "contender", "version", "items")}
        return {**names, "time": run.summary(t / self.items for t in self.spent), "judged": self.judged}


def measure(questions: list[Question], rounds: int, seconds: float) -> list[dict[str, Any]]:
    """The rows of all questions: pinned to one core, warmed up, in every round each has its turn."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    for question in questions:
        question.step(question.inputs[0])
    for _ in range(rounds):
        for question in questions:
            question.turn(seconds)
    rows = [question.row() for question in questions]
    for row in rows:
        print(json.dumps(row), flush=True)
    return rows


def every_input(questions: list[Question], rounds: int) -> list[dict[str, Any]]:
    """The rows of all questions: every input once a round and question, question after question; processor
    time of each call, less what reading that clock costs."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    clock = time.process_time_ns
    reading = clock_cost()
    for _ in range(rounds):
        for question in questions:
            gc.collect()
            gc.disable()
            for given in question.inputs:
                start = clock()
                question.step(given)
                question.spent.append(clock() - start - reading)
            gc.enable()
    rows = [question.row() for question in questions]
    for row in rows:
        print(json.dumps(row), flush=True)
    return rows


def write(name: str, rows: Iterable[dict[str, Any]], busy: float | None) -> None:
    """To benchmarks/results/NAME.json, with the machine; busy: its load before."""
    RESULTS.mkdir(exist_ok=True)
    measured = {"machine": run.machine(), "load": busy, "rows": list(rows)}
    (RESULTS / f"{name}.json").write_text(json.dumps(measured, indent=1) + "\n")
