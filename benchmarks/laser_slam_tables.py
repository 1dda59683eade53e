"""The part of the page on laser SLAM and scan matching, and its lines of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["laser_slam", "map_search"]
NAMES = {"intel": "Intel", "freiburg-079": "Freiburg 079"}
STAGES = ("odometry", "calibrated", "matched", "closed")
ERRORS = {"intel": (0.10, 0.07), "freiburg-079": (0.15, 0.10)}
"""What the RMSE [m] must be, and the aim."""
SECONDS = {"intel": (10.0, 4.0), "freiburg-079": (40.0, 20.0)}


def section(results: Results) -> str:
    """Public logs, and searches of their maps."""
    texts = ["### Laser SLAM", log_table(logs_of(results)), match_text(results["laser_slam"])]
    return "\n\n".join([*texts, search_table(results["map_search"])])


def logs_of(results: Results) -> dict[str, Results]:
    return {entry["log"]: entry for entry in results["laser_slam"] or [] if "log" in entry}


def match_of(measured: list[Results]) -> Results | None:
    return next((entry for entry in measured or [] if "matches" in entry), None)


def log_table(logs: dict[str, Results]) -> str:
    if not logs:
        return "Public logs: not measured."
    body = [
        [
            NAMES[name],
            str(entry["scans"]),
            *(f"{entry[stage]:.3f}" if stage in entry else "—" for stage in STAGES),
            f"{entry['rpe_1']:.3f} / {entry['rpe_10']:.3f}",
            f"{entry['accepted']} / {entry['rejected']}",
            f"{entry['processor_seconds']:.1f} / {entry['seconds']:.1f}",
        ]
        for name, entry in logs.items()
    ]
    heading = [
        "RMSE to the corrected poses [m]",
        "scans",
        "odometry",
        "calibrated",
        "matched",
        "loops closed",
    ]
    heading += ["relative, over 1 / 10 m", "loops accepted / rejected", "processor / wall time [s]"]
    return table(heading, body)


def match_text(measured: list[Results]) -> str:
    match = match_of(measured)
    if match is None:
        return "Scan matches: not measured."
    return (
        "A match within ±0.8 m and ±15° on the map of the Intel building without the scan takes "
        f"{match['median_ms']:.2f} ms (95 %: {match['p95_ms']:.2f}); {match['right']} of {match['matches']}"
        " are right."
    )


def search_table(measured: list[Results]) -> str:
    if not measured:
        return "Searches of whole maps: not measured."
    body = [
        [
            f"{NAMES[entry['log']]}, {entry['cells'][0]} × {entry['cells'][1]} cells",
            str(entry["scans"]),
            str(entry["first"]),
            str(entry["among_three"]),
            *(f"{entry[f'{n}_median_ms']:.0f} ({entry[f'{n}_p95_ms']:.0f})" for n in ("one", "three")),
        ]
        for entry in measured
    ]
    heading = ["whole map, one scan that is not in it", "scans", "right first", "right among three"]
    return table([*heading, "best place [ms], median (95 %)", "best three [ms]"], body)


def error_row(results: Results) -> Row:
    what = "Intel / Freiburg 079 from raw odometry: RMSE to the corrected poses"
    logs = logs_of(results)
    if not set(ERRORS) <= set(logs):
        return row(what, "≤ 0.10 / 0.15 m", "0.07 / 0.10 m", "", None)
    found = {name: logs[name]["closed"] for name in ERRORS}
    text = " / ".join(f"{error:.3f} m" for error in found.values())
    holds, aimed = (all(found[name] <= ERRORS[name][k] for name in found) for k in (0, 1))
    return row(what, "≤ 0.10 / 0.15 m", "0.07 / 0.10 m", text, holds, aimed)


def wall_row(results: Results) -> Row:
    what = "the same, processor time of its one thread (wall time)"
    logs = logs_of(results)
    if not set(SECONDS) <= set(logs):
        return row(what, "≤ 10 / 40 s", "4 / 20 s", "", None)
    found = {name: logs[name]["processor_seconds"] for name in SECONDS}
    text = " / ".join(f"{seconds:.1f} s ({logs[name]['seconds']:.1f} s)" for name, seconds in found.items())
    holds, aimed = (all(found[name] <= SECONDS[name][k] for name in found) for k in (0, 1))
    return row(what, "≤ 10 / 40 s", "4 / 20 s", text, holds, aimed)


def match_row(results: Results) -> Row:
    what = "scan match ±0.8 m, ±15° / best three places of a whole map, the worse map, median"
    match, searches = match_of(results["laser_slam"]), results["map_search"]
    if match is None or not searches:
        return row(what, "≤ 1 / 150 ms", "0.5 / 60 ms", "", None)
    near, far = match["median_ms"], max(entry["three_median_ms"] for entry in searches)
    text = f"{near:.2f} / {far:.0f} ms"
    return row(what, "≤ 1 / 150 ms", "0.5 / 60 ms", text, near <= 1 and far <= 150, near <= 0.5 and far <= 60)


ROWS = [match_row, error_row, wall_row]
