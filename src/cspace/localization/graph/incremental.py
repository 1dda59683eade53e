"""IncrementalGraph: a pose graph that grows while its robot drives."""

from __future__ import annotations

from math import inf
from threading import Lock
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace._core import IncrementalSolver, are_clearly_positive
from cspace.arrays import Array, any_array, as_floats, positive_number
from cspace.errors import InputError, InputTypeError, check_known
from cspace.localization.checks import Running
from cspace.localization.graph.answer import GraphAnswer, turn_to_map
from cspace.localization.graph.checks import Ids, check_points, read_information, read_poses
from cspace.localization.graph.pose_graph import PoseGraph
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import LARGEST_IN_GRAPH

SHOWN_WAITING = 5
"""The most ids that a message lists."""


@tabulate("ids", "landmark_ids", "waiting", "stats")
class IncrementalGraph(Running):
    """A pose graph in the plane or in space to which measurements are added one after the other.

    Each addition brings the estimate up to date: only the part of the factor that it touches is eliminated
    again (Kaess et al. 2012). The first pose named stays where it is; pose: where, the identity by default;
    fixed: its id, to choose another. Measurements of poses that nothing connects with it wait until
    something does. Poses and landmarks are named by whole numbers.

    relinearize: measurements are linearised anew where a pose has moved by more than this [m or rad] since.
    substitute: changes up to this [m or rad] are not passed on to distant poses.
    """

    _instead = "keep to_graph(), or the measurements"

    def __init__(
        self,
        pose: npt.ArrayLike | None = None,
        *,
        fixed: int | None = None,
        relinearize: float = 0.1,
        substitute: float = 1e-3,
    ) -> None:
        self._relinearize = positive_number(relinearize, "relinearize")
        self._substitute = positive_number(substitute, "substitute")
        self._fixed = None if fixed is None else int(read_ids(fixed, "fixed")[0])
        self._solver: IncrementalSolver | None = None
        self._lock = Lock()
        self._edges = self._sightings = self._calls = 0
        self._pose: Array | None = None
        if pose is not None:
            self._pose = read_poses(as_floats(pose, "pose")[None], "pose")
            if self._fixed is not None:
                self._begin(self._pose.ndim == 3, self._fixed)

    def add(self, i: Any, j: Any, z: npt.ArrayLike, information: npt.ArrayLike) -> None:
        """Add the relative pose z of pose j in pose i, with the inverse covariance of its error.

        z: x, y, θ (3,) or a matrix (4, 4); information (3, 3) or (6, 6), of a twist [v; ω] in the frame of
        pose j. Several at once: i, j (k,), z (k, 3) or (k, 4, 4), information (k, ...) or one for all; they
        are taken up in one step. Raises InputError for values that PoseGraph would not take, with nothing
        added.
        """
        first, second = read_ids(i, "i"), read_ids(j, "j")
        if first.shape != second.shape:
            raise InputError(f"i has {len(first)} ids and j {len(second)}; give as many of each")
        if (first == second).any():
            raise InputError(f"the edge joins pose {first[first == second][0]} to itself; leave it out")
        motions = as_floats(z, "z", largest=LARGEST_IN_GRAPH)
        is_spatial = motions.shape[-2:] == (4, 4)
        if not motions.ndim or not motions.size:
            raise InputError(f"z has shape {motions.shape}, expected (3,), (k, 3) or (4, 4), (k, 4, 4)")
        motions = motions.reshape(-1, 4, 4) if is_spatial else motions.reshape(-1, motions.shape[-1])
        if is_spatial or motions.shape[1:] != (3,):
            motions = read_poses(motions, "z")
        if len(motions) != len(first):
            raise InputError(f"z has {len(motions)} relative poses for {len(first)} pairs of ids")
        matrices = read_matrices(information, len(first), 6 if is_spatial else 3)
        with self._lock:
            solver = self._begin(is_spatial, int(first[0]) if len(first) else 0)
            solver.add_edges(np.stack([first, second], axis=1), np.ascontiguousarray(motions), matrices)
            self._edges += len(first)
            self._step(solver)

    def add_sighting(
        self,
        pose: Any,
        landmark: Any,
        point: npt.ArrayLike,
        information: npt.ArrayLike,
        *,
        ranged: Any = False,
    ) -> None:
        """Add that a pose saw a landmark at a point of its frame, (2,) or (3,) [m].

        ranged: in the plane, the point is range [m] and bearing [rad], NaN for one that was not measured.
        information (2, 2) or (3, 3): the inverse covariance. Several at once as in add. A landmark begins
        where its first complete sighting, or two bearings that cross, have it; until then its sightings
        wait. Raises InputError as PoseGraph does.
        """
        first, second = read_ids(pose, "pose"), read_ids(landmark, "landmark")
        if first.shape != second.shape:
            raise InputError(f"pose has {len(first)} ids and landmark {len(second)}; give as many of each")
        points = np.atleast_2d(as_floats(point, "point", finite=False))
        d = points.shape[-1]
        if points.shape != (len(first), d) or d not in (2, 3):
            raise InputError(
                f"point has shape {points.shape}, expected ({len(first)}, 2) or ({len(first)}, 3)"
            )
        is_ranged = read_mask(ranged, "ranged", len(first))
        check_points(points, is_ranged, "point")
        measured = ~np.isnan(points)
        matrices = read_matrices(information, len(first), d)
        with self._lock:
            solver = self._begin(d == 3, int(first[0]) if len(first) else 0)
            solver.add_sightings(
                np.stack([first, second], axis=1),
                np.where(measured, points, 0.0),
                np.where(measured[:, :, None] & measured[:, None, :], matrices, 0.0),
                np.ascontiguousarray(is_ranged, np.uint8),
            )
            self._sightings += len(first)
            self._step(solver)

    @property
    def is_spatial(self) -> bool:
        """Whether the poses are those of space; false while there are none."""
        return self._solver is not None and self._solver.is_spatial

    @property
    def ids(self) -> Ids:
        """The names of the poses, sorted, (n,)."""
        return np.sort(self._names("pose_ids"))

    @property
    def landmark_ids(self) -> Ids:
        """The names of the landmarks, sorted, (m,)."""
        return np.sort(self._names("landmark_ids"))

    @property
    def poses(self) -> Array:
        """The estimate in the order of `ids`: rows x, y, θ (n, 3), or matrices (n, 4, 4)."""
        return self._read_state()[0]

    @property
    def landmarks(self) -> Array:
        """The landmarks in the order of `landmark_ids`, (m, 2) or (m, 3)."""
        return self._read_state()[1]

    def pose(self, id: int) -> Array:
        """The estimate of one pose, x, y, θ (3,) or a matrix (4, 4)."""
        with self._lock:
            solver, row = self._find("pose", id)
            found = np.empty((4, 4) if solver.is_spatial else 3)
            solver.write_pose(row, found)
        return found

    @property
    def chi2(self) -> float:
        """Σ eᵀWe of the estimate, over the measurements that do not wait."""
        if self._solver is None:
            return 0.0
        with self._lock:
            return self._solver.cost()

    @property
    def waiting(self) -> int:
        """How many measurements wait for a connection with the fixed pose, or for a landmark's place."""
        return 0 if self._solver is None else self._solver.waiting

    @property
    def stats(self) -> dict[str, int]:
        """steps: additions so far; eliminated: variables that they eliminated, counted each time."""
        return {"steps": self._calls, "eliminated": 0 if self._solver is None else self._solver.eliminated}

    def covariance(self, pose: int, other: int | None = None, *, frame: str = "base") -> Array:
        """The covariance of a pose, or of two poses between each other, by their ids: (3, 3) or (6, 6).

        frame as in GraphAnswer.covariance. It is taken where the measurements were linearised, at most
        `relinearize` from the estimate. Raises InputError for ids that are unknown.
        """
        check_known("frame", frame, ("base", "map"))
        names = [pose, pose if other is None else other]
        found = self._read_covariance("pose", names, 6 if self.is_spatial else 3)
        if frame == "base":
            return found
        first, second = (turn_to_map(self.pose(name)) for name in names)
        turned: Array = first @ found @ second.T
        return turned

    def landmark_covariance(self, landmark: int, other: int | None = None) -> Array:
        """The covariance of a landmark, or of two between each other, by their ids: (2, 2) or (3, 3) [m²]."""
        names = [landmark, landmark if other is None else other]
        return self._read_covariance("landmark", names, 3 if self.is_spatial else 2)

    def to_graph(self) -> PoseGraph:
        """The graph of all measurements that do not wait, with the estimate as its start."""
        with self._lock:
            if self._solver is None:
                raise InputError("the graph is empty; add a measurement first")
            lists = self._solver.arrays()
        edges, motions, information, sightings, points, point_information, has_bearing = map(np.array, lists)
        shape, size, d = ((4, 4), 6, 3) if self.is_spatial else ((3,), 3, 2)
        rows, landmark_rows = (
            np.argsort(np.argsort(self._names(kind))) for kind in ("pose_ids", "landmark_ids")
        )
        seen = np.asarray(sightings, int).reshape(-1, 2)
        point_information = point_information.reshape(-1, d, d)
        missing = point_information[:, range(d), range(d)] == 0
        return PoseGraph(
            poses=self.poses,
            edges=rows[np.asarray(edges, int).reshape(-1, 2)],
            motions=motions.reshape(-1, *shape),
            information=information.reshape(-1, size, size),
            landmarks=self.landmarks,
            sightings=np.stack([rows[seen[:, 0]], landmark_rows[seen[:, 1]]], axis=1),
            points=np.where(missing, np.nan, points.reshape(-1, d)),
            point_information=point_information + missing[:, :, None] * np.eye(d),
            ranged=has_bearing.astype(bool),
            fixed=rows[:1],
            ids=self.ids,
            landmark_ids=self.landmark_ids,
        )

    def optimize(self, *, method: str = "gauss_newton", time_limit: float = inf) -> GraphAnswer:
        """Optimize everything from the estimate, as PoseGraph.optimize does, and go on from the answer."""
        answer = self.to_graph().optimize(start="given", method=method, time_limit=time_limit)
        with self._lock:
            solver = self._solver
            assert solver is not None  # to_graph raises for an empty graph
            rows, landmark_rows = (
                np.argsort(np.argsort(self._names(kind))) for kind in ("pose_ids", "landmark_ids")
            )
            solver.restart(
                np.ascontiguousarray(answer.poses[rows]),
                np.ascontiguousarray(answer.landmarks[landmark_rows]),
            )
        return answer

    def _begin(self, is_spatial: bool, first: int) -> IncrementalSolver:
        """The solver, made for the first measurement, whose first pose is held unless another was chosen."""
        if self._solver is not None:
            if self._solver.is_spatial != is_spatial:
                kinds = ("the plane", "space")
                raise InputError(
                    f"the measurement is of {kinds[is_spatial]} and the graph of {kinds[not is_spatial]};"
                    " keep to one"
                )
            return self._solver
        at = self._pose
        if at is None:
            at = np.eye(4) if is_spatial else np.zeros(3)
        elif (at.ndim == 3) != is_spatial:
            kind = "space" if is_spatial else "the plane"
            raise InputError(f"pose has shape {at.shape} and the measurement is of {kind}")
        solver = IncrementalSolver(is_spatial, self._relinearize, self._substitute)
        solver.hold_pose(first if self._fixed is None else self._fixed, np.ascontiguousarray(at))
        self._solver = solver
        return solver

    def _step(self, solver: IncrementalSolver) -> None:
        self._calls += 1
        if not solver.step():
            raise_singular()

    def _names(self, kind: str) -> Ids:
        return np.array([] if self._solver is None else getattr(self._solver, kind), dtype=np.int64)

    def _read_state(self) -> tuple[Array, Array]:
        with self._lock:
            names, landmark_names = self._names("pose_ids"), self._names("landmark_ids")
            d = 3 if self.is_spatial else 2
            poses = np.empty((len(names), 4, 4) if self.is_spatial else (len(names), 3))
            landmarks = np.empty((len(landmark_names), d))
            if self._solver is not None:
                self._solver.write_state(poses, landmarks)
        return poses[np.argsort(names)], landmarks[np.argsort(landmark_names)]

    def _find(self, kind: str, id: Any) -> tuple[IncrementalSolver, int]:
        name = int(read_ids(id, kind)[0])
        row = -1
        if self._solver is not None:
            row = self._solver.find_pose(name) if kind == "pose" else self._solver.find_landmark(name)
        if self._solver is None or row < 0:
            raise InputError(
                f"the graph has no {kind} {name}, or nothing connects it with the fixed pose yet"
            )
        return self._solver, row

    def _read_covariance(self, kind: str, names: list[Any], size: int) -> Array:
        found = np.empty((size, size))
        with self._lock:
            (solver, first), (_, second) = (self._find(kind, name) for name in names)
            if not solver.write_covariance(kind == "pose", first, second, found):
                raise_singular()
        return found

    def __repr__(self) -> str:
        if self._solver is None:
            return one_line("IncrementalGraph", "empty")
        names, landmarks = self._names("pose_ids"), self._names("landmark_ids")
        text = f"{count_things(len(names), 'pose')}, {count_things(self._edges, 'edge')}"
        if self._sightings:
            text += f", {count_things(len(landmarks), 'landmark')}"
            text += f", {count_things(self._sightings, 'sighting')}"
        text += " in space" if self.is_spatial else " in the plane"
        return one_line("IncrementalGraph", text + (f", {self.waiting} waiting" if self.waiting else ""))


def raise_singular() -> None:
    raise InputError(
        "the normal equations are singular, so that the estimate is that before this measurement; the"
        " information of some measurements is too small beside that of others"
    )


def read_ids(value: Any, subject: str) -> Ids:
    """One whole number or several, (k,)."""
    if type(value) is int and -(2**63) <= value < 2**63:
        return np.array([value], dtype=np.int64)
    array = np.atleast_1d(any_array(value, subject))
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise InputTypeError(f"{subject} is {value!r:.60}; give a whole number, or a list of them")
    return array.astype(np.int64)


def read_mask(value: Any, subject: str, count: int) -> npt.NDArray[np.bool_]:
    """Truth values (count,), or one for all."""
    mask = any_array(value, subject)
    if mask.dtype != np.bool_ or mask.shape not in ((), (1,), (count,)):
        raise InputError(f"{subject} is {mask.dtype} of shape {mask.shape}; give one truth value, or {count}")
    return np.broadcast_to(mask, (count,))


def read_matrices(value: Any, count: int, size: int) -> Array:
    """Information matrices, one per measurement, that are positive definite."""
    array = as_floats(value, "information", largest=LARGEST_IN_GRAPH)
    if array.shape == (size, size) and count != 1:
        array = np.broadcast_to(array, (count, size, size))
    elif array.shape == (size, size):
        array = array[None]
    if array.shape == (count, size, size):
        array = np.ascontiguousarray(array)
        if are_clearly_positive(array, size):
            return array
    return read_information(array, "information", count, size)
