"""Finds pairs of links whose capsules touch though their meshes stay apart, for `allowed_pairs` of a catalogue file.

    python tools/apart_links.py ur5e ur.urdf.xacro --package-path ros --xacro-arg ur_type=ur5e --write

A pair is listed if its spheres touch at more than RARE of SAMPLES random configurations while the meshes are
never closer than APART. Also prints how many configurations are free of self-collisions, by spheres and by
meshes. Needs coal.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from fit_capsules import arguments, catalogue_file, check_frames, load_file, meshes_of

from cspace.arrays import Array
from cspace.robot import Robot
from cspace.robots import load_description
from cspace.shapes import Mesh
from cspace.spatial.poses import transform_points

SAMPLES: Final = 4000
"""Random configurations."""
RARE: Final = 0.003
"""Share of configurations at which a pair may touch falsely and is checked all the same."""
APART: Final = 0.002
"""The least distance of meshes [m] that never touch; a gap of this size is closed by tolerances of the parts."""
REASON: Final = f"links apart at each of {SAMPLES} random configurations"


def solid_of(meshes: Sequence[Mesh]) -> Any:
    """The collision object of coal for the meshes of a link."""
    import coal

    model = coal.BVHModelOBBRSS()
    model.beginModel(0, 0)
    for mesh in meshes:
        vertices, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
        for vertex in transform_points(mesh.pose, mesh.vertices):
            vertices.append(vertex)
        for face in mesh.faces:
            faces.append(coal.Triangle(*map(int, face)))
        model.addSubModel(vertices, faces)
    model.endModel()
    return model


def mesh_distance(a: Any, T_a: Array, b: Any, T_b: Array) -> float:
    """The distance of two solids at poses (4, 4) [m], zero where they touch."""
    import coal

    places = [coal.Transform3s(T[:3, :3], T[:3, 3]) for T in (T_a, T_b)]
    found = coal.CollisionResult()
    if coal.collide(a, places[0], b, places[1], coal.CollisionRequest(), found):
        return 0.0
    return float(coal.distance(a, places[0], b, places[1], coal.DistanceRequest(), coal.DistanceResult()))


def main() -> None:
    given = arguments(__doc__.splitlines()[0])
    whole, rng = load_file(given), np.random.default_rng(1)
    description = replace(load_description(given.name), allowed_pairs=())
    robot = Robot(description)
    geometry = robot.collision
    solids = {link: solid_of(meshes_of(whole, link)) for link in geometry.links}
    check_frames(robot, Robot(whole), geometry.links, rng)
    q = robot.random_configuration(SAMPLES, rng=2)
    poses = {link: robot.fk(q, link) for link in geometry.links}
    spheres = local_spheres(robot)
    free = {"spheres": np.ones(SAMPLES, dtype=bool), "meshes": np.ones(SAMPLES, dtype=bool)}
    allowed = []
    for i, j in geometry.pairs:
        a, b = geometry.links[i], geometry.links[j]
        touching = np.flatnonzero(touching_samples(poses, spheres, a, b))
        apart = [mesh_distance(solids[a], poses[a][k], solids[b], poses[b][k]) for k in touching]
        least = min(apart, default=np.inf)
        free["meshes"][touching[np.array(apart) == 0.0]] = False
        if len(touching) > RARE * SAMPLES and least > APART:
            allowed.append((a, b, REASON))
        else:
            free["spheres"][touching] = False
        print(f"{a}, {b}: {len(touching)} touch, meshes at least {1e3 * least:.1f} mm apart", flush=True)
    print({name: float(value.mean()) for name, value in free.items()}, allowed)
    if given.write:
        write_pairs(given.name, allowed)


def local_spheres(robot: Robot) -> dict[str, Array]:
    """The spheres (n, 4) of each link in its own frame."""
    geometry, found = robot.collision, {}
    for k, link in enumerate(geometry.links):
        rows = geometry.spheres[geometry.sphere_links == k].copy()
        rows[:, :3] = transform_points(np.linalg.inv(geometry.frames[link][1]), rows[:, :3])
        found[link] = rows
    return found


def touching_samples(poses: Mapping[str, Array], spheres: Mapping[str, Array], a: str, b: str) -> Array:
    """Whether the spheres of two links touch at each sample (n,)."""
    p, q = (transform_points(poses[link][:, None], spheres[link][:, :3]) for link in (a, b))
    gaps = np.linalg.norm(p[:, :, None] - q[:, None], axis=-1)
    return (gaps < spheres[a][:, None, 3] + spheres[b][:, 3]).any((1, 2))


def write_pairs(name: str, allowed: Sequence[tuple[str, str, str]]) -> None:
    """Put allowed pairs into the catalogue file of a robot, before its sources."""
    path = catalogue_file(name)
    text = re.sub(r"allowed_pairs = \[\n(?:  .*\n)*\]\n", "", path.read_text(encoding="utf-8"))
    if allowed:
        rows = "".join(f'  ["{a}", "{b}", "{why}"],\n' for a, b, why in allowed)
        text = text.replace("\n[sources.", f"allowed_pairs = [\n{rows}]\n\n[sources.", 1)
    path.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
