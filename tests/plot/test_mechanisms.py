"""Mechanisms, as pictures."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.errors import InputError, InputTypeError
from cspace.mechanisms import Delta, FourBar, SliderCrank, Stewart


def paths(artists):
    """The points of the lines, (m, 2) or (m, 3) each."""
    lines = [each for each in artists if hasattr(each, "get_data_3d") or hasattr(each, "get_xydata")]
    return [
        np.array(each.get_data_3d()).T if hasattr(each, "get_data_3d") else each.get_xydata()
        for each in lines
    ]


def lengths(artists):
    return sorted(
        float(np.linalg.norm(np.diff(path, axis=0), axis=1)[0]) for path in paths(artists) if len(path) == 2
    )


def test_bars_have_their_lengths(tmp_path):
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.9}).q
    one = plot.mechanism(linkage, q[0], title="one")
    np.testing.assert_allclose(lengths(one), [0.3, 0.7, 0.9, 1.0])
    both = plot.mechanism(linkage, q)
    assert len(lengths(both)) == 8
    plot.save(both, tmp_path / "four_bar.png")


def test_rails_and_rods_and_platforms():
    engine = SliderCrank(0.3, 0.8)
    q = engine.assembly_modes({"crank": 0.8}).q[0]
    assert lengths(plot.mechanism(engine, q)) == pytest.approx(sorted([0.3, 0.8, q[2]]))
    delta = Delta(0.2, 0.06, 0.25, 0.6)
    place = delta.assembly_modes({"x": 0.05, "y": 0, "z": -0.55}).q[0]
    drawn = plot.mechanism(delta, place)
    assert lengths(drawn) == pytest.approx([0.6] * 6)
    platform = Stewart.of_radii(0.5, 0.3, 0.6)
    pose = platform.pose_coordinates(cs.pose((0, 0, 0.6)))
    q = platform.assembly_modes(pose).q[0]
    assert lengths(plot.mechanism(platform, q)) == pytest.approx(sorted(q[2:18:3]))
    hexagons = [path for path in paths(plot.mechanism(platform, q)) if len(path) == 7]
    assert len(hexagons) == 2  # base and platform


def test_what_cannot_be_drawn():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    with pytest.raises(InputTypeError, match=r"the first argument is a Robot, expected a cs\.Mechanism"):
        plot.mechanism(linkage.robot, np.zeros(3))
    with pytest.raises(InputError, match="no configurations to draw"):
        plot.mechanism(linkage, np.zeros((0, 3)))
    with pytest.raises(InputError, match="q has shape"):
        plot.mechanism(linkage, np.zeros(2))
