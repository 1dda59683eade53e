"""Optimisation of a pose graph: the words of the call, the compiled solver, and the answer."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from time import perf_counter
from typing import Any, Final, NamedTuple

import numpy as np

from cspace._core import GraphSolver, TimeOver, set_deadline
from cspace.arrays import any_array, positive_number, whole_number
from cspace.errors import InputError, InputTypeError, check_known
from cspace.localization.graph.answer import GraphAnswer, list_rejected
from cspace.localization.graph.checks import Mask
from cspace.localization.graph.graph_arrays import GraphArrays
from cspace.tables import join_words
from cspace.tolerances import GRAPH_DECREASE, GRAPH_STEP

METHODS: Final = ("gauss_newton", "levenberg_marquardt", "dog_leg")
RESIDUALS: Final = ("twist", "g2o")
ROBUST: Final = (None, "dcs", "gnc", "best")
STARTS: Final = ("given", "odometry", "rotations")
KERNELS: Final = (None, "huber", "cauchy", "geman_mcclure", "tukey", "dcs")
WIDTHS: Final = {
    None: 1.0,
    "huber": 1.345,
    "cauchy": 2.3849,
    "geman_mcclure": 1.0,
    "tukey": 4.6851,
    "dcs": 1.0,
}
"""Widths of the kernels [standard deviations]: 95 % efficient on Gaussian errors (Zhang 1997); φ = 1 of
DCS.
"""
MOST_ITERATIONS: Final = 1_000_000
STATUSES: Final = ("converged", "stopped", "singular")
"""The answers of the core, by number."""
SHOWN_PARTS: Final = 5
"""The most parts of a graph that a message lists."""


RESTORING: Final = 1
"""Iterations from a state that is the optimum already, by which a solver gets its factor again."""


class Request(NamedTuple):
    """The arguments of PoseGraph.optimize."""

    start: str | None
    method: str
    residual: str
    robust: str | None
    kernel: str | None
    width: float | None
    trusted: Any
    max_iterations: int
    time_limit: float

    def check(self) -> Request:
        """With the defaults filled in; errors for words that are not in the lists."""
        for name, known in (
            ("method", METHODS),
            ("residual", RESIDUALS),
            ("robust", ROBUST),
            ("kernel", KERNELS),
        ):
            find_word(name, getattr(self, name), known)
        if self.robust is not None and self.kernel is not None:
            raise InputTypeError(
                "robust= and kernel= exclude each other: one rejects measurements, one weighs them"
            )
        usual = "rotations" if self.robust is None else "odometry"
        start = usual if self.start is None else self.start
        find_word("start", start, STARTS)
        return self._replace(
            start=start,
            width=WIDTHS[self.kernel] if self.width is None else positive_number(self.width, "width"),
            max_iterations=whole_number(self.max_iterations, "max_iterations", 1, MOST_ITERATIONS),
            time_limit=positive_number(
                self.time_limit, "time_limit", "it must be a positive number of seconds", largest=inf
            ),
        )


def refuse_idle(given: Request, start: str | None) -> None:
    """InputTypeError for arguments that have no effect beside the others. given: as it was given."""
    if given.width is not None and given.kernel is None and given.robust in (None, "gnc"):
        raise InputTypeError(
            f"width is {given.width!r:.40} and nothing has that width; give kernel=, or robust= with dcs"
        )
    if given.trusted is not None and given.robust is None and start != "odometry":
        raise InputTypeError(
            'trusted= names the edges that robust= never rejects, and that start="odometry" follows; give one'
            " of these, or leave it out"
        )


def find_word(name: str, word: Any, known: tuple[str | None, ...]) -> int:
    """The place of a word among those known; an error with the nearest ones for others."""
    if not (word is None and None in known):
        check_known(name, word, [each for each in known if each is not None])
    return known.index(word)


def optimize_graph(graph: GraphArrays, given: Request) -> GraphAnswer:
    """See PoseGraph.optimize."""
    request = given.check()
    check_parts(graph)
    if request.start == "given" and not graph.start_given:
        raise InputError(
            'start is "given", and the file of the graph has no poses; use "rotations" or "odometry",'
            " or with_poses"
        )
    is_trusted = read_trusted(graph, request.trusted)
    refuse_idle(given, request.start)
    solver = make_solver(graph, is_trusted)
    begin = perf_counter()
    status = run_solver(solver, request)
    return make_answer(graph, solver, request, status, perf_counter() - begin)


def check_parts(graph: GraphArrays) -> None:
    """InputError for a part of the graph that nothing holds in place, with one of its members."""
    anchored = set(graph.parts[graph.fixed].tolist())
    parts, first = np.unique(graph.parts, return_index=True)
    loose = [int(at) for part, at in zip(parts, first, strict=True) if part not in anchored]
    if not loose:
        return
    names = [name_variable(graph, at) for at in loose[:SHOWN_PARTS]]
    more = f" and {len(loose) - SHOWN_PARTS} more" if len(loose) > SHOWN_PARTS else ""
    raise InputError(
        f"the graph has {len(parts)} parts, and nothing is fixed in that of {join_words(names)}{more};"
        " fix a pose of"
        " each part (fixed=), or leave the part out"
    )


def name_variable(graph: GraphArrays, at: int) -> str:
    """A pose, or behind all poses a landmark, by its id."""
    n = len(graph.poses)
    return f"pose {graph.ids[at]}" if at < n else f"landmark {graph.landmark_ids[at - n]}"


def read_trusted(graph: GraphArrays, value: Any) -> Mask:
    """Which edges are never doubted."""
    if value is None:
        return graph.consecutive
    mask = any_array(value, "trusted")
    if mask.dtype != bool or mask.shape != (len(graph.edges),):
        raise InputError(
            f"trusted has shape {mask.shape} of {mask.dtype}, expected ({len(graph.edges)},) of bool:"
            " one per edge"
        )
    return mask


def make_solver(graph: GraphArrays, is_trusted: Mask) -> GraphSolver:
    """The compiled solver of a graph."""
    held = np.zeros(len(graph.poses), np.uint8)
    held[graph.fixed] = 1
    held_landmarks = np.zeros(len(graph.landmarks), np.uint8)
    held_landmarks[graph.fixed_landmarks] = 1
    both = graph.measured[:, :, None] & graph.measured[:, None, :]
    return GraphSolver(
        is_spatial=graph.is_spatial,
        poses=graph.poses,
        landmarks=graph.landmarks,
        edges=graph.edges,
        motions=graph.motions,
        information=graph.information,
        sightings=graph.sightings,
        points=np.where(graph.measured, graph.points, 0.0),
        point_information=np.where(both, graph.point_information, 0.0),
        has_bearing=np.asarray(graph.ranged, np.uint8),
        is_held=held,
        is_landmark_held=held_landmarks,
        is_trusted=np.asarray(is_trusted, np.uint8),
        is_sighting_trusted=np.zeros(len(graph.sightings), np.uint8),
    )


def run_solver(solver: GraphSolver, request: Request) -> str:
    """Optimizes within the time limit; the status in words."""
    outer, begin = set_deadline(request.time_limit), perf_counter()
    try:
        status = solver.optimize(
            METHODS.index(request.method),
            RESIDUALS.index(request.residual),
            STARTS.index(str(request.start)),
            ROBUST.index(request.robust),
            KERNELS.index(request.kernel),
            float(request.width or 1.0),
            request.max_iterations,
            GRAPH_STEP,
            GRAPH_DECREASE,
        )
        return STATUSES[status]
    except TimeOver:
        if perf_counter() - begin < request.time_limit:
            raise  # that of a caller
        return "time_limit"
    finally:
        set_deadline(outer - (perf_counter() - begin))


def make_answer(
    graph: GraphArrays, solver: GraphSolver, request: Request, status: str, seconds: float
) -> GraphAnswer:
    """The state of the solver as arrays, with χ² and what was rejected."""
    poses, landmarks = np.empty(graph.poses.shape), np.empty(graph.landmarks.shape)
    solver.write_state(poses, landmarks)
    squares, used = np.array(solver.squares), np.array(solver.used, dtype=bool)
    k = len(graph.edges)
    iterations, factorizations, analyses, costs = solver.stats
    stats = {
        "iterations": iterations,
        "factorizations": factorizations,
        "analyses": analyses,
        "costs": tuple(costs),
        "seconds": seconds,
        "start": request.start if solver.found_start else "given",
        "residual": request.residual,
        "kernel": request.kernel,
        "width": request.width,
    }
    rejected_numbers = int((~used[:k]).sum()) * (6 if graph.is_spatial else 3)
    rejected_numbers += int(graph.measured[~used[k:]].sum())
    return GraphAnswer(
        poses=poses,
        landmarks=landmarks,
        chi2=float(squares[used].sum()),
        dof=graph.dof - rejected_numbers,
        status=status,
        reason=explain_status(graph, solver, request, status, seconds, int(iterations)),
        edge_chi2=squares[:k],
        sighting_chi2=squares[k:],
        rejected=list_rejected(graph, squares[:k], ~used[:k], solver.limit_scale),
        rejected_sightings=np.flatnonzero(~used[k:]),
        stats=stats,
        graph=graph,
        _held=[solver],
        _remake=restore_solver,
    )


def restore_solver(answer: GraphAnswer) -> GraphSolver:
    """A solver at the state of an answer that was copied or pickled, with the measurements that it counts."""
    stats, graph = answer.stats, answer.graph
    is_used = np.ones(len(graph.edges), dtype=bool)
    is_used[[loop.edge for loop in answer.rejected]] = False
    is_seen = np.ones(len(graph.sightings), dtype=bool)
    is_seen[answer.rejected_sightings] = False
    kept = replace(
        graph.with_poses(answer.poses, answer.landmarks),
        edges=graph.edges[is_used],
        motions=graph.motions[is_used],
        information=graph.information[is_used],
        sightings=graph.sightings[is_seen],
        points=graph.points[is_seen],
        point_information=graph.point_information[is_seen],
        ranged=graph.ranged[is_seen],
    )
    request = Request(
        "given", METHODS[0], stats["residual"], None, stats["kernel"], stats["width"], None, RESTORING, inf
    ).check()
    solver = make_solver(kept, read_trusted(kept, None))
    run_solver(solver, request)
    return solver


def explain_status(
    graph: GraphArrays, solver: GraphSolver, request: Request, status: str, seconds: float, iterations: int
) -> str:
    """The verdict in words."""
    if status == "converged":
        return f"the step and the decrease that it predicts became small after {iterations} iterations"
    if status == "time_limit":
        return f"the time limit of {request.time_limit:g} s was over; the answer is the best state until then"
    if status == "singular":
        at = solver.singular_variable
        where = f" near {name_variable(graph, at)}" if at >= 0 else ""
        return f"the normal equations are singular{where}: the measurements do not determine it"
    if iterations >= request.max_iterations:
        return (
            f"max_iterations={request.max_iterations} iterations did not settle; the answer is the best state"
        )
    return f"no step lowered the cost any more after {iterations} iterations, though the steps were not small"
