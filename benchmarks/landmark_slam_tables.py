"""The part of the page on landmark SLAM, and its lines of what must hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["landmark_slam"]
MRCLAM = "MRCLAM 6"


def section(results: Results) -> str:
    """Times of steps beside the peers, and errors on public logs."""
    measured = results["landmark_slam"] or []
    return "\n\n".join(["### Landmark SLAM", step_table(measured), log_table(measured)])


def steps_of(measured: list[Results], ours: str) -> dict[int, Results]:
    """Comparisons by number of landmarks ("ekf"), or by version ("particles")."""
    return {entry["number"]: entry for entry in measured or [] if f"{ours} seconds" in entry}


def step_table(measured: list[Results]) -> str:
    body = []
    for ours, theirs, title, peer in (
        ("ekf", "toolbox", "EKF-SLAM, {} landmarks, one reading", "Robotics Toolbox"),
        ("particles", "pythonrobotics", "FastSLAM {}, 100 particles, some of 8 landmarks", "PythonRobotics"),
    ):
        for number, entry in steps_of(measured, ours).items():
            times = [entry[f"{name} seconds"] for name in (ours, theirs)]
            body.append(
                [title.format(number), peer, *(f"{median:.1f} ({high:.1f})" for median, high in times)]
            )
            simulated = entry.get(f"{theirs} simulated")
            body[-1].append("—" if simulated is None else f"{simulated[0]:.0f}")
            body[-1].append(f"{entry['times faster']:.0f}×")
    if not body:
        return "Steps: not measured."
    heading = ["a step from Python", "peer", "**cspace** [µs], median (95 %)", "peer [µs]"]
    return table([*heading, "of it the simulated robot [µs]", "times faster"], body)


def log_table(measured: list[Results]) -> str:
    logs = [entry for entry in measured if "filter" in entry]
    if not logs:
        return "Public logs: not measured."
    names = dict.fromkeys(entry["filter"] for entry in logs)
    body = [[name, *mean_errors(logs, name, MRCLAM), *mean_errors(logs, name, "Victoria")] for name in names]
    heading = ["RMSE [m], landmarks with names", "MRCLAM 6, three robots: poses", "landmarks"]
    return table([*heading, "Victoria Park: poses", "landmarks"], body)


def mean_errors(logs: list[Results], name: str, where: str) -> list[str]:
    """The means of both errors over the logs whose name begins so."""
    found = [entry for entry in logs if entry["filter"] == name and entry["log"].startswith(where)]
    cells = []
    for key in ("poses", "landmarks"):
        values = [entry[key] for entry in found if key in entry]
        cells.append(f"{np.mean(values):.2f}" if values else "—")
    return cells


def ekf_row(results: Results) -> Row:
    what = "EKF-SLAM step, 100 / 300 landmarks, against the Robotics Toolbox, from Python"
    found = steps_of(results["landmark_slam"], "ekf")
    if not {100, 300} <= set(found):
        return row(what, "≥ 200×", "≥ 400×", "", None)
    factors = [found[count]["times faster"] for count in (100, 300)]
    text = " / ".join(f"{factor:.0f}×" for factor in factors)
    return row(what, "≥ 200×", "≥ 400×", text, min(factors) >= 200, min(factors) >= 400)


def particle_row(results: Results) -> Row:
    what = "FastSLAM 1 / 2, 100 particles, against PythonRobotics, a whole step from Python"
    found = steps_of(results["landmark_slam"], "particles")
    if not {1, 2} <= set(found):
        return row(what, "≥ 300×", "≥ 1,000×", "", None)
    factors = [found[version]["times faster"] for version in (1, 2)]
    text = " / ".join(f"{factor:.0f}×" for factor in factors)
    return row(what, "≥ 300×", "≥ 1,000×", text, min(factors) >= 300, min(factors) >= 1000)


ROWS = [ekf_row, particle_row]
