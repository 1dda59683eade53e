"""The pictures of slices and projections: which cell has which colour, and where marks lie."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError

plt = pytest.importorskip("matplotlib.pyplot")

SCENE = cs.Scene(
    [cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], "wall"), cs.HalfSpace(offset=-0.1, name="floor")]
)


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def space():
    return cs.configuration_space(cs.load_robot("panda"), SCENE)


@pytest.fixture(scope="module")
def ready():
    return cs.load_robot("panda").named_poses["ready"]


def test_cells_have_the_colour_of_what_blocks_and_the_rim_is_darker(space, ready):
    part = space.slice((1, 3), at=ready, size=90)
    axes = plt.subplots()[1]
    cs.plot.space_slice(part, ax=axes)
    (picture,) = axes.get_images()
    shades = np.swapaxes(np.asarray(picture.get_array()), 0, 1)
    free, proved = ~part.bitmap, part.is_proved
    assert (shades[free & proved] == 1.0).all()
    assert (shades[free & ~proved] < 1.0).all()
    tints = []
    for k in np.unique(part.obstacle_map[part.bitmap]):
        here = part.obstacle_map == k
        inner, rim = (np.unique(shades[here & which], axis=0) for which in (proved, ~proved))
        assert len(inner) == len(rim) == 1
        assert rim.sum() < inner.sum()
        tints.append(inner[0])
    assert len(np.unique(tints, axis=0)) == len(tints) > 1
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == [part.obstacles[k] for k in np.unique(part.obstacle_map[part.bitmap])]
    assert axes.get_xlim() == pytest.approx((part.lower[0], part.upper[0]))
    assert axes.get_ylim() == pytest.approx((part.lower[1], part.upper[1]))
    assert axes.get_xlabel() == "panda_joint2 [rad]"


def test_marks_lie_at_their_two_joints(space, ready):
    part = space.slice((1, 3), at=ready, size=16)
    plan = cs.plan(cs.load_robot("panda"), ready, ready + 0.05)
    axes = plt.subplots()[1]
    cs.plot.space_slice(part, q=[ready - 0.1], path=plan, ax=axes, title="two joints")
    dots = [np.ravel(line.get_data()) for line in axes.get_lines()]
    np.testing.assert_allclose(dots, [(ready - 0.1)[[1, 3]], ready[[1, 3]]])
    (lines,) = axes.collections
    np.testing.assert_allclose(lines.get_segments()[0], plan.path[:, [1, 3]])
    assert axes.get_title(loc="left") == "two joints"


def test_projections_show_shares_and_grey_where_nothing_is_free():
    arm = cs.load_robot("planar_2r")
    space = cs.configuration_space(arm, cs.Scene([cs.Sphere(0.3, [1.2, 0.5, 0])]), exact=False)
    part = space.project((0, 1), size=40, samples=2)
    axes = plt.subplots()[1]
    artists = cs.plot.space_projection(part, q=[0.5, 7.0], ax=axes)
    (picture,) = axes.get_images()
    np.testing.assert_array_equal(np.ma.getmaskarray(picture.get_array()).T, ~part.is_free)
    (dot,) = axes.get_lines()
    np.testing.assert_allclose(np.ravel(dot.get_data()), [0.5, 7.0 - 2 * np.pi])
    assert artists[-1].ax.get_ylabel() == "share of free samples"


def test_slides_are_drawn_in_metres_and_new_axes_have_the_shape_of_the_range():
    T = np.eye(4)
    T[0, 3] = 0.5
    robot = cs.Robot.from_screws(
        np.eye(3), np.zeros((3, 3)), T, joint_types="RPR", lower=[-3, 0, -0.3], upper=[3, 0.2, 0.3]
    ).with_spheres({"tip": [[0, 0, 0, 0.1]]})
    space = cs.configuration_space(robot, SCENE)
    artists = cs.plot.space_slice(space.slice((0, 1), size=16))
    assert artists[0].axes.get_ylabel().endswith("[m]")
    wide = cs.plot.space_slice(space.slice((0, 2), size=16))[0].axes.figure.get_size_inches()
    assert wide[0] > 2 * wide[1]


def test_arguments_that_cannot_be_drawn(space, ready):
    part = space.slice((1, 3), at=ready, size=4)
    with pytest.raises(InputTypeError, match="part is a JointSpace"):
        cs.plot.space_slice(space)
    with pytest.raises(InputTypeError, match="part is a Slice"):
        cs.plot.space_projection(part)
    with pytest.raises(InputError, match="q has shape"):
        cs.plot.space_slice(part, q=[1, 2, 3])
    with pytest.raises(InputError, match="path has shape"):
        cs.plot.space_projection(space.project((1, 3), size=4, samples=1), path=[[1, 2]])
    with pytest.raises(InputError, match="2-D axes"):
        cs.plot.space_slice(part, ax=plt.figure().add_subplot(projection="3d"))
