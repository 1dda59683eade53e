"""GraphAnswer: the optimized poses and landmarks, their covariances, and what was rejected."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from threading import Lock
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, whole_number
from cspace.errors import InputError, Renamed, check_known
from cspace.tables import one_line, show_fields, shown, tabulate
from cspace.tolerances import SAME_CHI2

if TYPE_CHECKING:
    from cspace._core import GraphSolver
    from cspace.localization.graph.graph_arrays import GraphArrays

LIMITS: Final = {1: 10.828, 2: 13.816, 3: 16.266, 6: 22.458}
"""Squared errors that a true measurement of so many numbers exceeds once in a thousand times."""


@show_fields
class RejectedLoop(NamedTuple):
    """An edge that robust= left out."""

    edge: int
    """Its row."""
    first: int
    """The id of the pose it leaves."""
    second: int
    """The id of the pose it reaches."""
    chi2: float
    """Its squared error at the answer."""
    limit: float
    """The squared error up to which it would have counted."""


@show_fields
class Certificate(NamedTuple):
    """What the dual of a pose graph says about an answer; truthy if it is the global optimum."""

    certified: bool
    """Whether the answer is the optimum next to the proved one of the chordal problem."""
    bound: float
    """No state has a smaller χ²; 0 where nothing was proved."""
    gap: float
    """χ² of the answer minus the bound."""
    reason: str
    """The verdict in words."""

    def __bool__(self) -> bool:
        return self.certified


def list_rejected(
    graph: GraphArrays, squares: Array, is_rejected: npt.NDArray[np.bool_], scale: float
) -> tuple[RejectedLoop, ...]:
    """The rejected edges by row; scale: of the limits."""
    limit = scale * LIMITS[6 if graph.is_spatial else 3]
    ids = graph.ids[graph.edges]
    return tuple(
        RejectedLoop(int(k), int(ids[k, 0]), int(ids[k, 1]), float(squares[k]), limit)
        for k in np.flatnonzero(is_rejected)
    )


def turn_to_map(pose: Array) -> Array:
    """The matrix that turns disturbances of a pose into the axes of the map; angles of the plane stay."""
    if pose.ndim == 2:
        return np.asarray(np.kron(np.eye(2), pose[:3, :3]), dtype=np.float64)
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class GraphAnswer(Renamed):
    """An optimized pose graph; truthy if it converged.

    poses (n, 3) or (n, 4, 4), landmarks (m, 2) or (m, 3): the state of least cost. chi2: Σ eᵀWe over the
    measurements that count; dof: measured numbers minus unknown ones, so that chi2 / dof is near 1 for
    honest information. status: "converged", "stopped", "singular" or "time_limit"; reason: the same in
    words. edge_chi2 (k,), sighting_chi2 (s,): eᵀWe of each measurement. rejected: the edges that robust=
    left out, each with its ids and χ²; rejected_sightings: rows of sightings. stats: iterations,
    factorizations, costs, seconds.
    """

    poses: Array
    landmarks: Array
    chi2: float
    dof: int
    status: str
    reason: str
    edge_chi2: Array
    sighting_chi2: Array
    rejected: tuple[RejectedLoop, ...]
    rejected_sightings: npt.NDArray[np.intp]
    stats: Mapping[str, Any]
    graph: GraphArrays
    _held: list[GraphSolver]
    _remake: Callable[[GraphAnswer], GraphSolver]
    _lock: Lock = field(default_factory=Lock)

    def __bool__(self) -> bool:
        return self.status == "converged"

    @cached_property
    def marginals(self) -> Array:
        """The covariance of each pose, (n, 3, 3) or (n, 6, 6), of ξ in X exp ξ, [v; ω] in the frame of the
        pose.

        From the selected inverse of the normal equations (Takahashi et al. 1973); zero for fixed poses.
        Raises InputError where the equations are singular.
        """
        rows = np.arange(len(self.poses), dtype=np.int32)
        return self._read_covariances(rows, rows, self._size(0), self._size(0))

    @cached_property
    def landmark_marginals(self) -> Array:
        """The covariance of each landmark, (m, 2, 2) or (m, 3, 3) [m²]; zero for fixed ones."""
        rows = np.arange(len(self.landmarks), dtype=np.int32) + np.int32(len(self.poses))
        return self._read_covariances(rows, rows, self.graph.dimension, self.graph.dimension)

    def covariance(self, pose: int, other: int | None = None, *, frame: str = "base") -> Array:
        """The covariance of a pose, or of two poses between each other, by their rows: (3, 3) or (6, 6).

        frame: "base" for disturbances [v; ω] in the frames of the poses, "map" for the same in the axes of
        the map, the ellipse that people draw. Raises InputError for rows outside of the graph.
        """
        pair = [pose, pose if other is None else other]
        rows = [whole_number(row, "pose", 0, len(self.poses) - 1) for row in pair]
        check_known("frame", frame, ("base", "map"))
        a, b = (np.array([row], dtype=np.int32) for row in rows)
        found: Array = self._read_covariances(a, b, self._size(rows[0]), self._size(rows[1]))[0]
        if frame == "base":
            return found
        first, second = (turn_to_map(self.poses[row]) for row in rows)
        turned: Array = first @ found @ second.T
        return turned

    def certificate(self) -> Certificate:
        """Whether the answer is the global optimum, proved by the dual of the chordal problem, in which an
        angle θ counts as 2 sin(θ/2).

        The information of each measurement must be isotropic, one number for positions and one for angles;
        otherwise, and where the proof fails, the certificate is false and says why (Carlone et al. 2015,
        Rosen et al. 2019). One factorisation, and a few steps to the chordal optimum.
        """
        reason = self._explain_no_dual()
        if reason:
            return Certificate(False, 0.0, self.chi2, f"not certified: {reason}")
        with self._lock:
            is_proved, bound, least = self._solver().certify()
        if not is_proved:
            reason = "the dual matrix is not positive semidefinite, so that there may be a better optimum"
            return Certificate(False, 0.0, self.chi2, f"not certified: {reason}")
        is_found = abs(self.chi2 - least) <= SAME_CHI2 * max(least, 1.0)
        if not is_found:
            reason = f"not certified: the global optimum is next to a state of chi2 {least:.9g}"
        else:
            reason = f"no state has a chi2 below {bound:.9g}, that of the chordal optimum next to the answer"
        return Certificate(is_found, bound, self.chi2 - bound, reason)

    def to_graph(self) -> GraphArrays:
        """The graph with the answer as its start."""
        return self.graph.with_poses(self.poses, self.landmarks)

    def _solver(self) -> GraphSolver:
        """The compiled solver at the answer; that of a copy is made again."""
        if not self._held:
            self._held.append(self._remake(self))
        return self._held[0]

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle stores: the arrays, without the compiled solver."""
        given = [getattr(self, each.name) for each in fields(self) if each.init and each.name[0] != "_"]
        return type(self), (*given, [], self._remake)

    def _explain_no_dual(self) -> str:
        """Why the problem has no dual that we know; empty where it has one."""
        if self.stats["residual"] != "twist":
            return 'χ² is not that of twists; optimize with residual="twist"'
        if self.stats["kernel"] is not None:
            return "a robust kernel weighs the measurements; optimize without one"
        if len(self.graph.fixed) + len(self.graph.fixed_landmarks) != 1 or self.graph.parts.any():
            return "the graph must be in one part, with one pose fixed"
        with self._lock:
            row = self._solver().anisotropic_measurement
        edges = len(self.graph.edges)
        if row >= edges:
            return f"sighting {row - edges} has a range, a bearing, or information that is not isotropic"
        return f"the information of edge {row} is not isotropic" if row >= 0 else ""

    def _size(self, row: int) -> int:
        """The numbers of a variable, poses before landmarks."""
        if row >= len(self.poses):
            return self.graph.dimension
        return 6 if self.graph.is_spatial else 3

    def _read_covariances(
        self, first: npt.NDArray[np.int32], second: npt.NDArray[np.int32], rows: int, columns: int
    ) -> Array:
        found = np.empty((len(first), rows, columns))
        with self._lock:
            is_regular = self._solver().write_covariances(np.stack([first, second], axis=1), found)
        if not is_regular:
            raise InputError(
                "the normal equations at the answer are singular, so that there are no covariances;"
                " measure what"
                " is undetermined, or fix it"
            )
        return found

    def __repr__(self) -> str:
        text = f"{self.status}: chi2 {shown(self.chi2)}, dof {self.dof}"
        if self.rejected:
            text += f", {len(self.rejected)} edges rejected"
        return one_line("GraphAnswer", text if self else f"{text}; {self.reason}")
