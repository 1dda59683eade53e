"""Which results were measured with other sources than those of today.

benchmarks/results/sources.json keeps, for each result, a fingerprint of its file and one of the sources that
it speaks of, as they were when report.py first saw that file. A result whose sources have changed since is
older.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT, RESULTS = HERE.parent, HERE / "results"
RECORDS = RESULTS / "sources.json"
SOURCES = {
    "install": ["CMakeLists.txt", "pyproject.toml", "include", "src"],
    "navigation": [
        *("include/cspace/math", "include/cspace/maps", "include/cspace/navigation", "include/cspace/search"),
        *("src/cspace/maps", "src/cspace/navigation", "src/library"),
    ],
    "planning": [
        *(
            "include/cspace/math",
            "include/cspace/collision",
            "include/cspace/planning",
            "include/cspace/search",
        ),
        *("include/cspace/shapes", "src/cspace/collision", "src/cspace/planning", "src/cspace/plan_motion"),
        *("src/kernels/collision.cpp", "src/kernels/search.cpp", "src/library"),
    ],
    "dynamics": [
        *("include/cspace/math", "include/cspace/model", "include/cspace/dynamics"),
        *("src/kernels/dynamics.cpp", "src/bindings/dynamics.cpp"),
    ],
    "simulation": [
        *("include/cspace/math", "include/cspace/model", "include/cspace/dynamics"),
        *("src/kernels/dynamics_simulation.cpp", "src/library/dynamics_roll_out.cpp"),
        *("src/bindings/dynamics_simulation.cpp", "src/cspace/dynamics/roll_out.py"),
    ],
    "trajectory": [
        *("include/cspace/math", "include/cspace/trajectory", "src/cspace/trajectory"),
        *("src/library/trajectory_states.cpp", "src/bindings/trajectory.cpp"),
    ],
    "path_timing": [
        *("include/cspace/math", "include/cspace/trajectory", "src/cspace/trajectory"),
        "src/bindings/trajectory_timing.cpp",
    ],
    "timing_memory": [
        *("include/cspace/trajectory", "src/cspace/trajectory", "src/bindings/trajectory_timing.cpp"),
        *("src/library/trajectory_timing.cpp", "src/library/trajectory_jerk.cpp"),
    ],
    "cartesian": [
        *("include/cspace/ik/tracking", "include/cspace/trajectory", "src/cspace/trajectory"),
        *("src/cspace/cartesian", "src/cspace/plan_motion", "src/bindings/ik_tracking.cpp"),
    ],
    "pose_graphs": [
        *("include/cspace/math/sparse", "include/cspace/localization/graph", "src/cspace/localization/graph"),
        *("src/kernels/math_fronts.cpp", "src/library/localization_graph.cpp"),
        "src/library/localization_incremental.cpp",
    ],
    "incremental_graphs": [
        *("include/cspace/math/sparse", "include/cspace/localization/graph", "src/cspace/localization/graph"),
        *("src/kernels/math_fronts.cpp", "src/library/localization_graph.cpp"),
        "src/library/localization_incremental.cpp",
    ],
    "false_loops": [
        *("include/cspace/math/sparse", "include/cspace/localization/graph", "src/cspace/localization/graph"),
        *("src/kernels/math_fronts.cpp", "src/library/localization_graph.cpp"),
        "src/library/localization_incremental.cpp",
    ],
    "monte_carlo": [
        *("include/cspace/localization/particles", "include/cspace/localization/scans/map_search.hpp"),
        *("src/cspace/localization/particles", "src/cspace/localization/scans/search.py"),
        *("src/kernels/localization_particles.cpp", "src/library/localization_particles.cpp"),
    ],
    "laser_slam": [
        *("include/cspace/localization/scans", "include/cspace/localization/graph", "include/cspace/maps"),
        *("src/cspace/localization/laser_slam", "src/cspace/localization/scans", "src/cspace/mobile"),
        "src/kernels/localization_correlation.cpp",
    ],
    "map_search": [
        *("include/cspace/localization/scans", "include/cspace/maps", "src/cspace/localization/scans"),
        "src/kernels/localization_search.cpp",
    ],
    "landmark_slam": [
        *("include/cspace/localization/landmarks", "src/cspace/localization/landmark_slam"),
        *("src/kernels/localization_landmarks.cpp", "src/cspace/mobile"),
    ],
    "consistency": [
        *("include/cspace/localization/landmarks", "src/cspace/localization/landmark_slam"),
        *("src/cspace/localization/filters", "src/kernels/localization_landmarks.cpp", "src/cspace/mobile"),
    ],
    "localization": ["src/cspace/localization/filters", "src/cspace/mobile"],
    "": [
        *("include/cspace/math", "include/cspace/kinematics", "include/cspace/ik", "src/kernels"),
        *("src/library", "src/bindings", "src/cspace/ik", "src/cspace/kinematics"),
    ],
}
"""What results of a name, or of a name that begins so, speak of; those of arms are under ""."""

KINDS = {".hpp", ".cpp", ".in", ".py", ".toml", ".txt"}


def fingerprint(paths: Iterable[Path]) -> str:
    """Of the names and contents of files."""
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def sources_of(name: str) -> str:
    """The fingerprint of the sources that a result speaks of today."""
    kind = next(kind for kind in SOURCES if name.startswith(kind))
    files: list[Path] = []
    for place in (ROOT / part for part in SOURCES[kind]):
        files += [place] if place.is_file() else [p for p in place.rglob("*") if p.suffix in KINDS]
    return fingerprint(files)


def read_records() -> dict[str, dict[str, str]]:
    found: dict[str, dict[str, str]] = json.loads(RECORDS.read_text()) if RECORDS.exists() else {}
    return found


def record(names: Iterable[str]) -> None:
    """Notes results that are new together with the sources of today."""
    records, known = read_records(), RECORDS.exists()
    for name in names:
        path = RESULTS / f"{name}.json"
        result = fingerprint([path] if path.exists() else [])
        if path.exists() and records.get(name, {}).get("result") != result:
            records[name] = {"result": result, "sources": sources_of(name) if known else "before records"}
    RECORDS.write_text(json.dumps(dict(sorted(records.items())), indent=1) + "\n")


def older(names: Iterable[str]) -> list[str]:
    """The results that are older than their sources."""
    records = read_records()
    measured = [name for name in names if (RESULTS / f"{name}.json").exists()]
    return sorted(n for n in measured if records.get(n, {}).get("sources") != sources_of(n))


def section(names: list[str]) -> str:
    """What the page says of them."""
    if not names:
        return "All results were measured with the present sources."
    return (
        "**Older than the sources.** These results were measured before their sources changed last, and may "
        "differ today: " + ", ".join(name.replace("_", " ") for name in names) + "."
    )
