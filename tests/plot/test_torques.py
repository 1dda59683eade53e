"""Torques split by their causes, exciting trajectories and mechanisms, as pictures."""

from __future__ import annotations

import os
import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.errors import InputError, InputTypeError
from cspace.plot.torques import split_torques


@pytest.fixture(autouse=True)
def _close_figures():
    yield
    plt.close("all")


@pytest.mark.parametrize("floating", [False, True])
def test_bars_add_up_to_the_torques(floating):
    robot = cs.load_robot("puma560", floating=floating)
    rng = np.random.default_rng(3)
    q, (qd, qdd) = rng.normal(size=6), rng.normal(size=(2, robot.dof))
    acts = {"wrenches": {robot.tip: rng.normal(size=6)}, "expressed_in": "tip"}
    T = cs.pose((0, 0, 1), rpy=(0.3, 0.1, 0)) if floating else None
    parts = split_torques(robot, [q, qd, qdd], (0, 0, -9.81), acts, True, T)
    assert list(parts) == ["inertia", "Coriolis and centrifugal", "gravity", "friction", "wrenches"]
    tau = robot.inverse_dynamics(q, qd, qdd, T_world_base=T, **acts)
    np.testing.assert_allclose(sum(parts.values()), tau, atol=1e-9)
    M = robot.mass_matrix(q, T_world_base=T)
    np.testing.assert_allclose(parts["inertia"], M @ qdd, atol=1e-9)
    artists = plot.torques(robot, q, qd, qdd, T_world_base=T, **acts)
    panels = artists[0].axes.figure.axes
    assert len(panels) == (3 if floating else 1)
    marks = next(line for line in panels[-1].lines if line.get_marker() == "D")
    np.testing.assert_allclose(marks.get_xdata(), tau[-6:], atol=1e-9)
    low, high = panels[-1].get_xlim()
    assert low < tau[-6:].min()
    assert high > tau[-6:].max()


def test_what_is_zero_has_no_entry():
    robot = cs.load_robot("panda")
    artists = plot.torques(robot, robot.named_poses["ready"])
    texts = [text.get_text() for text in artists[0].axes.figure.axes[0].get_legend().get_texts()]
    assert texts[:2] == ["gravity", "sum"]
    assert plot.torques(robot, robot.named_poses["ready"], gravity=(0, 0, 0))


def test_only_torques_of_robots_are_drawn():
    robot = cs.load_robot("panda")
    with pytest.raises(InputTypeError, match=r"expected a cs\.Robot"):
        plot.torques("panda", np.zeros(7))
    with pytest.raises(InputError, match="as many axes, got 2"):
        plot.torques(robot, np.zeros(7), axes=plt.subplots(2, 1)[1])
    with pytest.raises(InputError, match="qd"):
        plot.torques(robot, np.zeros(7), np.zeros(3))
    with pytest.raises(InputError, match="has a mass"):
        plot.torques(cs.load_robot("kr6_r900"), np.zeros(6))


def test_exciting_trajectories_are_drawn_with_their_jerk():
    robot = cs.load_robot("ur5e")
    motion = cs.dynamics.exciting_trajectory(robot, trials=2, rng=0)
    panels = plot.trajectory(motion, limits=robot)[0].figure.axes
    assert len(panels) == 4
    for j in range(6):
        t, q = panels[0].lines[j].get_data()
        np.testing.assert_allclose(q, motion(t)[0][:, j], atol=1e-12)
        t, jerk = panels[3].lines[j].get_data()
        difference = (motion(t + 1e-5)[2] - motion(t - 1e-5)[2])[:, j] / 2e-5
        np.testing.assert_allclose(jerk, difference, atol=1e-5)
    texts = [text.get_text() for text in panels[0].get_legend().get_texts()]
    assert texts == list(robot.joint_names)
    bare = plot.trajectory(motion)
    assert bare[0].axes.get_legend().get_texts()[0].get_text() == "joint 0"
    with pytest.raises(InputError, match="7 joints"):
        plot.trajectory(motion, limits=cs.load_robot("panda"))


COLORS = """
import matplotlib; matplotlib.use("Agg")
from cspace import plot
from cspace.mechanisms import FourBar
linkage = FourBar(ground=1.0, crank=0.3, coupler=0.9, rocker=0.7)
q = linkage.assembly_modes({"crank": 0.9}).q[0]
print([tuple(line.get_color()) for line in plot.mechanism(linkage, q)])
"""


@pytest.mark.slow
def test_links_have_the_same_colours_in_every_run():
    told = set()
    for seed in ("1", "2", "3"):
        command = [sys.executable, "-c", COLORS]
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        told.add(subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout)
    assert len(told) == 1
