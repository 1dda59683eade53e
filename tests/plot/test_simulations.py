"""Simulations over time, as pictures."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.errors import InputTypeError


@pytest.mark.parametrize("lead", [(), (3,)])
def test_a_simulation_shows_every_joint_of_every_row(lead, tmp_path):
    robot = cs.load_robot("puma560")
    run = robot.simulate(np.zeros((*lead, 6)), np.zeros(6), duration=0.02, dt=0.002)
    artists = plot.simulation(run)
    lines = [each for each in artists if hasattr(each, "get_xydata")]
    assert len(lines) == 6 * int(np.prod(lead))
    np.testing.assert_array_equal(lines[0].get_xdata(), run.times)
    np.testing.assert_array_equal(lines[-1].get_ydata(), run.q[(-1,) * len(lead)][:, 5])
    texts = [text.get_text() for text in artists[len(lines)].get_texts()]
    assert texts == list(robot.joint_names)
    plot.save(artists, tmp_path / "fall.png")


def test_only_simulations_are_drawn():
    with pytest.raises(InputTypeError, match="run is a int"):
        plot.simulation(3)
