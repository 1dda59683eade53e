"""The part of the page on dynamics, and its lines of what must hold."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
ROBOTS = {"panda": "Panda", "ur5": "UR5", "g1": "humanoid G1, 6 + 29"}
PEERS = {"cspace": "**cspace**", "float32": "**float32**", "pinocchio": "Pinocchio", "dynibo": "dynibo"}
OWN = ("cspace", "float32", "wrenches")
TASKS = {
    "inverse dynamics": "inverse",
    "mass matrix": "mass matrix",
    "forward dynamics": "forward",
    "Coriolis matrix": "Coriolis",
    "inverse derivatives": "∂ inverse",
    "forward derivatives": "∂ forward",
    "regressor": "regressor",
}


def section(results: Results) -> str:
    """Single calls and batches of all robots."""
    measured = results["dynamics"]
    if not measured:
        return "Not measured."
    body = []
    for robot, title in ROBOTS.items():
        part = measured["robots"].get(robot, {})
        for kind, label in (("single", "one call"), ("batch", "per row of a batch, one thread")):
            for task in TASKS:
                times = part.get(kind, {}).get(task, {})
                cells = [
                    f"{times[peer]['median']:.0f} ({times[peer]['p95']:.0f})" if peer in times else "—"
                    for peer in PEERS
                ]
                body.append([title, task, label, *cells])
    return table(["robot", "function", "", *PEERS.values()], body)


def ratios(
    measured: Results, robots: list[str], kind: str, tasks: Iterable[str], own: str = "cspace"
) -> dict[str, float]:
    """Per function the least factor by which we are faster than the best peer."""
    found = {}
    for task in tasks:
        each = []
        for robot in robots:
            times = measured["robots"][robot][kind].get(task, {})
            peers = [times[peer]["median"] for peer in times if peer not in OWN]
            if peers and own in times:
                each.append(min(peers) / times[own]["median"])
        if each:
            found[task] = min(each)
    return found


def build_row(
    results: Results,
    what: str,
    robots: list[str],
    kind: str,
    must: dict[str, float],
    aim: dict[str, float],
    own: str = "cspace",
) -> Row:
    wanted, hoped = (
        "≥ " + ", ".join(f"{factor:g}" for factor in dict.fromkeys(limits.values())) + "×"
        for limits in (must, aim)
    )
    if not results["dynamics"]:
        return row(what, wanted, hoped, "", None)
    measured = ratios(results["dynamics"], robots, kind, must, own)
    if len(measured) < len(must):
        return row(what, wanted, hoped, "", None)
    text = ", ".join(f"{TASKS[task]} {factor:.2f}×" for task, factor in measured.items())
    holds = all(measured[task] >= factor for task, factor in must.items())
    return row(
        what, wanted, hoped, text, holds, all(measured[task] >= factor for task, factor in aim.items())
    )


def arm_row(results: Results) -> Row:
    must = {"inverse dynamics": 2.2, "mass matrix": 1.4, "forward dynamics": 2.0}
    aim = {"inverse dynamics": 3.0, "mass matrix": 2.0, "forward dynamics": 2.6}
    what = "dynamics of Panda and UR5, one Python call, the worse one, against the better peer"
    return build_row(results, what, ["panda", "ur5"], "single", must, aim)


def humanoid_row(results: Results) -> Row:
    must = {"inverse dynamics": 1.7, "mass matrix": 1.1, "forward dynamics": 1.9}
    aim = {"inverse dynamics": 2.5, "mass matrix": 1.3, "forward dynamics": 2.4}
    what = "dynamics of a humanoid 6 + 29, one Python call, against Pinocchio"
    return build_row(results, what, ["g1"], "single", must, aim)


def batch_row(results: Results) -> Row:
    must = {"inverse dynamics": 8.0, "forward dynamics": 8.0}
    aim = {"inverse dynamics": 12.0, "forward dynamics": 10.0}
    what = "dynamics of 10⁵ rows, one core, the worst robot, against Pinocchio's parallel calls on one thread"
    return build_row(results, what, list(ROBOTS), "batch", must, aim)


def float_row(results: Results) -> Row:
    must = dict.fromkeys(("inverse dynamics", "forward dynamics"), 14.0)
    what = "the same in float32"
    return build_row(results, what, list(ROBOTS), "batch", must, must, "float32")


FURTHER = ("Coriolis matrix", "inverse derivatives", "forward derivatives", "regressor")


def further_row(results: Results) -> Row:
    what = "Coriolis matrix, derivatives and regressor, one Python call, the worst robot, against Pinocchio"
    must, aim = dict.fromkeys(FURTHER, 1.3), dict.fromkeys(FURTHER, 2.0)
    return build_row(results, what, list(ROBOTS), "single", must, aim)


def further_batch_row(results: Results) -> Row:
    what = "the same per row of a batch, one core, against Pinocchio's single calls, as it has no others"
    must, aim = dict.fromkeys(FURTHER, 4.0), dict.fromkeys(FURTHER, 8.0)
    return build_row(results, what, list(ROBOTS), "batch", must, aim)


ROWS = [arm_row, humanoid_row, batch_row, float_row, further_row, further_batch_row]
