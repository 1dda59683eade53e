"""Pictures of vehicles: the way in the colour of its direction, outlines where the vehicle was."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.plot import colors

plt = pytest.importorskip("matplotlib.pyplot")
nav = cs.navigation


@pytest.fixture
def ax():
    _, axes = plt.subplots()
    yield axes
    plt.close("all")


def way(artists):
    return next(a for a in artists if getattr(a, "get_zorder", int)() == 6)


def test_a_curve_is_red_forwards_and_blue_backwards(ax):
    curve = nav.reeds_shepp((0, 0, 0), (0.5, 1.5, np.pi), radius=1.0)
    drawn = way(cs.plot.drive(curve, ax=ax))
    tints = drawn.get_colors()[:, :3]
    lengths = np.array([np.hypot(*np.diff(piece, axis=0)[0]) for piece in drawn.get_segments()])
    for direction, tint in ((1, colors.PATH), (-1, colors.AXES[2])):
        driven = sum(each.length for each in curve.segments if each.direction == direction)
        same = np.all(np.abs(tints - tint) < 1e-6, axis=1)
        assert driven > 0
        assert lengths[same].sum() == pytest.approx(driven, rel=1e-3)


def test_a_route_of_a_car_draws_its_grid_and_its_outline(ax):
    car = nav.Car()
    route = nav.hybrid_a_star(
        cs.OccupancyGrid(np.zeros((40, 60), bool), resolution=0.5), (4, 5, 0), (20, 12, 1), vehicle=car
    )
    artists = cs.plot.drive(route, ax=ax, bodies=5)
    boxes = [path.vertices[:4] for a in artists if hasattr(a, "get_paths") for path in a.get_paths()]
    sides = {tuple(np.round(np.sort(np.hypot(*np.diff(box, axis=0).T)), 6)) for box in boxes if len(box) == 4}
    assert any(np.allclose(each, (car.width, car.length, car.length)) or len(each) == 3 for each in sides)
    assert ax.get_xlim() == (0, 30)
    shut = nav.hybrid_a_star(walled(), (4, 5, 0), (26, 5, 0))
    assert not shut
    assert "unreachable" in cs.plot.drive(shut, ax=ax)[-1].get_text()


def walled():
    blocked = np.zeros((40, 60), bool)
    blocked[:, 30] = True
    return cs.OccupancyGrid(blocked, resolution=0.5)


def test_a_run_is_drawn_with_its_end(ax):
    run = nav.follow([(0, 0), (3, 0), (3, 2)])
    artists = cs.plot.drive(run, ax=ax)
    assert artists[-1].get_text() == "pure_pursuit: arrived"
    np.testing.assert_allclose(way(artists).get_segments()[0][0], run.poses[0, :2])


def test_a_coverage_tints_what_is_swept(ax):
    blocked = np.zeros((20, 30), bool)
    blocked[5:10, 10:15] = True
    swept = nav.coverage(cs.OccupancyGrid(blocked, resolution=0.1), (0.05, 0.05), width=0.2)
    artists = cs.plot.coverage(swept, ax=ax)
    shade = artists[1].get_array()
    np.testing.assert_array_equal(shade[..., 3] > 0, ~blocked)
    assert f"{swept.length:.5g} m" in artists[-1].get_text()


def test_what_is_no_drive_is_refused(ax):
    with pytest.raises(InputTypeError, match="drive is a list"):
        cs.plot.drive([1, 2, 3], ax=ax)
    with pytest.raises(InputError, match="bodies is -1"):
        cs.plot.drive(nav.follow([(0, 0), (3, 0)]), ax=ax, bodies=-1)
