"""Pictures of worlds and routes: something is drawn for every planner, and it is where it should be."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError

plt = pytest.importorskip("matplotlib.pyplot")

SHEDS = [[(2, 2), (5, 2), (5, 5), (2, 5)], [(6, 1), (8.5, 1.5), (7, 4)]]


@pytest.fixture
def world():
    yield cs.PolygonWorld(SHEDS, (0, 0, 10, 10))
    plt.close("all")


def pixels(axes):
    axes.figure.canvas.draw()
    return np.asarray(axes.figure.canvas.buffer_rgba())[..., :3].astype(int)


@pytest.mark.parametrize("planner", cs.navigation.PLANNERS)
def test_every_planner_draws_its_idea(world, planner):
    route = cs.navigate(world, (1, 1), (9, 9), planner)
    _, axes = plt.subplots(1, 2)
    bare = cs.plot.route(route, ax=axes[0], idea=False)
    full = cs.plot.route(route, ax=axes[1])
    assert len(full) > len(bare)
    assert route.planner.replace("_", " ") in axes[1].get_title(loc="left")
    line = next(a for a in full if getattr(a, "get_zorder", int)() == 6)
    np.testing.assert_allclose(np.column_stack(line.get_data()), route.path)


def test_obstacles_are_dark_and_free_space_is_white(world):
    for each in (world, world.to_grid(0.5)):
        _, ax = plt.subplots()
        cs.plot.world(each, ax=ax)
        ax.set_axis_off()
        shown = pixels(ax)
        white = np.all(shown > 250, axis=-1)
        assert white.any()
        if each.kind == "grid":
            place = ax.transData.transform((3.5, 3.5)).astype(int)
            assert shown[shown.shape[0] - place[1], place[0]].max() < 140


def test_several_routes_share_a_figure(world):
    routes = [cs.navigate(world, (1, 1), (9, 9), planner) for planner in ("any_angle", "bug_1", "a_star")]
    figure = cs.plot.routes(routes, columns=2)
    assert len(figure.axes) == 4
    with pytest.raises(InputError, match="empty"):
        cs.plot.routes([])


def test_an_animation_tells_the_search(world, tmp_path):
    route = cs.navigate(world, (1, 1), (9, 9), "visibility_graph")
    path = tmp_path / "search.gif"
    cs.plot.save(cs.plot.animation(route, frames=3), path, dpi=40)
    assert not plt.get_fignums()
    assert path.read_bytes()[:3] == b"GIF"


def test_surfaces_show_the_path_and_the_minima():
    hook = [(3, 3), (7, 3), (7, 8), (3, 8), (3, 7.4), (6.4, 7.4), (6.4, 3.6), (3, 3.6)]
    trap = cs.PolygonWorld([hook], (0, 0, 10, 10))
    caught = cs.navigate(trap, (1.5, 5.7), (8.8, 5.4), "potential_field", rho_0=1.0)
    artists = cs.plot.surface(caught)
    path, dots, star = (np.array(a.get_data_3d()) for a in artists[1:])
    assert np.hypot(*(path[:2, -1] - caught.path[-1])) < 1e-9
    assert np.min(np.hypot(*(dots[:2].T - caught.path[-1]).T)) < 0.01  # where it rests is a minimum
    assert np.allclose(star[:2, 0], caught.goal)
    flat = cs.plot.route(caught, ax=plt.subplots()[1])
    assert any(getattr(a, "get_marker", str)() == "o" and a.get_zorder() == 5 for a in flat)
    plt.close("all")


@pytest.mark.parametrize("planner", ["rimon_koditschek", "harmonic"])
def test_navigation_functions_have_no_minimum_but_the_goal(world, planner):
    artists = cs.plot.surface(cs.navigate(world, (1, 1), (9, 9), planner))
    assert np.size(artists[2].get_data_3d()[0]) == 0


def test_surfaces_of_planners_without_a_field_are_refused(world):
    with pytest.raises(InputError, match="a surface needs"):
        cs.plot.surface(cs.navigate(world, (1, 1), (9, 9), "bug_1"))
