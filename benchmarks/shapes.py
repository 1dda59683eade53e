"""Covers of robots' meshes by spheres: how many, how far they stick out, and how long the search takes.

Run `python benchmarks/shapes.py`, with the package example-robot-data installed. Every cover is proved; the
stick-out is the bound that the cover states, beside the two bounds that `measure_cover` finds. Open meshes
are covered as surfaces, or with their holes filled. Times are processor time on one core, without the cache.
"""

from __future__ import annotations

import platform
import time
from importlib import metadata
from pathlib import Path

import numpy as np

from cspace import shapes

ROBOTS = {
    "Panda, collision": "panda_description/meshes/collision/*.stl",
    "Panda, drawn": "panda_description/meshes/visual/*.dae",
    "Panda, drawn, filled": "panda_description/meshes/visual/*.dae",
    "UR5, collision": "ur_description/meshes/ur5/collision/*.stl",
    "UR10, collision, filled": "ur_description/meshes/ur10/collision/*.stl",
    "SO-101": "so_arm_description/meshes/so101/*.stl",
}
WITHIN = (0.03, 0.02, 0.01, 0.005)


def mesh_files(pattern: str) -> list[Path]:
    """The meshes of example-robot-data that match."""
    files = metadata.files("example-robot-data") or []
    found = [Path(str(file.locate())) for file in files if file.match(pattern)]
    return sorted(found)


def measure_robot(name: str, meshes: list[shapes.Mesh], within: float) -> str:
    """The row of a robot."""
    began = time.process_time()
    covers = [shapes.cover_mesh(mesh, within, cache=False) for mesh in meshes]
    found = time.process_time() - began
    measures = [
        shapes.measure_cover(mesh, c.centers, c.radii) for mesh, c in zip(meshes, covers, strict=True)
    ]
    low, high = np.max([m.stick_out for m in measures], axis=0) * 1e3
    cells = [
        name,
        f"{sum(mesh.solid for mesh in meshes)} of {len(meshes)}",
        f"{sum(len(mesh.faces) for mesh in meshes)}",
        f"{within * 1e3:g}",
        f"{sum(map(len, covers))}",
        f"{max(c.stick_out for c in covers) * 1e3:.2f}",
        f"{low:.2f} to {high:.2f}",
        f"{sum(c.parts for c in covers)}",
        f"{found:.2f}",
    ]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    print(f"Python {platform.python_version()}, {platform.machine()}\n")
    titles = "robot, closed, triangles, within [mm], spheres, stick-out [mm], measured [mm], parts, time [s]"
    columns = titles.split(", ")
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))
    for name, pattern in ROBOTS.items():
        meshes = [shapes.Mesh.from_file(path) for path in mesh_files(pattern)]
        if name.endswith("filled"):
            meshes = [mesh if mesh.solid else mesh.fill_holes() for mesh in meshes]
        for within in WITHIN:
            print(measure_robot(name, meshes, within), flush=True)


if __name__ == "__main__":
    main()
