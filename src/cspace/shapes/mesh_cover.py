"""Covers of meshes and hulls by spheres, proved by a check of their own; measures of given spheres."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, one_array, positive_number
from cspace.errors import InputError, InputTypeError, TimeLimitError, name_type
from cspace.shapes.cover_cache import find_key, load_cover, store_cover
from cspace.shapes.shape import Shape
from cspace.spatial.poses import inverse_pose, transform_points
from cspace.tables import one_line, show_fields, shown, tabulate
from cspace.tolerances import LARGEST_NUMBER, MEASURE_TOLERANCE


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class SphereCover:
    """Spheres that contain a solid, or a surface, and a bound on how far they stick out of it.

    centers (n, 3) [m] in the frame where the shape is placed; radii (n,) [m]. stick_out [m]: no place in a
    sphere is farther from the shape. uncovered_depth [m]: no place of the shape is farther from all spheres;
    0, which is proved by `parts` triangles and cells that lie whole in one sphere each. solid: the inside is
    contained; else the surface alone. seconds: of the search, or of reading a cover that was kept.
    """

    centers: Array
    radii: Array
    stick_out: float
    uncovered_depth: float
    solid: bool
    parts: int
    seconds: float

    @property
    def spheres(self) -> Array:
        """Centres and radii (n, 4) [m]."""
        return np.column_stack([self.centers, self.radii])

    def __len__(self) -> int:
        """The number of spheres."""
        return len(self.radii)

    def __repr__(self) -> str:
        what = "solid" if self.solid else "surface"
        text = (
            f"{len(self)} spheres of {shown(self.radii.min())} to {shown(self.radii.max())} m around a {what}"
        )
        proof = f"stick out ≤ {shown(self.stick_out)} m, nothing uncovered ({self.parts} parts)"
        return one_line(type(self).__name__, f"{text}, {proof}")


@show_fields
class Bounds(NamedTuple):
    """A number between two bounds."""

    lower: float
    upper: float


@tabulate()
@dataclass(frozen=True, repr=False)
class CoverMeasure:
    """How well given spheres cover a shape; each number between two bounds.

    stick_out [m]: the largest distance of a place in a sphere from the shape. uncovered_depth [m]: the
    largest distance of a place of the shape from the nearest sphere. uncovered_share: the area of the surface
    outside of all spheres, over the whole.
    """

    stick_out: Bounds
    uncovered_depth: Bounds
    uncovered_share: Bounds

    @property
    def covered(self) -> bool:
        """Whether the spheres are proved to contain the shape."""
        return self.uncovered_depth.upper == 0.0

    def __repr__(self) -> str:
        out, depth, share = map(show_bounds, (self.stick_out, self.uncovered_depth, self.uncovered_share))
        return one_line(
            type(self).__name__, f"stick-out {out} m, uncovered: {share} of the surface, up to {depth} m"
        )


def cover_mesh(
    mesh: Shape,
    within: float = 0.01,
    inside: bool = True,
    *,
    time_limit: float | None = None,
    cache: bool = True,
) -> SphereCover:
    """Few spheres that contain a mesh, a hull or a height field and stick out of it by at most `within` [m].

    Around a centre at depth d below the surface a sphere of radius d + within is allowed. Centres are
    candidates near the medial axis: the largest ball that touches the surface at a sample (Ma, Bae and Choi
    2012), and the deepest place nearby. Greedy set cover and exchange choose few of them that contain every
    piece of the surface; what they leave inside is covered likewise; each sphere is shrunk to what it alone
    contains. A second program then proves the cover: it divides the surface into triangles and the inside
    into cells until each lies whole in one sphere. The same mesh gives the same spheres on every instruction
    set.

    inside: False covers the surface of a solid alone. A mesh with solid=False has no inside: the spheres lie
    along its surface, and many more are needed. time_limit [s]. cache: covers are kept in files, by a hash of
    the mesh and the options, in the folder $CSPACE_CACHE, else in that of the system for caches; an empty
    $CSPACE_CACHE switches this off for all calls.

    Raises InputError for `within` that is not positive or so small that the pieces exceed the memory that is
    allowed, InputTypeError for other shapes (cover_shape takes them), TimeLimitError after `time_limit`.
    """
    began = time.perf_counter()
    most = positive_number(within, "within", "it must be one positive number [m]", largest=LARGEST_NUMBER)
    limit = check_time_limit(time_limit)
    vertices, faces, solid = find_surface(mesh)
    whole = bool(solid and check_flag(inside, "inside"))
    key = find_key(vertices, faces, solid, most, whole) if check_flag(cache, "cache") else ""
    kept = load_cover(key) if key else None
    if kept is None:
        outcome, spheres, stick_out, uncovered, parts = _core.find_cover(
            vertices, faces, solid, most, whole, limit
        )
        refuse_outcome(outcome, "within", most, time_limit)
        if uncovered > 0.0 or stick_out > most:
            raise InputError(f"within is {most:g} m; no cover could be proved, use a larger one")
        if key:
            store_cover(key, spheres, stick_out, parts)
    else:
        spheres, stick_out, parts = kept
    centers, radii = transform_points(mesh.pose, spheres[:, :3]), spheres[:, 3].copy()
    for array in (centers, radii):
        array.setflags(write=False)
    return SphereCover(centers, radii, stick_out, 0.0, whole, parts, time.perf_counter() - began)


def measure_cover(
    mesh: Shape,
    centers: ArrayLike,
    radii: ArrayLike,
    inside: bool = True,
    *,
    tolerance: float | None = None,
    time_limit: float | None = None,
) -> CoverMeasure:
    """How far given spheres stick out of a mesh, a hull or a height field, and how much of it they leave out.

    centers (n, 3) [m] in the frame where the mesh is placed; radii (n,) [m]. inside: False measures the
    surface of a solid alone. tolerance [m]: how far the bounds of a length may be apart, by default 1/2000 of
    the diagonal of the bounding box; those of the share are 0.01 apart. Bounds are valid but farther apart
    where that would take too many parts. time_limit [s].

    Raises InputError for no spheres, radii that are negative, NaN and arrays that do not match,
    InputTypeError for other shapes, TimeLimitError after `time_limit`.
    """
    limit = check_time_limit(time_limit)
    vertices, faces, solid = find_surface(mesh)
    given = one_array(centers, "centers", (None, 3), "x, y, z [m]", largest=LARGEST_NUMBER)
    if not len(given):
        raise InputError("centers holds no sphere; give at least one")
    sizes = one_array(radii, "radii", (len(given),), "one per centre [m]", largest=LARGEST_NUMBER)
    if (sizes < 0.0).any():
        raise InputError(f"radii[{int(sizes.argmin())}] is {sizes.min():g} m; none may be negative")
    apart = float(np.linalg.norm(np.ptp(vertices, axis=0))) * MEASURE_TOLERANCE
    if tolerance is not None:
        apart = positive_number(tolerance, "tolerance", "it must be one positive number [m]")
    spheres = np.column_stack([transform_points(inverse_pose(mesh.pose), given), sizes])
    outcome, *bounds = _core.measure_cover(
        vertices, faces, solid, spheres, check_flag(inside, "inside"), apart, limit
    )
    refuse_outcome(outcome, "tolerance", apart, time_limit)
    return CoverMeasure(*(Bounds(*pair) for pair in bounds))


def find_surface(mesh: Any) -> tuple[Array, np.ndarray, bool]:
    """Vertices (k, 3), faces (m, 3) and whether they enclose a solid; InputTypeError for other shapes."""
    surface = mesh._surface() if isinstance(mesh, Shape) else None
    if surface is None:
        raise InputTypeError(
            f"mesh is {name_type(mesh)}; give a Mesh, a Hull or a HeightField (or use cover_shape)"
        )
    vertices, faces, solid = surface
    return np.ascontiguousarray(vertices), np.ascontiguousarray(faces, dtype=np.int32), solid


def check_flag(value: Any, subject: str) -> bool:
    """True or False; InputTypeError for anything else."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputTypeError(f"{subject} is {name_type(value)}; it must be True or False")
    return bool(value)


def check_time_limit(value: float | None) -> float:
    """A time limit [s], infinite for None."""
    if value is None:
        return math.inf
    return positive_number(value, "time_limit", "it must be one positive number [s]")


def refuse_outcome(outcome: str, subject: str, value: float, time_limit: float | None) -> None:
    """The error of a search that did not end."""
    if outcome == "out_of_time":
        raise TimeLimitError(
            f"the cover took longer than time_limit, {time_limit:g} s; use a larger {subject}"
        )
    if outcome == "too_fine":
        raise InputError(f"{subject} is {value:g} m; the cover needs too many pieces, use a larger one")


def show_bounds(bounds: Bounds) -> str:
    """One number where the bounds look alike, else both."""
    low, high = (f"{value:.3g}" for value in bounds)
    return low if low == high else f"{low} to {high}"
