"""Simulations over time, as pictures."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest

import cspace as cs
from cspace import model, plot
from cspace.errors import InputError, InputTypeError, UnknownNameError


def lines_of(artists):
    return [each for each in artists if hasattr(each, "get_xydata")]


def panels_of(artists):
    return {ax.get_ylabel().split("\n")[0]: ax for ax in artists[0].figure.axes}


def cart():
    """A cart on a rail with a pole."""
    body = model.Inertial(1.0, (0, 0, 0.5), 0.1 * np.eye(3))
    links = (model.Link("rail"), model.Link("cart", body), model.Link("pole", body))
    joints = (
        model.Joint("slide", "prismatic", "rail", "cart", axis=(1, 0, 0)),
        model.Joint("swing", "continuous", "cart", "pole", axis=(0, 1, 0)),
    )
    return cs.Robot(model.Description("cart", links, joints))


@pytest.mark.parametrize("lead", [(), (3,)])
def test_every_joint_of_every_row_has_a_curve_of_its_colour(lead, tmp_path):
    robot = cs.load_robot("puma560")
    run = robot.simulate(np.zeros((*lead, 6)), np.zeros(6), duration=0.02, dt=0.002)
    artists = plot.simulation(run)
    panels = panels_of(artists)
    assert list(panels) == ["joints", "velocities", "energy"], "nothing drives the joints: no torques"
    for name, values in (("joints", run.q), ("velocities", run.qd)):
        lines = panels[name].lines
        assert len(lines) == 6 * int(np.prod(lead))
        assert len({line.get_color() for line in lines}) == 6
        for k, line in enumerate(lines[:: int(np.prod(lead))]):
            np.testing.assert_array_equal(line.get_xdata(), run.times)
            np.testing.assert_array_equal(line.get_ydata(), values.reshape(-1, len(run), 6)[0, :, k])
    texts = [text.get_text() for text in panels["joints"].get_legend().get_texts()]
    assert texts == list(robot.joint_names)
    plot.save(artists, tmp_path / "fall.png")


def test_units_and_kinds_come_from_the_robot():
    robot = cart()
    run = robot.simulate([0.1, 0.2], [0, 0], control=np.array([1.0, 0.5]), duration=0.1, dt=0.01)
    artists = plot.simulation(run, robot=robot, degrees=True)
    labels = [ax.get_ylabel().replace("\n", " ") for ax in artists[0].figure.axes]
    assert labels == [
        "joints [deg]",
        "prismatic joints [m]",
        "velocities [deg/s]",
        "prismatic velocities [m/s]",
        "torques [N·m]",
        "forces [N]",
        "energy [J]",
    ]
    panels = panels_of(artists)
    np.testing.assert_allclose(panels["joints"].lines[0].get_ydata(), np.degrees(run.q[:, 1]))
    np.testing.assert_allclose(panels["prismatic joints"].lines[0].get_ydata(), run.q[:, 0])
    total, kinetic, potential = (line.get_ydata() for line in panels["energy"].lines)
    np.testing.assert_allclose(kinetic, robot.kinetic_energy(run.q, run.qd), atol=1e-12)
    np.testing.assert_allclose(potential, robot.potential_energy(run.q), atol=1e-9)
    np.testing.assert_allclose(total, run.energy)
    plt.close("all")


def test_a_floating_base_has_panels_of_its_own():
    robot = cs.load_robot("panda", floating=True)
    qd = np.r_[0, 0, 1, 0.1, 0, 0, np.linspace(-1, 1, 7)]
    run = robot.simulate(robot.named_poses["ready"], qd, duration=0.05, dt=0.005)
    panels = panels_of(plot.simulation(run, robot=robot))
    assert list(panels)[:4] == ["base position", "base velocity", "base angular velocity", "joints"]
    for k, line in enumerate(panels["base position"].lines):
        np.testing.assert_array_equal(line.get_ydata(), run.T_world_base[:, k, 3])
    plt.close("all")


def test_of_many_joints_ten_are_named_and_legends_lie_beside_the_curves():
    links, joints = [model.Link("link_0")], []
    for k in range(29):
        links.append(model.Link(f"link_{k + 1}", model.Inertial(0.1, (0.05, 0, 0), 1e-3 * np.eye(3))))
        axis, place = ((0, 1, 0), (1, 0, 0))[k % 2], cs.pose((0.05, 0, 0))
        joints.append(model.Joint(f"joint_{k}", "continuous", f"link_{k}", f"link_{k + 1}", place, axis=axis))
    robot = cs.Robot(model.Description("snake", tuple(links), tuple(joints)))
    run = robot.simulate(np.zeros(29), np.zeros(29), duration=0.05, dt=0.005)
    artists = plot.simulation(run, robot=robot)
    panel = panels_of(artists)["joints"]
    texts = [text.get_text() for text in panel.get_legend().get_texts()]
    assert len(texts) == 11
    assert texts[-1] == "and 19 more"
    ranges = np.ptp(run.q, axis=0)
    named = [robot.joint_names.index(text) for text in texts[:-1]]
    assert ranges[named].min() >= np.delete(ranges, named).max()
    colors = [line.get_color() for line in panel.lines]
    assert len(set(colors)) == 11
    figure = panel.figure
    figure.canvas.draw()
    for ax in figure.axes:
        if ax.get_legend() is not None:
            assert not ax.get_legend().get_window_extent().overlaps(ax.get_window_extent())
    plt.close("all")


def test_panels_and_axes_can_be_chosen():
    robot = cart()
    run = robot.simulate([0.1, 0.2], [0, 0], duration=0.05, dt=0.01)
    _, axes = plt.subplots(2, 1)
    artists = plot.simulation(run, panels=["energy", "joints"], axes=axes)
    assert [ax.get_ylabel().split("\n")[0] for ax in axes] == ["energy", "joints"]
    assert len(lines_of(artists)) == 3
    with pytest.raises(InputError, match="need as many axes, got 2"):
        plot.simulation(run, axes=axes)
    with pytest.raises(UnknownNameError, match="energi"):
        plot.simulation(run, panels=["energi"])
    with pytest.raises(InputError, match="needs robot="):
        plot.simulation(run, degrees=True)
    with pytest.raises(InputError, match="not those of the simulation"):
        plot.simulation(run, robot=cs.load_robot("puma560"))
    plt.close("all")


def test_rows_that_end_early_are_drawn_until_then():
    robot = cart()
    run = robot.simulate([[0, 0.1], [0, 0.2]], [[0, 0], [0, 1e90]], duration=0.05, dt=0.01)
    assert not run
    artists = plot.simulation(run, robot=robot)
    assert lines_of(artists)
    plt.close("all")


def test_only_simulations_are_drawn():
    with pytest.raises(InputTypeError, match="run is an int"):
        plot.simulation(3)
