"""The part of the page on calibrated odometry and filters on known maps, and its lines of what must hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["localization"]
NAMES = {"intel": "Intel", "freiburg-079": "Freiburg 079"}
COLUMNS = ("raw", "calibrated", "lagged", "smoothed")


def section(results: Results) -> str:
    """Dead reckoning, and the errors of filters on MRCLAM 6."""
    measured = results["localization"] or []
    return "\n\n".join(["### Odometry and filters", odometry_table(measured), filter_table(measured)])


def filters_of(measured: list[Results]) -> dict[str, list[Results]]:
    """The rows of all robots by filter."""
    found: dict[str, list[Results]] = {}
    for entry in measured:
        if "filter" in entry:
            found.setdefault(entry["filter"], []).append(entry)
    return found


def odometry_table(measured: list[Results]) -> str:
    logs = [entry for entry in measured if entry["log"] in NAMES]
    if not logs:
        return "Calibrated odometry: not measured."
    body = [[NAMES[e["log"]], f"{e['raw']:.1f}", f"{e['corrected']:.1f}"] for e in logs]
    return table(["dead reckoning of the second half of a log [m]", "raw", "calibrated on the first"], body)


def filter_table(measured: list[Results]) -> str:
    found = filters_of(measured)
    if not found:
        return "Filters: not measured."
    body = [
        [
            name,
            *(f"{np.mean([run[key] for run in runs]):.3f}" for key in COLUMNS),
            f"{np.mean([run['mean_nis'] for run in runs]):.2f}",
            f"{np.mean([run['filter_s'] for run in runs]):.2f}",
        ]
        for name, runs in found.items()
    ]
    heading = ["MRCLAM 6, map known, mean RMSE of three robots [m]", "odometry raw", "calibrated"]
    return table([*heading, "smoothed by 5 s", "smoothed", "mean NIS", "time of a filter [s]"], body)


def odometry_row(results: Results) -> Row:
    what = "odometry calibrated on the first half of the Intel log, dead reckoning of the second half"
    found = [entry for entry in results["localization"] or [] if entry["log"] == "intel"]
    if not found:
        return row(what, "≤ 6 m", "4.8 m", "", None)
    error = found[0]["corrected"]
    return row(what, "≤ 6 m", "4.8 m", f"{error:.2f} m (raw {found[0]['raw']:.1f})", error <= 6, error <= 4.8)


def filter_row(results: Results) -> Row:
    what = "MRCLAM 6, robots 1–3, map known, own calibration: EKF / smoother, mean RMSE"
    runs = filters_of(results["localization"] or []).get("ekf", [])
    if not runs:
        return row(what, "≤ 0.18 / 0.14 m", "0.165 / 0.12 m", "", None)
    now, past = (float(np.mean([run[key] for run in runs])) for key in ("calibrated", "smoothed"))
    text = f"{now:.3f} / {past:.3f} m"
    holds, aimed = now <= 0.18 and past <= 0.14, now <= 0.165 and past <= 0.12
    return row(what, "≤ 0.18 / 0.14 m", "0.165 / 0.12 m", text, holds, aimed)


ROWS = [odometry_row, filter_row]
