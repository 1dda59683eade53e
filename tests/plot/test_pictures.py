"""Every picture: artists come back, the axes given are used, something is to be seen, nothing is shown."""

from __future__ import annotations

import io
import time

import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.errors import InputError, MissingExtraError
from plot import arms

plt = pytest.importorskip("matplotlib.pyplot")


def image_of(artists: list, dpi: int = 40) -> np.ndarray:
    """The picture (h, w, 3) in [0, 1]."""
    file = io.BytesIO()
    artists[0].figure.savefig(file, dpi=dpi, format="png")
    file.seek(0)
    return plt.imread(file)[..., :3]


def share_of_ink(image: np.ndarray) -> float:
    """The share of pixels that differ clearly from white."""
    return float((image.min(axis=2) < 0.9).mean())


PICTURES = {
    "robot": lambda ax: plot.robot(arms.elbow_arm(), np.full(6, 0.4), ax=ax, title="an arm"),
    "slide": lambda ax: plot.robot(arms.scara(), [0.4, 0.5, 0.1, 0.0], ax=ax),
    "solutions": lambda ax: plot.solutions(arms.elbow_arm(), [[0.1] * 6, [0.5] * 6, [-0.4] * 6], ax=ax),
    "frames": lambda ax: plot.frames([np.eye(4), arms.at(0.3, 0.2, 0.1)], names=["base", "tip"], ax=ax),
    "planar robot": lambda ax: plot.robot(arms.planar_arm(), [0.3, 0.8], ax=ax, title="flat"),
    "planar solutions": lambda ax: plot.solutions(
        arms.planar_arm(), [[0.2, 1.1], [1.15, -1.1]], [0.5, 0.4], labels=["down", "up"], ax=ax
    ),
    "workspace": lambda ax: plot.workspace(arms.planar_arm(), ax=ax, title="reach"),
    "workspace of one joint": lambda ax: plot.workspace(arms.planar_arm((0.5,)), ax=ax),
    "workspace of three": lambda ax: plot.workspace(arms.planar_arm((0.4, 0.3, 0.1)), ax=ax),
    "manipulability": lambda ax: plot.manipulability(arms.planar_arm(), [0.3, 0.8], ax=ax, title="rates"),
}
IN_SPACE = {"robot", "slide", "solutions", "frames"}


@pytest.mark.slow
@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_makes_its_figure_and_something_is_to_be_seen(name):
    artists = PICTURES[name](None)
    assert artists
    assert all(artist.figure is artists[0].figure for artist in artists)
    assert len(plt.get_fignums()) == 1, "one picture, one figure"
    assert 0.004 < share_of_ink(image_of(artists)) < 0.8


@pytest.mark.parametrize("name", PICTURES)
def test_the_axes_given_are_used(name):
    figure = plt.figure(figsize=(4, 4))
    ax = figure.add_subplot(projection="3d" if name in IN_SPACE else None)
    artists = PICTURES[name](ax)
    assert plt.get_fignums() == [figure.number], "no second figure"
    assert all(artist.axes is ax or artist.figure is figure for artist in artists)
    assert share_of_ink(image_of(artists)) > 0.004


@pytest.mark.parametrize("name", PICTURES)
def test_the_other_kind_of_axes_is_refused(name):
    ax = plt.figure().add_subplot(projection=None if name in IN_SPACE else "3d")
    if name.startswith("planar"):  # a planar arm may also be drawn in space
        assert PICTURES[name](ax)
    else:
        with pytest.raises(InputError, match="axes"):
            PICTURES[name](ax)


def test_two_robots_share_one_stage():
    first = plot.robot(arms.elbow_arm(), np.zeros(6))
    ax = first[0].axes
    before = image_of(first)
    view = ax.elev, ax.azim
    second = plot.robot(arms.elbow_arm(), np.full(6, 0.9), ax=ax)
    assert second[0] is first[0], "one artist draws all solids of an axes"
    assert (ax.elev, ax.azim) == view
    assert np.abs(image_of(second) - before).max() > 0.2


def test_the_picture_follows_the_view_and_can_be_hidden():
    artists = plot.robot(arms.elbow_arm(), np.full(6, 0.3))
    before = image_of(artists)
    artists[0].axes.view_init(elev=80, azim=20)
    assert np.abs(image_of(artists) - before).max() > 0.2
    artists[0].set_visible(False)
    assert share_of_ink(image_of(artists)) == 0.0


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_every_format_can_be_written(tmp_path, ending):
    path = tmp_path / f"arm.{ending}"
    plot.robot(arms.elbow_arm(), np.full(6, 0.3))[0].figure.savefig(path, dpi=50)
    assert path.stat().st_size > 2000


def test_the_nearest_solution_is_the_solid_one():
    q = np.array([[0.1] * 6, [0.5] * 6, [-0.4] * 6])
    near = q[1] + 2 * np.pi
    artists = plot.solutions(arms.elbow_arm(), q, near=near)
    scene = artists[0].scene
    ghosts = [group for group in scene.groups if group.opacity < 1]
    assert len(ghosts) == 2
    bold = [text.get_text() for text in artists[1].get_texts() if text.get_fontweight() == "bold"]
    assert bold == ["solution 2"]


def test_configurations_out_of_limits_are_grey_and_say_so():
    arm = cs.Robot.from_screws(
        [arms.Z, arms.Y, arms.Y], [[0, 0, 0.2], [0, 0, 0.4], [0.4, 0, 0.4]], arms.at(0.8, 0, 0.4),
        lower=[-1] * 3, upper=[1] * 3,
    )  # fmt: skip
    q = np.array([[0.1, 0.2, 0.3], [0.1, 2.0, 0.3], [0.1 - 2 * np.pi, 0.5, 0.3]])
    artists = plot.solutions(arm, q)
    solid, out, turned = (group.solids[-1].color for group in solutions_of(artists, 3))
    assert np.ptp(out) < 0.05 < min(np.ptp(solid), np.ptp(turned)), "a whole turn brings the last one inside"
    texts = [text.get_text() for text in artists[1].get_texts()]
    assert texts == ["solution 1", "solution 2 (out of limits)", "solution 3"]
    told = plot.solutions(arm, q, within=[True, True, False])
    assert [np.ptp(group.solids[-1].color) > 0.05 for group in solutions_of(told, 3)] == [True, True, False]
    with pytest.raises(InputError, match="one each"):
        plot.solutions(arm, q, within=[True])


def solutions_of(artists: list, count: int) -> list:
    """The groups of a picture of solutions, the solid one first."""
    groups = [group for group in artists[0].scene.groups if group.shadow][-count:]
    return [groups[-1], *groups[:-1]]


def lowest(solid) -> float:
    """The lowest height of a body, by the points of its surface."""
    angle = np.linspace(0, 2 * np.pi, 73)
    axis = (solid.b - solid.a) / max(np.linalg.norm(solid.b - solid.a), 1e-12)
    if solid.round:
        return min(solid.a[2] - solid.radius_a, solid.b[2] - solid.radius_b)
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    u /= np.linalg.norm(u)
    around = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * np.cross(axis, u)
    return min(
        (p + r * around)[:, 2].min() for p, r in ((solid.a, solid.radius_a), (solid.b, solid.radius_b))
    )


@pytest.mark.parametrize("name", ["irb120", "puma560", "ur5e", "puma560_dh", "panda"])
def test_nothing_hangs_below_the_floor(name):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(8)
    for _ in range(5):
        scene = plot.robot(robot, rng.uniform(-2, 2, robot.dof))[0].scene
        solids = [solid for group in scene.groups if group.shadow for solid in group.solids]
        assert min(map(lowest, solids)) > scene.floor.center[2] - 1e-9


def test_eight_configurations_are_drawn_in_a_second_or_two():
    robot = cs.load_robot("ur5e")
    T = cs.pose([0.4, 0.2, 0.4], rpy=[np.pi, 0, np.pi / 2])
    artists = plot.solutions(robot, robot.ik(T), T)
    start = time.process_time()
    image_of(artists, dpi=150)
    assert time.process_time() - start < 3.0


def test_legends_name_the_branches():
    artists = plot.solutions(arms.planar_arm(), [[0.2, 1.1], [1.15, -1.1]], labels=["elbow down", "elbow up"])
    legend = next(artist for artist in artists if hasattr(artist, "get_texts"))
    assert [text.get_text() for text in legend.get_texts()] == ["elbow down", "elbow up"]


def legend_of(artists):
    legend = next(artist for artist in artists if hasattr(artist, "get_texts"))
    return [text.get_text() for text in legend.get_texts()], legend


@pytest.mark.parametrize("name", ["panda", "iiwa14", "planar_3r"])
def test_configurations_of_one_branch_share_an_entry_of_the_legend_and_a_colour(name):
    robot = cs.load_robot(name)
    answer = robot.ik(robot.fk(np.full(robot.dof, 0.4)))
    names = plot.arms.branch_names(answer, np.ones(len(answer), bool))
    tints = plot.legends.tints_of(names, np.ones(len(answer), bool), 0)
    assert len({tuple(tint) for tint in tints}) == len(set(names))
    artists = plot.solutions(robot, answer, within=[True] * len(answer))
    texts, legend = legend_of(artists)
    assert len(texts) == len(set(names)) <= plot.legends.MOST_ENTRIES
    bold = [text.get_text() for text in legend.get_texts() if text.get_fontweight() == "bold"]
    assert len(bold) == 1
    assert bold[0].startswith(names[0])


@pytest.mark.slow
def test_a_legend_is_no_longer_than_its_picture():
    robot, q = arms.elbow_arm(), np.random.default_rng(2).uniform(-1, 1, (60, 6))
    texts, legend = legend_of(plot.solutions(robot, q))
    assert len(texts) == plot.legends.MOST_ENTRIES
    assert texts[-1] == "… and 37 more"
    figure = legend.figure
    figure.canvas.draw()
    box = legend.get_window_extent()
    assert box.y0 >= 0
    assert box.y1 <= figure.bbox.y1


@pytest.mark.slow
@pytest.mark.parametrize("lengths", [(1, 1), (1, 0.5, 0.4), (1, 0.5, 0.4, 0.3), (0.2, 1, 0.9, 0.5)])
def test_workspaces_have_no_holes_between_samples(lengths):
    robot = cs.Robot.from_dh([[0, length, 0, 0] for length in lengths], convention="standard")
    image = plot.workspace(robot)[0]
    shown = ~np.ma.getmaskarray(image.get_array())
    left, right, low, high = image.get_extent()
    rows, columns = shown.shape
    x = left + (np.arange(columns) + 0.5) * (right - left) / columns
    y = low + (np.arange(rows) + 0.5) * (high - low) / rows
    far = np.hypot(*np.meshgrid(x, y))
    reach, inner = sum(lengths), max(0, 2 * max(lengths) - sum(lengths))
    cell = (right - left) / columns
    assert not shown[(far > reach + 4 * cell) | (far < inner - 4 * cell)].any()
    assert shown[(far < 0.97 * reach) & (far > inner + 0.03 * reach)].all()


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda: plot.robot(arms.elbow_arm(), [0.0] * 5), "shape"),
        (lambda: plot.robot(arms.elbow_arm(), [np.nan] * 6), "finite"),
        (lambda: plot.robot(arms.elbow_arm(), np.zeros((2, 6))), "one configuration"),
        (lambda: plot.solutions(arms.elbow_arm(), np.zeros((0, 6))), "nothing to draw"),
        (lambda: plot.frames(np.zeros((4, 4))), "row"),
        (lambda: plot.frames(np.zeros((0, 4, 4))), "nothing to draw"),
        (lambda: plot.frames([np.eye(4)], names=["a", "b"]), "names"),
        (lambda: plot.workspace(arms.elbow_arm()), "not a planar arm"),
        (lambda: plot.manipulability(arms.scara(), np.zeros(4)), "not a planar arm"),
    ],
)
def test_bad_input_is_refused_without_a_figure(draw, message):
    with pytest.raises(InputError, match=message):
        draw()
    assert plt.get_fignums() == []


def test_a_missing_matplotlib_says_what_to_install(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'cspace\[plot\]'"):
        plot.robot(arms.elbow_arm(), np.zeros(6))


def test_the_workspace_ends_where_the_arm_is_stretched():
    artists = plot.workspace(arms.planar_arm((0.5, 0.4)))
    image = next(artist for artist in artists if hasattr(artist, "get_extent"))
    x0, x1, y0, y1 = image.get_extent()
    shown = ~np.ma.getmaskarray(image.get_array())
    rows, columns = np.nonzero(shown)
    x = x0 + (columns + 0.5) / shown.shape[1] * (x1 - x0)
    y = y0 + (rows + 0.5) / shown.shape[0] * (y1 - y0)
    reach = np.hypot(x, y)
    assert abs(reach.max() - 0.9) < 0.01
    assert abs(reach.min() - 0.1) < 0.01


def test_frames_are_drawn_where_the_poses_are():
    T = cs.pose([0.3, -0.2, 0.5], rpy=[0.3, 0.2, 0.1])
    solids = plot.frames([T], size=0.2)[0].scene.groups[0].solids
    tips = np.array([solid.b for solid in solids[1::2]])
    np.testing.assert_allclose(tips, T[:3, 3] + 0.2 * T[:3, :3].T, atol=1e-12)
