"""Pictures of worlds and routes: something is drawn for every planner, and it is where it should be."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.plot.planner_overlays import shown_events

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
    assert route.planner in axes[1].get_title(loc="left")
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
        place = ax.transData.transform((3.5, 3.5)).astype(int)
        assert shown[shown.shape[0] - place[1], place[0]].max() < 140


def test_evidence_is_dark_where_it_is_certain():
    grid = cs.maps.EvidenceGrid.from_probability([[0.0, np.nan], [0.6, 1.0]], 1.0, (2.0, 0.0))
    _, ax = plt.subplots()
    cs.plot.world(grid, ax=ax)
    shown = pixels(ax)

    def tone(x, y):
        column, row = ax.transData.transform((x, y)).astype(int)
        return int(shown[shown.shape[0] - row, column].max())

    free, unknown, likely, sure = tone(2.5, 0.5), tone(3.5, 0.5), tone(2.5, 1.5), tone(3.5, 1.5)
    assert free > 250 > unknown > likely > sure
    assert sure < 140
    plt.close("all")


def test_what_a_radius_shuts_is_neither_obstacle_nor_free(world):
    for planner in ("any_angle", "a_star"):
        _, ax = plt.subplots()
        cs.plot.route(cs.navigate(world, (1, 1), (9, 9), planner, radius=0.4), ax=ax, idea=False)
        shown = pixels(ax)

        def tone(x, y, shown=shown, ax=ax):
            column, row = ax.transData.transform((x, y)).astype(int)
            return int(shown[shown.shape[0] - row, column].max())

        assert tone(3.5, 3.5) < 140 < tone(3.5, 1.8) < 220 < tone(3.5, 1.3)
        assert 140 < tone(0.2, 5) < 220


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


@pytest.mark.parametrize("corners", ["never", "one"])
@pytest.mark.parametrize("metric", ["octile", "manhattan"])
@pytest.mark.parametrize("seed", range(5))
def test_jumps_are_drawn_along_free_cells(metric, corners, seed):
    rng = np.random.default_rng(seed)
    blocked = rng.random((30, 40)) < 0.25
    blocked[0, 0] = blocked[-1, -1] = False
    grid = cs.OccupancyGrid(blocked, resolution=0.5)
    route = cs.navigate(
        grid, (0.25, 0.25), (19.75, 14.75), "jump_point_search", metric=metric, corners=corners
    )
    events = shown_events(route)
    for start, end in zip(events.start, events.end, strict=True):
        across, up = np.abs(end - start)
        assert min(across, up) < 1e-9 or (abs(across - up) < 1e-9 and metric == "octile")
        assert grid.path_clearance([start, end]) > 0 or corners != "never"
    assert np.array_equal(events.end[1::2], route.trace.end)


def test_a_film_ends_as_it_is_played(world, tmp_path):
    from PIL import Image

    route = cs.navigate(world, (1, 1), (9, 9), "rrt", rng=3)
    film = cs.plot.animation(route, frames=5)
    added, over = film.steps.show(5)
    assert len(added[0].get_segments()) == 0, "all events are drawn before"
    film._func(5)
    assert len(added[0].get_segments()) == len(route.trace)
    assert np.allclose(over[0].get_xydata(), route.path)
    cs.plot.save(film, tmp_path / "film.gif", dpi=40)
    with Image.open(tmp_path / "film.gif") as shown:
        assert shown.n_frames == 6
        shown.seek(5)
        last = np.asarray(shown.convert("RGB")).astype(int)
    red = np.array([214, 46, 51])
    assert (np.abs(last - red).sum(axis=2) < 30).sum() > 20


@pytest.mark.parametrize("seed", range(3))
def test_every_picture_of_a_rewired_tree_is_a_tree(world, seed):
    route = cs.navigate(world, (1, 1), (9, 9), "rrt_star", rng=seed, samples=600)
    film = cs.plot.animation(route, frames=7)
    for frame in range(8):
        added, over = film.steps.show(frame)
        edges = np.array(over[0].get_segments())
        assert not added
        assert len(np.unique(edges[:, 1], axis=0)) == len(edges), "one edge leads to each node"
        from_here = {tuple(route.start)}
        while more := {tuple(b) for a, b in edges if tuple(a) in from_here} - from_here:
            from_here |= more
        assert len(from_here) == len(edges) + 1, "every node hangs on the start"
    assert len(route.trace) > len(edges)
    still = cs.plot.route(route, ax=plt.subplots()[1])
    shown = [a for a in still if hasattr(a, "get_segments")]
    assert sum(len(a.get_segments()) for a in shown) == len(edges)
    plt.close("all")


@pytest.mark.parametrize("ending", ["mp4", "xyz", "png"])
def test_animations_of_other_formats_are_refused_by_name(world, tmp_path, ending):
    film = cs.plot.animation(cs.navigate(world, (1, 1), (9, 9)), frames=2)
    with pytest.raises(InputError, match=rf"search\.{ending}.*\.gif"):
        cs.plot.save(film, tmp_path / f"search.{ending}")
    assert not plt.get_fignums()


@pytest.mark.parametrize("name", ["ways.xyz", "ways"])
def test_pictures_of_unknown_formats_are_refused_by_name(world, tmp_path, name):
    with pytest.raises(InputError, match=rf"{name}.*\.png"):
        cs.plot.save(cs.plot.world(world), tmp_path / name)
    assert not plt.get_fignums()


def test_titles_are_what_users_type(world):
    artists = cs.plot.route(cs.navigate(world, (1, 1), (9, 9), "visibility_graph"))
    assert artists[-1].get_text().startswith("visibility_graph: ")
