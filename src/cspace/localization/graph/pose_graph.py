"""PoseGraph: what people do with a pose graph."""

from __future__ import annotations

import os
from dataclasses import dataclass
from math import inf

import numpy.typing as npt

from cspace.localization.graph.answer import GraphAnswer
from cspace.localization.graph.files import read_graph
from cspace.localization.graph.g2o_writer import write_g2o
from cspace.localization.graph.graph_arrays import GraphArrays
from cspace.localization.graph.optimizer import Request, optimize_graph
from cspace.tables import tabulate


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class PoseGraph(GraphArrays):
    """A pose graph in the plane or in space; its arrays cannot be changed.

    poses: the start, rows x, y, θ (n, 3) [m, rad], or matrices (n, 4, 4). edges (k, 2): rows i, j of the
    poses between which the relative pose Xᵢ⁻¹Xⱼ was measured. motions (k, 3) or (k, 4, 4): that relative
    pose. information (k, 3, 3) or (k, 6, 6): the inverse covariance of its error, a twist [v; ω] in the
    frame of pose j; one matrix serves all.

    landmarks (m, 2) or (m, 3): the start of the landmarks. sightings (s, 2): rows of the pose and of the
    landmark that it saw. points (s, 2) or (s, 3): the landmark in the frame of the pose [m], or in the
    plane range [m] and bearing [rad] where `ranged` (s,) is true, NaN for one that was not measured.
    point_information (s, 2, 2) or (s, 3, 3): the inverse covariance.

    fixed, fixed_landmarks: rows that stay where they are; the first pose by default. ids (n,), landmark_ids
    (m,): the names of a file. start_given: whether the poses are more than placeholders. notes: what a
    reader left out. Raises InputError for arrays that do not fit together, edges from a pose to itself, and
    information that is not positive definite.
    """

    def optimize(
        self,
        *,
        start: str | None = None,
        method: str = "gauss_newton",
        residual: str = "twist",
        robust: str | None = None,
        kernel: str | None = None,
        width: float | None = None,
        trusted: npt.ArrayLike | None = None,
        max_iterations: int = 100,
        time_limit: float = inf,
    ) -> GraphAnswer:
        """The poses and landmarks of least χ² = Σ eᵀWe, with e = log(Z⁻¹ Xᵢ⁻¹ Xⱼ) for relative poses.

        start: "rotations" solves linear problems for the rotations and then the positions (Carlone et al.
        2015); "odometry" composes the trusted edges; "given" begins at the poses of the graph. By default
        "rotations", and "odometry" with robust=. method: "gauss_newton" with safeguards,
        "levenberg_marquardt" or "dog_leg". residual: "twist", or "g2o" for χ² as g2o counts it. robust:
        finds and rejects false measurements, by "dcs" (Agarwal et al. 2013), "gnc" (Yang et al. 2020), or
        "best" of both. kernel: weighs instead of rejecting: "huber", "cauchy", "geman_mcclure", "tukey" or
        "dcs"; width: its scale [standard deviations]. trusted (k,): edges that are never doubted; by
        default those between neighbouring rows. time_limit [s].

        The answer keeps the best state found. Raises InputError for a part of the graph with nothing fixed.
        """
        request = Request(start, method, residual, robust, kernel, width, trusted, max_iterations, time_limit)
        return optimize_graph(self, request)

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, format: str | None = None) -> PoseGraph:
        """The graph of a file: g2o, TORO, .graph or Victoria Park, told apart by content; gzip and zip too.

        format: "g2o", "toro", "graph" or "victoria", to insist on one. Raises LogError with file and line.
        """
        return read_graph(cls, path, format)

    @classmethod
    def from_g2o(cls, path: str | os.PathLike[str]) -> PoseGraph:
        """The graph of a g2o file (Kümmerle et al. 2011); errors as of read."""
        return cls.read(path, format="g2o")

    def to_g2o(self, path: str | os.PathLike[str]) -> None:
        """Write the graph as a g2o file, complete or not at all; InputError for what g2o cannot say."""
        write_g2o(self, path)
