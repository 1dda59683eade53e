"""Draws the figures of the pages on odometry and localisation: `python docs/figures/localization.py`."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse

import cspace as cs
from cspace.localization import Landmarks, RangeBearing, simulate
from cspace.mobile import Odometry, OdometryNoise, RandomWalk, VelocityNoise

HERE = Path(__file__).parent
DPI = 80
INK, FAINT, BLUE, RED, GREEN = "#222222", "#bbbbbb", "#1f6fb2", "#c8442f", "#3a8f4d"


def draw_noise() -> None:
    """Clouds of 400 robots after the same drive, by each model."""
    n, count = 40, 400
    twist = np.array([1.0, 0.0, 0.25])
    steps = np.tile(twist * 0.1, (n, 1))
    models = {"RandomWalk": RandomWalk(), "VelocityNoise": VelocityNoise(), "OdometryNoise": OdometryNoise()}
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2), sharex=True, sharey=True)
    for ax, (name, model) in zip(axes, models.items(), strict=True):
        drawn = model.sample(np.tile(steps[:, None], (1, count, 1)), 0.1, rng=1)
        T = np.tile(np.eye(3), (count, 1, 1))
        for k, xi in enumerate(drawn):
            T = T @ cs.exp_se2(xi)
            if k % 13 == 12:
                ax.plot(T[:, 0, 2], T[:, 1, 2], ".", ms=2, color=BLUE, alpha=0.5)
        path = Odometry(np.arange(n + 1) * 0.1, steps).dead_reckoning().poses
        ax.plot(path[:, 0], path[:, 1], color=INK, lw=1.2)
        ax.set_title(name, fontsize=10, color=INK)
        ax.set_aspect("equal")
        ax.spines[["top", "right"]].set_visible(False)
        ax.set_xlabel("x [m]")
    axes[0].set_ylabel("y [m]")
    figure.tight_layout()
    figure.savefig(HERE / "motion_noise.png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def add_ellipse(ax, pose, P, color) -> None:
    """The 95 % ellipse of a position, of a covariance in axes of the map."""
    values, vectors = np.linalg.eigh(P[:2, :2])
    width, height = 2 * np.sqrt(5.991 * values[::-1])
    angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1]))
    ax.add_patch(Ellipse(pose[:2], width, height, angle=angle, fill=False, ec=color, lw=1))


def draw_filter() -> None:
    """Odometry, filter and smoother of a drive past four landmarks, with ellipses of 95 %."""
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1)], vehicle=cs.Unicycle())
    landmarks = Landmarks(range(4), [(1.5, -1.0), (10.5, 1.0), (8.0, 7.5), (-1.5, 6.0)])
    sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=3.0)
    noise = RandomWalk(distance=4e-3, turn=2e-2, drift=1.5e-2)
    log = simulate(run, landmarks, sensor=sensor, noise=noise, rng=3)
    found = cs.localize(log, landmarks, sensor=sensor, noise=noise)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharex=True, sharey=True)
    for ax, (name, answer) in zip(axes, {"filter": found, "smoother": found.smoothed()}.items(), strict=True):
        ax.plot(*log.truth.poses[:, :2].T, color=INK, lw=2.5, alpha=0.35, label="truth")
        reckoned = log.odometry.dead_reckoning(log.truth.poses[0]).poses
        ax.plot(*reckoned[:, :2].T, color=RED, lw=1, label="odometry")
        ax.plot(*answer.poses[:, :2].T, color=BLUE, lw=1.2, label=name)
        P = answer.covariance(frame="map")
        for k in range(0, len(answer), 35):
            add_ellipse(ax, answer.poses[k], P[k], BLUE)
        ax.plot(*landmarks.points.T, "^", color=GREEN, ms=8, label="landmarks")
        ax.set_aspect("equal")
        ax.spines[["top", "right"]].set_visible(False)
        ax.set_xlabel("x [m]")
        ax.legend(fontsize=8, frameon=False, loc="center")
    axes[0].set_ylabel("y [m]")
    figure.tight_layout()
    figure.savefig(HERE / "localization.png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def draw_landmarks() -> None:
    """Odometry and EKF-SLAM of a drive without a map, with ellipses of poses and landmarks of 95 %."""
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1)], vehicle=cs.Unicycle())
    points = [(3, -1.5), (6, -1.5), (10.5, 1), (10.5, 5), (7, 7.5), (3, 7.5), (-1.5, 5), (-1.5, 1), (4.5, 3)]
    sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=4.0)
    log = simulate(run, Landmarks(range(9), points), sensor=sensor, rng=3)
    start = log.truth.poses[0]
    found = cs.localization.run_ekf_slam(log, sensor=sensor, start=start)
    figure, ax = plt.subplots(figsize=(6.4, 4.8))
    ax.plot(*log.truth.poses[:, :2].T, color=INK, lw=2.5, alpha=0.35, label="truth")
    ax.plot(*log.odometry.dead_reckoning(start).poses[:, :2].T, color=RED, lw=1, label="odometry")
    ax.plot(*found.poses[:, :2].T, color=BLUE, lw=1.2, label="EKF-SLAM")
    P = found.covariance(frame="map")
    for k in range(0, len(found), 35):
        add_ellipse(ax, found.poses[k], P[k], BLUE)
    ax.plot(*np.transpose(points), "^", color=FAINT, ms=8, label="true landmarks")
    ax.plot(*found.landmarks.points.T, ".", color=GREEN, ms=5, label="landmarks found")
    for point, C in zip(found.landmarks.points, found.landmarks.covariances, strict=True):
        add_ellipse(ax, point, C, GREEN)
    ax.set_aspect("equal")
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.legend(fontsize=8, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.tight_layout()
    figure.savefig(HERE / "landmark_slam.png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def draw_run() -> None:
    """A localisation with its errors over time."""
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1)], vehicle=cs.Unicycle())
    landmarks = Landmarks(range(5), [(1.5, -1.0), (10.5, 1.0), (8.0, 7.5), (-1.5, 6.0), (4.5, 3.0)])
    sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=4.0)
    log = simulate(run, landmarks, sensor=sensor, rng=3)
    found = cs.localize(log, landmarks, sensor=sensor)
    artists = cs.plot.run(found, truth=log.truth, world=landmarks)
    cs.plot.save(artists, HERE / "localization_run.png", dpi=90)


if __name__ == "__main__":
    draw_noise()
    draw_filter()
    draw_landmarks()
    draw_run()
