"""The picture of a plane and its configuration space: what is drawn where, and in which colour."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError

plt = pytest.importorskip("matplotlib.pyplot")
from cspace.plot.configuration_space import round_outline  # noqa: E402

WALLS = [[(0.75, 0.95), (1.35, 0.75), (1.45, 1.3)], [(-1.45, 0.25), (-0.85, 0.35), (-1.05, 0.95)]]


@pytest.fixture
def axes():
    yield plt.subplots(1, 2)[1]
    plt.close("all")


@pytest.fixture(scope="module")
def space():
    return cs.configuration_space(cs.load_robot("planar_2r"), WALLS, link_radius=0.04)


def test_cells_have_the_colour_of_their_obstacle(space, axes):
    cs.plot.configuration_space(space, ax=axes)
    (picture,) = axes[1].get_images()
    colors = picture.get_array()
    owners = space.obstacle_map(len(colors)).T
    assert np.all(colors[owners < 0] == 1.0)
    tints = [np.unique(colors[owners == k], axis=0) for k in range(2)]
    assert [len(tint) for tint in tints] == [1, 1]
    assert not np.allclose(*tints)
    assert axes[1].get_xlim() == pytest.approx((-np.pi, np.pi))


def test_start_goals_and_path_lie_where_they_are(space, axes):
    start, goals = np.array([-0.3, 0.5]), cs.load_robot("planar_2r").ik(position=[-1.2, 1.25, 0]).q
    way = space.path(start, goals)
    cs.plot.configuration_space(space, start=start, goals=goals, path=way, ax=axes)
    marks = {line.get_marker(): line for line in axes[1].get_lines()}
    np.testing.assert_allclose(np.ravel(marks["o"].get_data()), start)
    stars = [np.ravel(line.get_data()) for line in axes[1].get_lines() if line.get_marker() == "*"]
    np.testing.assert_allclose(stars, goals)
    tips = [np.ravel(line.get_data()) for line in axes[0].get_lines() if line.get_marker() == "*"]
    np.testing.assert_allclose(tips, [[-1.2, 1.25]] * 2, atol=1e-9)


def test_new_axes_and_no_artists_but_those_returned(space):
    artists = cs.plot.configuration_space(space)
    assert all(artist.figure is artists[0].figure for artist in artists)
    plt.close("all")


def test_joints_with_limits_have_their_range(axes):
    T = np.eye(4)
    T[0, 3] = 2.0
    arm = cs.Robot.from_screws([[0, 0, 1]] * 2, [[0, 0, 0], [1, 0, 0]], T, lower=[-1, -7], upper=[1, 7])
    cs.plot.configuration_space(cs.configuration_space(arm, WALLS), path=[[0, 0], [0.5, -1]], ax=axes)
    assert axes[1].get_xlim() == (-1, 1)
    assert axes[1].get_ylim() == (-7, 7)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_outlines_keep_the_radius(count):
    angles = 2 * np.pi * np.arange(count) / count
    corners = np.column_stack([np.cos(angles), np.sin(angles)])
    outline = round_outline(corners, 0.3)
    a, b = corners, np.roll(corners, -1, axis=0)
    way = b - a
    length = np.maximum(np.sum(way**2, axis=1), 1e-300)
    part = np.clip(np.einsum("nmk,mk->nm", outline[:, None] - a, way) / length, 0, 1)
    apart = np.linalg.norm(outline[:, None] - a - part[..., None] * way, axis=2).min(axis=1)
    np.testing.assert_allclose(apart, 0.3, atol=1e-12)


def test_arguments_that_cannot_be_drawn(space, axes):
    with pytest.raises(InputTypeError, match="space is a str"):
        cs.plot.configuration_space("space")
    with pytest.raises(InputTypeError, match="space_slice"):
        cs.plot.configuration_space(cs.configuration_space(cs.load_robot("planar_2r"), exact=False))
    with pytest.raises(InputError, match="ax has 1 axes"):
        cs.plot.configuration_space(space, ax=axes[0])
    with pytest.raises(InputError, match="start"):
        cs.plot.configuration_space(space, start=[1, 2, 3], ax=axes)
