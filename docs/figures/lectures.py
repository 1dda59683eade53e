"""Draws the figures of the lectures: `python docs/figures/lectures.py [FOLDER]` writes them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patheffects import withStroke

import cspace as cs
from cspace import plot

DPI, SHARP = 70, {"forces": 110}
INK, FAINT, BLUE, RED, GREEN = "#222222", "#bbbbbb", "#1f6fb2", "#c8442f", "#3a8f4d"
HALO = [withStroke(linewidth=3, foreground="white")]


def bare(ax, title=""):
    """Equal scales, no frame around."""
    ax.set_aspect("equal")
    ax.set_title(title, color=INK, fontsize=10)
    ax.spines[["top", "right"]].set_visible(False)


def draw_frame(ax, T, name, *, size=0.8):
    """A planar frame as two arrows."""
    origin = T[:2, 2]
    for k, (color, letter) in enumerate(((RED, "x"), (GREEN, "y"))):
        end = origin + size * T[:2, k]
        ax.annotate("", end, origin, arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.8})
        ax.annotate(f"{letter}_{name}", end + 0.14 * T[:2, k], color=color, ha="center", va="center")
    ax.plot(*origin, "o", color=INK, ms=4)


def draw_arm(ax, robot, q, *, color=INK, alpha=1.0, label=None):
    """A planar arm as a line with dots at the joints."""
    places = robot.fk_all(q)[1:, :2, 3]
    ax.plot(*places.T, "-o", color=color, alpha=alpha, lw=2.4, ms=4.5, label=label)
    return places


def one_point_two_frames():
    """Frames A and B and a point seen from both."""
    _, ax = plt.subplots(figsize=(5.2, 3.8))
    T_A_B = cs.pose_2d((-1.0, 0.0), theta=np.pi / 2)
    draw_frame(ax, np.eye(3), "A")
    draw_frame(ax, T_A_B, "B")
    p_A = cs.transform_points_2d(T_A_B, (2.0, 1.0))
    corner = cs.transform_points_2d(T_A_B, (2.0, 0.0))
    ax.plot(*np.stack([T_A_B[:2, 2], corner, p_A]).T, color=FAINT, ls="--", lw=1.2)
    ax.plot(*p_A, "o", color=BLUE, ms=7)
    ax.annotate("p_B = (2, 1)\np_A = (−2, 2)", p_A, xytext=(8, 4), textcoords="offset points", color=BLUE)
    ax.set_xlim(-2.4, 1.3)
    ax.set_ylim(-0.4, 2.7)
    ax.grid(color="#eeeeee")
    bare(ax)
    return ax


def turned_tip():
    """A frame turned by 90° about z and moved."""
    T = cs.pose((0.5, -0.2, 0.3), axis_angle=((0, 0, 1), np.pi / 2))
    return plot.frames([np.eye(4), T], names=["base", "tip"])


def fixed_axes():
    """Three turns about axes that stand still, one after another."""
    gamma, beta, alpha = 0.5, 0.6, 0.9
    turns = [cs.rotation(rpy=r) for r in ((0, 0, 0), (gamma, 0, 0), (gamma, beta, 0), (gamma, beta, alpha))]
    poses = [cs.pose((1.6 * k, 0, 0), matrix=R) for k, R in enumerate(turns)]
    return plot.frames(poses, names=["start", "γ about x", "β about y", "α about z"])


def tasks():
    """Arms of one, two and three joints, asked for a point of the plane."""
    _, axes = plt.subplots(1, 3, figsize=(9.6, 3.4), layout="constrained")
    point = np.array([0.9, 0.7])
    one = cs.load_robot("planar_1r")
    for angle in np.linspace(0.1, 1.5, 8):
        draw_arm(axes[0], one, [angle], alpha=0.25)
    two = cs.load_robot("planar_2r")
    for q, color in zip(two.ik(position=point).q, (BLUE, RED), strict=True):
        draw_arm(axes[1], two, q, color=color)
    three = cs.load_robot("planar_3r")
    for heading in np.linspace(-1.6, 2.4, 9):
        hand = 0.5 * np.array([np.cos(heading), np.sin(heading)])
        for q in two.ik(position=point - hand).q:
            draw_arm(axes[2], three, [*q, heading - q.sum()], alpha=0.25)
    words = ("n = 1 < 2: over-constrained", "n = 2: exact", "n = 3 > 2: redundant")
    for ax, word in zip(axes, words, strict=True):
        ax.plot(*point, "*", color=GREEN, ms=13, zorder=5)
        bare(ax, word)
        ax.set_xlim(-0.8, 1.6)
        ax.set_ylim(-0.9, 1.3)
    return axes[0]


def two_links():
    """The angles and lengths of the two-joint arm."""
    _, ax = plt.subplots(figsize=(5.2, 3.6))
    robot, q = cs.load_robot("planar_2r"), np.array([0.5, 0.9])
    shoulder, elbow, tip = draw_arm(ax, robot, q)
    for place, start, width, name in ((shoulder, 0.0, q[0], "θ₁"), (elbow, q[0], q[1], "θ₂")):
        ray = place + np.array([np.cos(start), np.sin(start)]) * 0.6
        ax.plot(*np.stack([place, ray]).T, color=FAINT, ls="--", lw=1.2, zorder=0)
        sweep = start + np.linspace(0, width, 40)
        ax.plot(*(place[:, None] + 0.3 * np.array([np.cos(sweep), np.sin(sweep)])), color=BLUE, lw=1.4)
        middle = start + width / 2
        ax.annotate(name, place + 0.42 * np.array([np.cos(middle), np.sin(middle)]), color=BLUE, ha="center")
    for a, b, name in ((shoulder, elbow, "l₁"), (elbow, tip, "l₂")):
        across = np.array([a[1] - b[1], b[0] - a[0]])
        ax.annotate(name, (a + b) / 2 + 0.1 * across, color=INK, ha="center")
    ax.annotate("p", tip, xytext=(8, 2), textcoords="offset points", color=INK)
    bare(ax)
    return ax


def dh_frames():
    """Frames i − 1 and i of one row of a modified table, and the four motions between them."""
    alpha, a, d, theta = 0.5, 1.0, 0.7, 0.8
    turned = cs.pose(rpy=(alpha, 0, 0))
    moved = turned @ cs.pose((a, 0, 0))
    raised = moved @ cs.pose((0, 0, d))
    last = cs.model.dh_matrix(alpha, a, d, theta, convention="modified")
    artists = plot.frames([np.eye(4), moved, last], names=["i − 1", "after α, a", "i"], size=0.45)
    ax = artists[0].axes
    for start, end, name in ((np.eye(4), moved, "a"), (moved, raised, "d")):
        ends = np.stack([start[:3, 3], end[:3, 3]])
        ax.plot(*ends.T, color=INK, lw=1.2, ls="--")
        ax.text(*ends.mean(axis=0), name, color=INK, fontsize=12, zorder=40, path_effects=HALO)
    return artists


def four_cases():
    """None, one, two and infinitely many configurations of the two-joint arm."""
    _, axes = plt.subplots(1, 4, figsize=(11.0, 3.0), layout="constrained")
    robot = cs.load_robot("planar_2r")
    circle = np.linspace(0, 2 * np.pi, 200)
    words = ("none: out of reach", "one: stretched", "two", "infinitely many")
    points = ((2.5, 0.0), (2.0, 0.0), (1.1, 0.7), (0.0, 0.0))
    for ax, word, point in zip(axes, words, points, strict=True):
        ax.plot(2 * np.cos(circle), 2 * np.sin(circle), color=FAINT, lw=1.0, ls="--")
        found = robot.ik(position=point)
        for q, color in zip(found.q, (BLUE, RED), strict=False):
            draw_arm(ax, robot, q, color=color)
        if found.self_motions:
            for turn in np.linspace(0.3, 6.0, 12):
                draw_arm(ax, robot, [turn, np.pi], color=BLUE, alpha=0.2)
        ax.plot(*point, "*", color=GREEN, ms=12, zorder=5)
        bare(ax, word)
        ax.set_xlim(-2.3, 2.8)
        ax.set_ylim(-2.3, 2.3)
    return axes[0]


def standing_wrist():
    """The wrist centre of a PUMA 560 stands still while its last three joints turn."""
    turns = [(0, 0.4, 0), (1.2, 0.9, 0.3), (-1.4, 1.2, 0.5), (2.6, 0.8, 1.0)]
    q = np.array([[0.2, -0.5, 0.9, *turn] for turn in turns])
    labels = [f"wrist {k + 1}" for k in range(len(q))]
    return plot.solutions(cs.load_robot("puma560"), q, labels=labels, title="one wrist centre")


def ways(name: str, goal: Any, title: str):
    """Every configuration of an arm that reaches a goal."""
    robot = cs.load_robot(name)
    found = robot.ik(goal) if np.ndim(goal) == 2 else robot.ik(position=goal)
    return plot.solutions(robot, found, goal, title=f"{title}: {len(found)} configurations")


def puma_style_solutions():
    """The eight of the PUMA-style arm."""
    goal = cs.load_robot("puma_style").fk([0.5, 0.4, -1.1, 0.3, 0.8, -0.6])
    return ways("puma_style", goal, "PUMA-style arm")


def simplified_puma_solutions():
    """The four of the simplified PUMA."""
    return ways("simplified_puma", [0.7, 0.5, 0.6], "simplified PUMA")


def rpr_solutions():
    """The four of the RPR arm."""
    return ways("rpr", [0.5, 0.8, 0.3], "RPR arm")


def elbow_solutions():
    """The eight of the elbow arm."""
    return ways("elbow", cs.load_robot("elbow").fk([0.5, -0.7, 0.9, 0.3, 1.1, -0.4]), "elbow arm")


def levels(ax, world, goal, **gains):
    """The potential of a goal as lines of equal height."""
    xmin, ymin, xmax, ymax = world.bounds
    x, y = np.meshgrid(np.linspace(xmin, xmax, 401), np.linspace(ymin, ymax, 401))
    height = cs.navigation.potential(world, goal, np.stack([x, y], axis=-1), **gains)
    ax.contour(x, y, height, levels=np.linspace(0, 14, 29), colors=FAINT, linewidths=0.6)
    for obstacle in world.obstacles:
        ax.fill(*np.asarray(obstacle).reshape(-1, 2).T, color="#d9d9d9", ec=INK, lw=0.8)
    ax.plot(*goal, "*", color=GREEN, ms=12)


def descend(ax, world, goal, starts, **gains):
    """Descents of a potential, blue where they arrive."""
    levels(ax, world, goal, **gains)
    for start in starts:
        route = cs.navigate(world, start, goal, "potential_field", **gains)
        ax.plot(*route.path.T, color=BLUE if route else RED, lw=1.2)
        if not route:
            ax.plot(*route.path[-1], "x", color=RED, ms=7, mew=2)


def descents():
    """A potential that leads past a silo, and into a trap out of which a search by it finds."""
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    silo = np.stack([5 + np.cos(angles), 5 + np.sin(angles)], axis=1)
    trap = np.array([(4, 2), (7, 2), (7, 8), (4, 8), (4, 7.5), (6.5, 7.5), (6.5, 2.5), (4, 2.5)])
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.2), layout="constrained", sharey=True)
    past, caught = (cs.PolygonWorld([ring], (0, 0, 10, 10)) for ring in (silo, trap))
    goal, gains = (8.5, 5.0), {"rho_0": 1.0}
    starts = [(0.6, y) for y in np.linspace(0.7, 9.3, 18)]
    descend(axes[0], past, goal, starts, **gains)
    descend(axes[1], caught, goal, starts, **gains)
    levels(axes[2], caught, goal, **gains)
    route = cs.navigate(caught, (0.6, 5), goal, "potential_a_star", resolution=0.1, mode="greedy")
    settled = route.trace.end
    drawn = axes[2].scatter(*settled.T, c=np.arange(len(settled)), s=3, cmap="viridis", zorder=2)
    figure.colorbar(drawn, ax=axes[2], label="order in which cells are settled")
    axes[2].plot(*route.path.T, color=BLUE, lw=2)
    for ax, title in zip(axes, ("descents arrive", "or rest in a trap", "a search leaves it"), strict=True):
        bare(ax, title)
    return axes


def point_arm(*links):
    """A planar arm in a vertical plane; each link (mass, length) carries its mass at its end."""
    bodies, joints, end = [cs.model.Link("base")], [], 0.0
    for k, (mass, length) in enumerate(links):
        point = cs.model.Inertial(mass, (length, 0, 0), np.zeros((3, 3)))
        parent = bodies[-1].name
        bodies.append(cs.model.Link(f"link_{k + 1}", point))
        origin = cs.pose((end, 0, 0))
        joints.append(
            cs.model.Joint(f"joint_{k + 1}", "continuous", parent, bodies[-1].name, origin, axis=(0, -1, 0))
        )
        end = length
    return cs.Robot(cs.model.Description("points", tuple(bodies), tuple(joints)))


def forces():
    """Torques of a motion, what they are spent on, and the motion that they make."""
    arm, count = point_arm((1.5, 0.5), (0.7, 0.3)), 200
    t = np.linspace(0, 1, count + 1)[:, None]
    goal = np.array([1.2, 2.0])
    q = goal * (10 * t**3 - 15 * t**4 + 6 * t**5)
    qd, qdd = goal * 30 * t**2 * (1 - t) ** 2, goal * 60 * t * (1 - t) * (1 - 2 * t)
    tau = arm.inverse_dynamics(q, qd, qdd)
    parts = {
        "torque": tau,
        "acceleration, M q̈": (arm.mass_matrix(q) @ qdd[..., None])[..., 0],
        "velocity, C q̇": (arm.coriolis_matrix(q, qd) @ qd[..., None])[..., 0],
        "weight, g": arm.gravity_torques(q),
    }
    _, axes = plt.subplot_mosaic("ab\ncc", figsize=(8.8, 6.4), layout="constrained")
    axes = [axes[name] for name in "abc"]
    for joint, ax in enumerate(axes[:2]):
        for (name, values), color in zip(parts.items(), (INK, BLUE, GREEN, RED), strict=True):
            ax.plot(t[:, 0], values[:, joint], color=color, lw=2.2 if name == "torque" else 1.4, label=name)
        ax.set(title=f"joint {joint + 1}", xlabel="time [s]", ylabel="torque [N·m]")
        ax.grid(alpha=0.3)
    axes[0].legend(fontsize=9)
    for robot, style, name in (
        (arm, "-", "the same arm"),
        (arm.with_payload(0.02, com=(0.3, 0, 0), frame="link_2"), "--", "with 20 g at the tip"),
    ):
        run = robot.simulate(
            [0, 0],
            [0, 0],
            control=lambda now, *_: tau[min(round(now * count), count)],
            duration=1,
            dt=1 / count,
        )
        for joint, color in enumerate((BLUE, RED)):
            axes[2].plot(run.times, run.q[:, joint], style, color=color, label=f"joint {joint + 1}, {name}")
    axes[2].set(title="the torques replayed", xlabel="time [s]", ylabel="angle [rad]")
    axes[2].legend(fontsize=9, loc="upper left")
    axes[2].grid(alpha=0.3)
    return axes


def draw_motion(above, below, robot, motion, title, color):
    """Snapshots of an arm along a motion, the path of its tip, and the velocities of its joints."""
    t = np.linspace(0, motion.duration, 400)
    for k, share in enumerate(np.linspace(0, 1, 9)):
        draw_arm(above, robot, motion(share * motion.duration), color=color, alpha=0.15 + 0.1 * k)
    above.plot(*robot.fk(motion(t))[:, :2, 3].T, color=RED, lw=1.6)
    bare(above, title)
    for joint, shade in enumerate((INK, BLUE, GREEN)):
        below.plot(t, motion(t, 1)[:, joint], color=shade, label=f"joint {joint + 1}")
    for sign in (-1, 1):
        below.axhline(sign * 2.0, color=FAINT, ls="--", lw=1)
    below.set_xlabel("time [s]")
    below.spines[["top", "right"]].set_visible(False)


def from_a_to_b():
    """The same two configurations joined in joint coordinates, by a straight line, and around an obstacle."""
    robot = cs.load_robot("planar_3r", geometry="skeleton")
    start, goal = np.array([2.2, -1.2, -0.6]), np.array([0.2, 1.1, 0.5])
    limits = {"velocity": 2.0, "acceleration": 6.0}
    post = cs.Sphere(0.15, (0.75, 2.2, 0.0))
    joints = robot.move_to(goal, start=start, jerk=40.0, **limits)
    line = robot.move_linear(robot.fk(goal), start=start, **limits)
    around = cs.move(robot, start, goal, cs.Scene([post]), deviation=0.3, **limits)
    _, axes = plt.subplots(2, 3, figsize=(11.0, 6.0), layout="constrained", height_ratios=(2, 1))
    titles = ("straight in joint coordinates", "straight in the world", "around an obstacle")
    for column, (motion, title) in enumerate(zip((joints, line, around), titles, strict=True)):
        draw_motion(axes[0, column], axes[1, column], robot, motion, title, BLUE)
    axes[0, 2].add_patch(plt.Circle((0.75, 2.2), 0.15, color=FAINT))
    axes[1, 0].set_ylabel("joint velocity [rad/s]")
    axes[1, 0].legend(fontsize=8)
    for ax in axes[0]:
        ax.set(xlim=(-1.0, 1.7), ylim=(-0.1, 2.6))
    return axes.ravel()


PICTURES: tuple[Callable[[], Any], ...] = (
    one_point_two_frames,
    turned_tip,
    fixed_axes,
    tasks,
    two_links,
    dh_frames,
    four_cases,
    standing_wrist,
    puma_style_solutions,
    simplified_puma_solutions,
    rpr_solutions,
    elbow_solutions,
    descents,
    forces,
    from_a_to_b,
)


def main(folder: Path) -> None:
    """Write every picture into a folder."""
    for picture in PICTURES:
        drawn = picture()
        artists = list(drawn) if isinstance(drawn, (list, tuple, np.ndarray)) else [drawn]
        plot.save(artists, folder / f"{picture.__name__}.png", dpi=SHARP.get(picture.__name__, DPI))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
