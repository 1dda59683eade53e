"""How long robots take to load: ours beside Pinocchio, yourdfpy and urchin where they are installed.

Run `python benchmarks/loading.py`. Medians of warm calls in one process, in processor time, so that a busy
machine counts little; the files are those of the package example-robot-data. Ours reads and checks everything
(inertias, shapes, limits) into Python objects; Pinocchio builds its kinematic model in C++; yourdfpy and
urchin are told not to load meshes.
"""

from __future__ import annotations

import importlib
import importlib.util
import platform
import statistics
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path

import cspace as cs
from cspace import model

ROBOTS = ("ur5_robot", "panda", "pr2", "talos_full_v2", "tiago_dual")


def median_ms(call: Callable[[], object], seconds: float = 0.5) -> float:
    """The median processor time of a call [ms] over half a second, at least five calls."""
    call()
    times: list[float] = []
    end = time.perf_counter() + seconds
    while len(times) < 5 or time.perf_counter() < end:
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return statistics.median(times) * 1e3


def urdf_files() -> dict[str, Path]:
    """The robots of example-robot-data by file name."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return {}
    found = {Path(str(file)).stem: Path(str(file.locate())) for file in files if str(file).endswith(".urdf")}
    return {name: found[name] for name in ROBOTS if name in found}


def readers() -> dict[str, Callable[[str], object]]:
    """Every reader that is installed: name → reads the file at a path."""
    found: dict[str, Callable[[str], object]] = {
        "cspace description": model.from_urdf,
        "cspace robot": cs.Robot.from_urdf,
    }
    if importlib.util.find_spec("pinocchio"):
        found["pinocchio model"] = importlib.import_module("pinocchio").buildModelFromUrdf
    if importlib.util.find_spec("yourdfpy"):
        urdf = importlib.import_module("yourdfpy").URDF
        found["yourdfpy"] = lambda path: urdf.load(path, build_scene_graph=True, load_meshes=False)
    if importlib.util.find_spec("urchin"):
        found["urchin"] = lambda path: importlib.import_module("urchin").URDF.load(
            path, lazy_load_meshes=True
        )
    return found


def main() -> None:
    print(
        f"Python {platform.python_version()}, {platform.machine()}; warm loads, median ms of processor time\n"
    )
    by_name = readers()
    versions = {name: metadata.version(name) for name in ("pin", "yourdfpy", "urchin") if installed(name)}
    print("| file | links |", " | ".join(by_name), "|")
    print("|---|---|" + "---|" * len(by_name))
    for name, path in urdf_files().items():
        links = len(model.from_urdf(path).links)
        times = [f"{median_ms(lambda r=read, p=path: r(str(p))):.2f}" for read in by_name.values()]
        print(f"| {name} | {links} | " + " | ".join(times) + " |")
    print("\nversions:", versions or "no peers installed")
    for name in ("ur5e", "panda", "puma560_dh"):
        description = median_ms(lambda n=name: cs.robots.load_description(n))
        robot = median_ms(lambda n=name: cs.load_robot(n))
        print(f"catalogue {name}: description {description:.2f} ms, robot {robot:.2f} ms")


def installed(package: str) -> bool:
    try:
        metadata.version(package)
    except metadata.PackageNotFoundError:
        return False
    return True


if __name__ == "__main__":
    main()
