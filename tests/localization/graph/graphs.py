"""Random pose graphs, and χ² and its normal equations in plain numpy, by definition and by differences."""

from __future__ import annotations

from typing import Any

import numpy as np

import cspace as cs


def move(X: Any, xi: np.ndarray) -> np.ndarray:
    """X exp ξ, for a matrix of the plane or of space."""
    return np.asarray(X @ (cs.exp_se2(xi) if len(X) == 3 else cs.exp_se3(xi)))


def log(X: np.ndarray) -> np.ndarray:
    return np.asarray(cs.log_se2(X) if len(X) == 3 else cs.log_se3(X))


def matrix(row: np.ndarray) -> np.ndarray:
    """The matrix of a pose as graphs have it."""
    return row if row.ndim == 2 else np.asarray(cs.pose_2d(xytheta=row))


def numbers(X: np.ndarray) -> np.ndarray:
    """A matrix as graphs have it."""
    return X if len(X) == 4 else np.asarray(cs.to_xytheta(X))


def random_information(rng: np.random.Generator, count: int, size: int) -> np.ndarray:
    roots = rng.normal(size=(count, size, size))
    return np.asarray(roots @ np.swapaxes(roots, 1, 2) + 0.5 * np.eye(size))


def random_graph(
    rng: np.random.Generator,
    poses: int = 12,
    *,
    spatial: bool = False,
    noise: float = 0.05,
    landmarks: int = 0,
) -> Any:
    """A chain with edges across, a start off the truth, and landmarks seen from some poses."""
    size, d = (6, 3) if spatial else (3, 2)
    scale = np.r_[np.ones(d), 0.5 * np.ones(size - d)]
    truth = [np.eye(d + 1)]
    for _ in range(poses - 1):
        truth.append(move(truth[-1], scale * rng.uniform(-1, 1, size)))
    edges = [(k, k + 1) for k in range(poses - 1)]
    edges += [tuple(rng.choice(poses, 2, replace=False)) for _ in range(poses)]
    motions = [
        numbers(move(np.linalg.inv(truth[i]) @ truth[j], noise * rng.normal(size=size))) for i, j in edges
    ]
    points = rng.uniform(-3, 3, (landmarks, d))
    sightings = [(k, m) for m in range(landmarks) for k in rng.choice(poses, 4, replace=False)]
    seen = [
        truth[k][:d, :d].T @ (points[m] - truth[k][:d, d]) + noise * rng.normal(size=d) for k, m in sightings
    ]
    return cs.PoseGraph(
        poses=np.array([numbers(move(X, noise * rng.normal(size=size))) for X in truth]),
        edges=np.array(edges),
        motions=np.array(motions),
        information=random_information(rng, len(edges), size),
        landmarks=points + noise * rng.normal(size=points.shape),
        sightings=np.array(sightings, int).reshape(-1, 2),
        points=np.array(seen).reshape(-1, d),
        point_information=random_information(rng, len(sightings), d),
    )


def residuals(graph: Any, poses: list[np.ndarray], landmarks: np.ndarray) -> np.ndarray:
    """All errors, times roots of their information, in one vector."""
    d, found = graph.dimension, []
    for (i, j), z, W in zip(graph.edges, graph.motions, graph.information, strict=True):
        e = log(np.linalg.inv(matrix(z)) @ np.linalg.inv(poses[i]) @ poses[j])
        found.append(np.linalg.cholesky(W).T @ e)
    for (i, m), z, W, ranged in zip(
        graph.sightings, graph.points, graph.point_information, graph.ranged, strict=True
    ):
        h = poses[i][:d, :d].T @ (landmarks[m] - poses[i][:d, d])
        if ranged:
            e = np.array([np.hypot(*h), np.arctan2(h[1], h[0])]) - z
            e[1] = np.angle(np.exp(1j * e[1]))
            known = ~np.isnan(z)
            found.append(np.linalg.cholesky(W[np.ix_(known, known)]).T @ e[known])
        else:
            found.append(np.linalg.cholesky(W).T @ (h - z))
    return np.concatenate(found)


def chi2(graph: Any, poses: np.ndarray, landmarks: np.ndarray) -> float:
    return float((residuals(graph, [matrix(row) for row in poses], landmarks) ** 2).sum())


def jacobian(graph: Any, poses: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    """The derivative of the residuals by central differences: disturbances of all poses, then landmarks."""
    matrices, h, columns = [matrix(row) for row in poses], 1e-6, []
    size = 6 if graph.is_spatial else 3
    for k in range(len(matrices)):
        for axis in range(size):
            sides = []
            for step in (h, -h):
                moved = list(matrices)
                moved[k] = move(moved[k], step * np.eye(size)[axis])
                sides.append(residuals(graph, moved, landmarks))
            columns.append((sides[0] - sides[1]) / (2 * h))
    for m in range(len(landmarks)):
        for axis in range(graph.dimension):
            sides = []
            for step in (h, -h):
                moved_points = landmarks.copy()
                moved_points[m, axis] += step
                sides.append(residuals(graph, matrices, moved_points))
            columns.append((sides[0] - sides[1]) / (2 * h))
    return np.stack(columns, axis=1)
