"""Pictures of localisation and of pose graphs: axes, legends, films."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.errors import InputError, InputTypeError
from cspace.localization import Landmarks, RangeBearing, TimedPoses, simulate
from localization.graph.graphs import random_graph
from plot.test_pictures import image_of, share_of_ink

plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(scope="module")
def drive():
    """A log, its map, and the answer of a filter."""
    run = cs.navigation.follow([(0, 0), (4, 0), (4, 4)], vehicle=cs.Unicycle())
    landmarks = Landmarks(range(3), [(1.0, -1.0), (5.0, 2.0), (2.0, 3.0)])
    sensor = RangeBearing(most_range=4.0)
    log = simulate(run, landmarks, sensor=sensor, rng=7)
    return log, landmarks, cs.localize(log, landmarks, sensor=sensor, start=log.truth.poses[0])


def labels(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_a_run_shows_its_errors_and_their_bounds(drive):
    log, landmarks, found = drive
    artists = plot.run(found, truth=log.truth, world=landmarks)
    figure = artists[0].figure
    place, position, heading, nis = figure.axes
    assert labels(place) == ["landmarks", "truth", "ekf"]
    assert labels(position) == ["95 % claimed", "error"]
    assert "used" in labels(nis)
    assert "rmse" in place.get_title(loc="left")
    assert heading.get_ylim()[0] == 0.0
    assert place.get_aspect() == 1.0
    assert 0.01 < share_of_ink(image_of(artists)) < 0.6


def test_poses_alone_are_drawn(drive):
    log, _, _ = drive
    plot.run(log.truth)
    plot.run(log.odometry.dead_reckoning(), truth=log.truth, align="se2", title="odometry")
    bare = TimedPoses([0.0, 1.0], [[0.0, 0, 0], [1, 0, 0]])
    assert plot.run(bare)


def test_a_run_on_given_axes(drive):
    log, landmarks, found = drive
    figure, axes = plt.subplots(2, 2)
    artists = plot.run(found, truth=log.truth, world=landmarks, axes=axes)
    assert all(artist.figure is figure for artist in artists)
    with pytest.raises(InputError, match="four axes"):
        plot.run(found, axes=axes[0])


def test_a_lost_robot_is_marked(drive):
    log, _, _ = drive
    far = Landmarks(range(3), [(40.0, 1.0), (50.0, 2.0), (42.0, 33.0)])
    found = cs.localize(log, far, start=log.truth.poses[0])
    assert found.lost.any()
    axes = plot.run(found, truth=log.truth)[0].axes.figure.axes
    assert "lost" in labels(axes[0])
    assert "rejected" in labels(axes[3])


def test_the_film_of_a_run(drive, tmp_path):
    log, landmarks, found = drive
    film = plot.animation(found, truth=log.truth, world=landmarks, frames=6)
    plot.save(film, tmp_path / "run.gif", dpi=40)
    from PIL import Image

    with Image.open(tmp_path / "run.gif") as picture:
        assert picture.n_frames >= 6
    film = plot.animation(found, ax=plot.run(found)[0].axes, frames=3)
    plot.save(film, tmp_path / "again.gif", dpi=30)


@pytest.mark.parametrize("space", [False, True])
def test_graphs_before_and_after(space):
    graph = random_graph(np.random.default_rng(1), 30, spatial=space)
    answer = graph.optimize()
    artists = plot.graph(answer)
    axes = artists[0].axes.figure.axes
    assert len(axes) == 2
    assert "before: 30 poses" in axes[0].get_title(loc="left")
    assert "after: converged" in axes[1].get_title(loc="left")
    assert set(labels(axes[1])) >= {"poses", "loops"}
    assert plot.graph(graph)[0].axes.figure.axes[0].get_title(loc="left").startswith("before")


def test_rejected_loops_are_red():
    graph = random_graph(np.random.default_rng(2), 40)
    wrong = cs.PoseGraph(
        graph.poses,
        np.concatenate([graph.edges, [[3, 30]]]),
        np.concatenate([graph.motions, [[9.0, 9.0, 2.0]]]),
        np.concatenate([graph.information, graph.information[:1]]),
    )
    answer = wrong.optimize(robust="dcs")
    assert answer.rejected
    _, ax = plt.subplots()
    plot.graph(answer, axes=ax, truth=graph.poses)
    assert set(labels(ax)) >= {"truth", "poses", "rejected"}


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda: plot.run(3), "what cs.localize returns"),
        (lambda: plot.graph([1.0]), "what PoseGraph.optimize returns"),
        (lambda: plot.animation(3), "a Route"),
    ],
)
def test_other_objects_are_refused(call, part):
    with pytest.raises(InputTypeError, match=part):
        call()
