"""Fits capsules to the collision meshes of a robot and writes them into its catalogue file.

    python tools/fit_capsules.py ur5e ur.urdf.xacro --package-path ros --xacro-arg ur_type=ur5e --write

The links of the robot file must have the frames of the catalogue, which is checked. A capsule (a, b, r) is the
set of points within r of the segment a b. The capsules of a link minimise

    Σ w₁ max(0, s − d)² + w₂ max(0, s − d − OUTSIDE)² + max(0, d − s)²

over points of the surface (d = 0) and around it, where d is the distance from the mesh and s that from the
capsules. Then radii grow until no part of the surface is farther than OUTSIDE outside. Needs scipy.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "src"))

from cspace.arrays import Array  # noqa: E402
from cspace.model import Description, from_toml, from_urdf, from_xacro  # noqa: E402
from cspace.robot import Robot  # noqa: E402
from cspace.robots import load_description  # noqa: E402
from cspace.shapes import Mesh  # noqa: E402
from cspace.spatial.poses import transform_points  # noqa: E402
from cspace.spatial.vectors import frame_along  # noqa: E402

OUTSIDE: Final = 0.006
"""How far [m] a part of the surface may lie outside of the capsules: less than obstacles are padded by."""
MOST: Final = 7
"""Capsules per link; more of them hardly fit better, since links are mostly tubes with round ends."""
GAIN: Final = 0.85
"""A further capsule must lower the cost to this share."""
FIT_POINTS: Final = 800
"""Of the surface, and as many around it, for the fit."""
CHECK_POINTS: Final = 12_000
"""Of the surface, for what is reported."""
EXCESS_POINTS: Final = 4000
"""Of the capsules, for how far they stick out."""
CELL: Final = 0.004
"""Side of the cells [m] that stand for the surface where views are blocked."""
CELL_POINTS: Final = 200_000
"""Of the surface, which fill the cells."""
RAYS: Final = 60
"""Directions of view from a point."""
VIEW: Final = 0.12
"""How far rays go [m]: farther than links are thick."""
HIDDEN: Final = 0.85
"""Share of blocked rays from which on a point counts as inside: between those in a tube and beside a wall."""
REACH: Final = 0.08
"""How far [m] from the surface the points around it lie."""
UNCOVERED_WEIGHTS: Final = (2.0, 60.0)
"""Of surface outside, and outside by more than OUTSIDE, against capsules that stick out."""
STEPS: Final = 400
"""Of the descent (Adam, Kingma and Ba 2015); the cost is level by then."""
RATE: Final = 0.002
"""Length of a step [m] at the start."""
STARTS: Final = 2
"""Descents from different clusters per number of capsules."""
FRAME_ERROR: Final = 1e-4
"""How far [m or unit vectors] frames of the two files may differ: files round π/2 to four digits."""
THIN: Final = 0.003
"""The smallest radius [m]."""


@dataclass(frozen=True)
class Surface:
    """Points (n, 3) of a surface, evenly spread by area, with outward normals (n, 3), and its area [m²]."""

    points: Array
    normals: Array
    area: float


@dataclass(frozen=True)
class Capsules:
    """Segments from a (k, 3) to b (k, 3) with radii r (k,) [m]."""

    a: Array
    b: Array
    r: Array

    def distances(self, points: Array) -> tuple[Array, Array, Array]:
        """Signed distances (n, k) of points (n, 3), unit vectors away from the segments (n, k, 3) and where
        on the segments (n, k), from 0 to 1, the closest points are."""
        along = self.b - self.a
        from_a = points[:, None] - self.a
        t = np.clip((from_a * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-12), 0.0, 1.0)
        away = from_a - t[..., None] * along
        far = np.linalg.norm(away, axis=-1)
        return far - self.r, away / np.maximum(far, 1e-9)[..., None], t


@dataclass(frozen=True)
class Report:
    """What is outside: share and most [m] of the surface outside of the capsules; most and mean [m] that the
    capsules stick out of the mesh. area [m²]: of the surface."""

    area: float
    share: float
    outside: float
    excess: float
    mean_excess: float


def sample_surface(meshes: Sequence[Mesh], count: int, rng: np.random.Generator) -> Surface:
    """Points of the surfaces of meshes."""
    triangles = np.concatenate([transform_points(m.pose, m.vertices)[m.faces] for m in meshes])
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1) / 2.0
    which = rng.choice(len(areas), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    points = a[which] + u * (b - a)[which] + v * (c - a)[which]
    units = normals[which] / np.maximum(2.0 * areas[which], 1e-18)[:, None]
    return Surface(points, units, float(areas.sum()))


class Occlusion:
    """How much of the view from a point the surface blocks, by rays through cells that it fills."""

    def __init__(self, points: Array) -> None:
        self.low = points.min(0) - 2.0 * CELL
        shape = ((points.max(0) - self.low) / CELL).astype(int) + 3
        self.filled = np.zeros(shape, dtype=bool)
        self.filled[tuple(self.cells(points).T)] = True
        k = np.arange(RAYS) + 0.5  # a Fibonacci sphere
        z, turn = 1.0 - 2.0 * k / RAYS, np.pi * (1.0 + 5.0**0.5) * k
        flat = np.sqrt(1.0 - z**2)
        self.rays = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), z])

    def cells(self, points: Array) -> Array:
        """The indices of the cells of points, those outside of the grid in its empty border."""
        found = ((points - self.low) / CELL).astype(int)
        return np.clip(found, 0, np.array(self.filled.shape) - 1)

    def hidden(self, points: Array) -> Array:
        """Whether the surface blocks nearly the whole view, as from inside of a solid or of a shell (n,)."""
        blocked = np.zeros((len(points), RAYS), dtype=bool)
        for far in np.arange(1.5, VIEW / CELL) * CELL:
            cells = self.cells(points[:, None] + far * self.rays)
            blocked |= self.filled[cells[..., 0], cells[..., 1], cells[..., 2]]
        return blocked.mean(1) > HIDDEN


def outer_surface(meshes: Sequence[Mesh], rng: np.random.Generator) -> tuple[Surface, Occlusion]:
    """The part of the surface that is seen from outside; shells and motors inside of a link are not."""
    whole = sample_surface(meshes, CHECK_POINTS, rng)
    occlusion = Occlusion(sample_surface(meshes, CELL_POINTS, rng).points)
    seen = ~occlusion.hidden(whole.points + 1.5 * CELL * whole.normals)
    return Surface(whole.points[seen], whole.normals[seen], whole.area * float(seen.mean())), occlusion


def points_around(
    surface: Surface, dense: cKDTree, occlusion: Occlusion, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Points outside of the mesh and their distances from it [m]."""
    chosen = rng.integers(len(surface.points), size=FIT_POINTS)
    far = REACH * rng.random((FIT_POINTS, 1)) ** 2
    noise = rng.normal(size=(FIT_POINTS, 3)) * 0.3 * far
    points = surface.points[chosen] + far * surface.normals[chosen] + noise
    distance, nearest = dense.query(points)
    outer = ((points - surface.points[nearest]) * surface.normals[nearest]).sum(1) > 0.0
    outer[outer] = ~occlusion.hidden(points[outer])
    return points[outer], distance[outer]


def cluster(points: Array, k: int, rng: np.random.Generator) -> Array:
    """The number of the cluster of each point, by Lloyd's iteration."""
    centers = points[rng.choice(len(points), k, replace=False)]
    for _ in range(25):
        owner = np.linalg.norm(points[:, None] - centers, axis=-1).argmin(1)
        centers = np.array(
            [points[owner == j].mean(0) if (owner == j).any() else centers[j] for j in range(k)]
        )
    return owner


def start_capsules(points: Array, k: int, rng: np.random.Generator) -> Capsules:
    """A capsule along the longest axis of each cluster."""
    owner, rows = cluster(points, k, rng), []
    for j in range(k):
        part = points[owner == j] if (owner == j).sum() > 3 else points
        middle = part.mean(0)
        _, _, axes = np.linalg.svd(part - middle, full_matrices=False)
        along = (part - middle) @ axes[0]
        radius = max(THIN, float(np.linalg.norm((part - middle) - along[:, None] * axes[0], axis=1).mean()))
        half = max(1e-3, float(np.ptp(along)) / 2.0 - radius)
        rows.append((middle - half * axes[0], middle + half * axes[0], radius))
    a, b, r = (np.array(column) for column in zip(*rows, strict=True))
    return Capsules(a, b, r)


def cost_and_slopes(c: Capsules, points: Array, distance: Array) -> tuple[float, Array]:
    """The cost and its derivatives (k, 7) by a, b and r."""
    s, away, t = c.distances(points)
    row, nearest = np.arange(len(points)), s.argmin(1)
    gap = s[row, nearest] - distance
    w1, w2 = np.where(distance == 0.0, 1.0, 0.0) * np.array(UNCOVERED_WEIGHTS)[:, None]
    over, far, out = np.maximum(gap, 0.0), np.maximum(gap - OUTSIDE, 0.0), np.maximum(-gap, 0.0)
    out = np.where(distance == 0.0, 0.0, out)
    cost = (w1 * over**2 + w2 * far**2 + out**2).sum() / len(points)
    slope = 2.0 * (w1 * over + w2 * far - out) / len(points)
    u, share = away[row, nearest], t[row, nearest]
    slopes = np.zeros((len(c.r), 7))
    np.add.at(slopes[:, :3], nearest, -(slope * (1.0 - share))[:, None] * u)
    np.add.at(slopes[:, 3:6], nearest, -(slope * share)[:, None] * u)
    np.add.at(slopes[:, 6], nearest, -slope)
    return float(cost), slopes


def descend(start: Capsules, points: Array, distance: Array) -> tuple[float, Capsules]:
    """The capsules of the lowest cost of a descent, and that cost."""
    x = np.column_stack([start.a, start.b, start.r])
    mean, square = np.zeros_like(x), np.zeros_like(x)
    best, best_x = np.inf, x
    for step in range(1, STEPS + 1):
        cost, slopes = cost_and_slopes(Capsules(x[:, :3], x[:, 3:6], x[:, 6]), points, distance)
        if cost < best:
            best, best_x = cost, x.copy()
        mean, square = 0.9 * mean + 0.1 * slopes, 0.99 * square + 0.01 * slopes**2
        unit = mean / (1.0 - 0.9**step) / (np.sqrt(square / (1.0 - 0.99**step)) + 1e-12)
        x = x - RATE * (1.0 - step / (STEPS + 1)) * unit
        x[:, 6] = np.maximum(x[:, 6], THIN)
    return best, Capsules(best_x[:, :3], best_x[:, 3:6], best_x[:, 6])


def fit_link(meshes: Sequence[Mesh], rng: np.random.Generator) -> Capsules:
    """Few capsules of a link, in its frame."""
    dense, occlusion = outer_surface(meshes, rng)
    tree = cKDTree(dense.points)
    some = dense.points[rng.choice(len(dense.points), min(FIT_POINTS, len(dense.points)), replace=False)]
    around, distance = points_around(dense, tree, occlusion, rng)
    points, distances = np.concatenate([some, around]), np.concatenate([np.zeros(len(some)), distance])
    best, fewest, best_k = np.inf, start_capsules(some, 1, rng), 1
    for k in range(1, MOST + 1):
        tries = [descend(start_capsules(some, k, rng), points, distances) for _ in range(STARTS)]
        cost, found = min(tries, key=lambda item: item[0])
        if cost < GAIN ** (k - best_k) * best:
            best, fewest, best_k = cost, found, k
        elif k > best_k + 1:
            break
    return grow(round_capsules(fewest), dense.points)


def round_capsules(c: Capsules) -> Capsules:
    """The same capsules to tenths of a millimetre."""
    return Capsules(c.a.round(4), c.b.round(4), c.r.round(4))


def grow(c: Capsules, points: Array) -> Capsules:
    """Larger radii, so that no point is farther than OUTSIDE outside."""
    r = c.r.copy()
    s = c.distances(points)[0]
    for row in s[np.argsort(-s.min(1))]:
        gap = row - (r - c.r)
        if gap.min() > OUTSIDE:
            k = int(gap.argmin())
            r[k] = np.ceil((r[k] + gap[k] - OUTSIDE) * 1e4) / 1e4
    return Capsules(c.a, c.b, r)


def report(
    c: Capsules, surface: Surface, tree: cKDTree, occlusion: Occlusion, rng: np.random.Generator
) -> Report:
    """What is outside of capsules, and what they stick out."""
    s = c.distances(surface.points)[0].min(1)
    points = points_on(c, rng)
    far, nearest = tree.query(points)
    outer = ((points - surface.points[nearest]) * surface.normals[nearest]).sum(1) > 0.0
    outer[outer] = ~occlusion.hidden(points[outer])
    far = np.where(outer, far, 0.0)
    share, outside = float((s > 0.0).mean()), float(max(s.max(), 0.0))
    return Report(surface.area, share, outside, float(far.max()), float(far.mean()))


def points_on(c: Capsules, rng: np.random.Generator) -> Array:
    """Points (n, 3) of the surface of the union of capsules."""
    count = EXCESS_POINTS
    which = rng.integers(len(c.r), size=count)
    sphere = rng.normal(size=(count, 3))
    sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    axis = (c.b - c.a)[which]
    length = np.linalg.norm(axis, axis=1)
    unit = axis / np.maximum(length, 1e-9)[:, None]
    side = rng.random(count) < length / (length + 2.0 * c.r[which])
    radial = sphere - (sphere * unit).sum(1, keepdims=True) * unit
    radial /= np.maximum(np.linalg.norm(radial, axis=1, keepdims=True), 1e-9)
    cap = np.where((sphere * unit).sum(1) > 0.0, 1.0, 0.0)[:, None]
    place = np.where(side[:, None], rng.random((count, 1)), cap)
    points = c.a[which] + place * axis + c.r[which][:, None] * np.where(side[:, None], radial, sphere)
    return points[c.distances(points)[0].min(1) > -1e-6]


def meshes_of(description: Description, link: str) -> list[Mesh]:
    """The collision meshes of a link, in its frame."""
    return [
        Mesh.from_file(g.mesh.file(), scale=g.mesh.scale, pose=g.origin)
        for g in description.link(link).collision
        if g.mesh is not None
    ]


def capsules_of(description: Description, link: str) -> Capsules:
    """The capsules and spheres of a link of the catalogue."""
    rows = []
    for g in description.link(link).collision:
        half = g.size[1] / 2.0 if g.shape == "capsule" else 0.0
        middle, along = g.origin[:3, 3], half * g.origin[:3, 2]
        rows.append((middle - along, middle + along, g.size[0]))
    return Capsules(*(np.array(column) for column in zip(*rows, strict=True)))


def measure_link(description: Description, whole: Description, link: str) -> Report:
    """What is outside of the capsules of the catalogue."""
    rng = np.random.default_rng(3)
    surface, occlusion = outer_surface(meshes_of(whole, link), rng)
    return report(capsules_of(description, link), surface, cKDTree(surface.points), occlusion, rng)


def summary(found: Sequence[Report]) -> str:
    """The coverage of a robot, for [sources.collision]."""
    area = sum(item.area for item in found)
    share = sum(item.area * item.share for item in found) / area
    mean = float(np.mean([item.mean_excess for item in found]))
    return (
        f"{100 * share:.0f} % of their outer surface lies outside of the capsules, by at most"
        f" {1e3 * max(item.outside for item in found):.1f} mm; the capsules stick out by at most"
        f" {1e3 * max(item.excess for item in found):.0f} mm, by {1e3 * mean:.0f} mm in the mean"
    )


def check_frames(known: Robot, other: Robot, links: Sequence[str], rng: np.random.Generator) -> None:
    """Stop unless the frames of links are the same in both robots at random configurations."""
    for q in known.random_configuration(5, rng=rng):
        values = dict(zip(known.joint_names, q, strict=True))
        other_q = np.array([values.get(name, 0.0) for name in other.joint_names])
        for link in links:
            one = np.linalg.solve(known.fk(q, known.base), known.fk(q, link))
            two = np.linalg.solve(other.fk(other_q, known.base), other.fk(other_q, link))
            if np.abs(one - two).max() > FRAME_ERROR:
                sys.exit(f"{link}: frames differ by {np.abs(one - two).max():.2g}")


def capsule_text(a: Array, b: Array, r: float) -> Iterator[str]:
    """The lines of a capsule in a catalogue file."""
    length = float(np.linalg.norm(b - a))
    yield "\n[[links.collision]]"
    if length < THIN:
        yield f'shape = "sphere"\nsize = [{r:.4f}]'
    else:
        yield f'shape = "capsule"\nsize = [{r:.4f}, {length:.4f}]'
    x, y, z = (a + b) / 2.0
    yield f"xyz = [{x:.4f}, {y:.4f}, {z:.4f}]"
    if length >= THIN:
        z_axis = frame_along((b - a) / length)[:, 2]
        roll, pitch = -np.arcsin(np.clip(z_axis[1], -1, 1)), np.arctan2(z_axis[0], z_axis[2])
        yield f"rpy = [{roll:.4f}, {pitch:.4f}, 0.0]"


def link_text(c: Capsules) -> list[str]:
    """The lines of the capsules of a link."""
    return [line for row in zip(c.a, c.b, c.r, strict=True) for line in capsule_text(*row)]


def catalogue_file(name: str) -> Path:
    return ROOT / f"src/cspace/robots/catalogue/{name}.toml"


def write_capsules(name: str, fitted: dict[str, Capsules]) -> None:
    """Put capsules into the catalogue file of a robot, in place of its collision elements."""
    path = catalogue_file(name)
    text = re.sub(r"\n\[\[links\.collision\]\]\n(?:\w+ = .*\n)+", "", path.read_text(encoding="utf-8"))
    for link, c in fitted.items():
        head = f'[[links]]\nname = "{link}"\n'
        assert text.count(head) == 1, link
        text = text.replace(head, head + "\n".join(link_text(c)) + "\n")
    text = re.sub(r'"collision", |, "collision"(?=\])|(?<=\[)"collision"(?=\])', "", text, count=1)
    path.write_text(text, encoding="utf-8", newline="\n")


def arguments(summary: str) -> argparse.Namespace:
    """The arguments of the command."""
    parser = argparse.ArgumentParser(description=summary)
    parser.add_argument("name", help="of the catalogue")
    parser.add_argument("file", help="the URDF or xacro file of the robot")
    parser.add_argument("--package-path", action="append", default=[])
    parser.add_argument("--xacro-arg", action="append", default=[], metavar="NAME=VALUE")
    parser.add_argument("--measure", action="store_true", help="only what is in the catalogue file")
    parser.add_argument("--write", action="store_true", help="change the catalogue file")
    return parser.parse_args()


def load_file(given: argparse.Namespace) -> Description:
    """The robot with the meshes."""
    if given.file.endswith(".urdf"):
        return from_urdf(given.file, package_paths=given.package_path)
    pairs = dict(item.split("=", 1) for item in given.xacro_arg)
    return from_xacro(given.file, xacro_args=pairs, package_paths=given.package_path)


def main() -> None:
    given = arguments(__doc__.splitlines()[0])
    whole = load_file(given)
    description, rng = load_description(given.name), np.random.default_rng(0)
    links = [link for link in description.link_by_name if link in whole.link_by_name]
    links = [link for link in links if meshes_of(whole, link)]
    check_frames(Robot(description), Robot(whole), links, rng)
    fitted = {} if given.measure else {link: fit_link(meshes_of(whole, link), rng) for link in links}
    if given.write:
        write_capsules(given.name, fitted)
        description = from_toml(catalogue_file(given.name))
    elif fitted:
        print("\n".join(line for c in fitted.values() for line in link_text(c)))
        return
    found = [measure_link(description, whole, link) for link in links]
    for link, item in zip(links, found, strict=True):
        print(f"{link}: {len(description.link(link).collision)} capsules, {summary([item])}")
    print(summary(found))


if __name__ == "__main__":
    main()
