"""Curves for cars: they meet their goals, no numerical search beats them, and no steering disproves them."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from oracles import car_words

nav = cs.navigation
SHORTEST = {"dubins": nav.dubins, "reeds_shepp": nav.reeds_shepp}
DISTANCE = {"dubins": nav.dubins_distance, "reeds_shepp": nav.reeds_shepp_distance}


def random_poses(rng, n, size=4.0):
    return rng.uniform(-1, 1, (n, 3)) * [size, size, np.pi]


def turned(a, b):
    """Whether headings agree up to whole turns."""
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi)


def reintegrated(curve):
    """The end of a curve, from its segments alone."""
    pose = np.array([*curve.start[:2] / curve.radius, curve.start[2]])
    for s in curve.segments:
        pose = car_words.drive(pose, round(s.curvature * curve.radius), s.direction * s.length / curve.radius)
    return np.array([*pose[:2] * curve.radius, pose[2]])


@pytest.mark.parametrize("name", SHORTEST)
def test_segments_lead_to_the_goal(name):
    rng = np.random.default_rng(1)
    for start, goal in zip(random_poses(rng, 500), random_poses(rng, 500), strict=True):
        radius = rng.uniform(0.2, 3)
        curve = SHORTEST[name](start, goal, radius)
        end = reintegrated(curve)
        np.testing.assert_allclose(end[:2], goal[:2], atol=1e-12)
        assert turned(end[2], goal[2]) < 1e-12
        assert curve.length == pytest.approx(sum(s.length for s in curve.segments), abs=1e-12)
        assert curve.length == pytest.approx(DISTANCE[name](start, goal, radius), abs=1e-12)


@pytest.mark.slow
def test_no_search_over_words_is_shorter_than_dubins():
    rng = np.random.default_rng(2)
    for goal in random_poses(rng, 12, size=3.0):
        assert nav.dubins_distance(np.zeros(3), goal, 1.0) == pytest.approx(
            car_words.dubins(goal, rng), abs=1e-8
        )


@pytest.mark.slow
def test_no_word_of_three_segments_is_shorter_than_reeds_shepp():
    rng = np.random.default_rng(3)
    equal = 0
    for goal in random_poses(rng, 12, size=3.0):
        curve = nav.reeds_shepp(np.zeros(3), goal, 1.0)
        searched = car_words.reeds_shepp(goal, rng)
        assert curve.length <= searched + 1e-8
        if len(curve.segments) <= 3:
            assert curve.length == pytest.approx(searched, abs=1e-8)
            equal += 1
    assert equal


@pytest.mark.parametrize("name", SHORTEST)
def test_no_steering_comes_nearer_faster_than_it_drives(name):
    """Any admissible motion is made of short pieces, so that this proves that nothing shorter exists."""
    rng = np.random.default_rng(4)
    n = 100_000
    starts, goals = random_poses(rng, n), random_poses(rng, n)
    here = DISTANCE[name](starts, goals, 1.0)
    for turn in (1, 0, -1):
        for sign in (1, -1) if name == "reeds_shepp" else (1,):
            step = np.exp(rng.uniform(-7, 1, n))
            there = DISTANCE[name](car_words.drive(starts, turn, sign * step), goals, 1.0)
            assert (here - there - step).max() < 3e-7


def test_reeds_shepp_is_a_metric_below_dubins():
    rng = np.random.default_rng(5)
    a, b, c = (random_poses(rng, 20_000) for _ in range(3))
    d = nav.reeds_shepp_distance
    np.testing.assert_allclose(d(a, b, 1.0), d(b, a, 1.0), atol=1e-7)
    assert (d(a, c, 1.0) - d(a, b, 1.0) - d(b, c, 1.0)).max() < 1e-7
    assert (d(a, b, 1.0) - nav.dubins_distance(a, b, 1.0)).max() < 1e-12
    assert (np.hypot(*(a - b)[:, :2].T) - d(a, b, 1.0)).max() < 1e-12


@pytest.mark.parametrize("name", SHORTEST)
def test_lengths_do_not_depend_on_the_frame_and_scale_with_the_radius(name):
    rng = np.random.default_rng(6)
    a, b = random_poses(rng, 2000), random_poses(rng, 2000)
    d = DISTANCE[name](a, b, 1.0)
    angle = 0.7
    R = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    moved = [p @ R.T + [3.0, -2.0, angle] for p in (a, b)]
    np.testing.assert_allclose(DISTANCE[name](*moved, 1.0), d, atol=1e-7)
    np.testing.assert_allclose(DISTANCE[name](a * [2.5, 2.5, 1], b * [2.5, 2.5, 1], 2.5), 2.5 * d, atol=1e-7)


WORDS = [
    ("dubins", (0, 0, 0), (0, 0, 0), "", 0.0),
    ("dubins", (0, 0, 0), (5, 0, 0), "S+", 5.0),
    ("dubins", (0, 0, 0), (0, 2, np.pi), "L+", np.pi),
    ("dubins", (0, 0, 0), (0, 2, -np.pi), "L+", np.pi),
    ("dubins", (0, 0, 0), (0, -2, 3 * np.pi), "R+", np.pi),
    ("dubins", (0, 0, np.pi), (-5, 0, -np.pi), "S+", 5.0),
    ("dubins", (0, 0, 0), (2, 2, 0), "L+R+", np.pi),
    ("dubins", (0, 0, 0), (0, 4, 0), "L+R+", 2 * np.pi),
    ("dubins", (0, 0, 0), (-1, 0, 0), None, 2 * np.pi + 1),
    ("reeds_shepp", (0, 0, 0), (0, 0, 0), "", 0.0),
    ("reeds_shepp", (0, 0, 0), (-5, 0, 0), "S−", 5.0),
    ("reeds_shepp", (0, 0, 0), (0, 2, np.pi), "L+", np.pi),
    ("reeds_shepp", (0, 0, 0), (0, 0, np.pi), None, np.pi),
    ("reeds_shepp", (0, 0, 0), (2, 2, 0), "L+R+", np.pi),
]


@pytest.mark.parametrize(("name", "start", "goal", "word", "length"), WORDS)
def test_special_places(name, start, goal, word, length):
    curve = SHORTEST[name](start, goal, 1.0)
    assert curve.length == pytest.approx(length, abs=1e-12)
    if word is not None:
        assert curve.word == word


@pytest.mark.parametrize("name", SHORTEST)
def test_circles_that_touch(name):
    """Circles of start and goal exactly two and four radii apart, where words begin and end to exist."""
    for way in (2.0, 4.0):
        for angle in np.linspace(-np.pi, np.pi, 33):
            for theta in np.linspace(-np.pi, np.pi, 17):
                circle = np.array([way * np.cos(angle), 1 + way * np.sin(angle)])
                goal = np.array([circle[0] + np.sin(theta), circle[1] - np.cos(theta), theta])
                curve = SHORTEST[name](np.zeros(3), goal, 1.0)
                np.testing.assert_allclose(reintegrated(curve)[:2], goal[:2], atol=1e-12)
                beside = DISTANCE[name](np.zeros(3), goal + np.array([1e-13, 0, 0]), 1.0)
                if name == "reeds_shepp":
                    assert curve.length == pytest.approx(beside, abs=1e-5)


def test_whole_turns_of_rounding_are_no_turns():
    """A goal driven to by the car is no farther than it drove, whatever the rounding does."""
    rng = np.random.default_rng(7)
    for _ in range(2000):
        start = random_poses(rng, 1, size=100.0)[0]
        for turn in (1, 0, -1):
            way = rng.uniform(0, 6)
            goal = car_words.drive(start, turn, way)
            assert nav.dubins_distance(start, goal, 1.0) <= way + 1e-6


def test_poses_along_a_curve_are_driven_at_its_curvature():
    rng = np.random.default_rng(8)
    for goal in random_poses(rng, 50):
        for make in SHORTEST.values():
            curve = make(np.zeros(3), goal, 0.8)
            poses = curve.sample(0.05)
            np.testing.assert_allclose(poses[0], 0, atol=1e-15)
            np.testing.assert_allclose(poses[-1][:2], goal[:2], atol=1e-12)
            steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
            assert steps.max() <= 0.05 + 1e-12
            assert np.abs(np.diff(poses[:, 2])).max() <= 0.05 / 0.8 + 1e-9
            assert ((curve.cusps > 0) & (curve.cusps < curve.length)).all()
            middle = curve.at(curve.length / 2)
            assert middle.shape == (3,)
            left = make(np.zeros(3), middle, 0.8).length
            assert left <= curve.length / 2 + 1e-6


def test_what_a_curve_says():
    curve = nav.reeds_shepp((0, 0, 0), (0, 1, 0), 1.0)
    assert curve.word.count("−")
    assert len(curve.cusps)
    assert repr(curve).startswith("<Curve ")
    s = curve.segments[0]
    assert (s.kind, abs(s.curvature)) in {("left", 1.0), ("right", 1.0)}
    assert s.direction in (1, -1)
    with pytest.raises(InputError, match="s holds"):
        curve.at(curve.length + 1)
    with pytest.raises(InputError, match="spacing"):
        curve.sample(0.0)


@pytest.mark.parametrize("name", SHORTEST)
def test_what_is_no_question_is_refused(name):
    with pytest.raises(InputError, match="radius"):
        SHORTEST[name]((0, 0, 0), (1, 1, 0), 0.0)
    with pytest.raises(InputError, match="goal has shape"):
        SHORTEST[name]((0, 0, 0), (1, 1), 1.0)
    with pytest.raises(InputError, match="start has shape"):
        SHORTEST[name](np.zeros((2, 3)), (1, 1, 1), 1.0)
    with pytest.raises(InputError, match="finite"):
        SHORTEST[name]((0, 0, np.nan), (1, 1, 1), 1.0)
    with pytest.raises(InputTypeError):
        SHORTEST[name]("here", (1, 1, 1), 1.0)
    with pytest.raises(InputError, match="leading axes"):
        DISTANCE[name](np.zeros((2, 3)), np.zeros((3, 3)), 1.0)
    assert DISTANCE[name](np.zeros((4, 1, 3)), np.zeros((5, 3)), 1.0).shape == (4, 5)


def test_a_word_is_one_of_the_48_of_reeds_and_shepp():
    """Turns alternate with at most two changes of direction, and no straight segment beside one (Reeds and
    Shepp 1990, theorem 1), whatever the goal."""
    rng = np.random.default_rng(9)
    for goal in np.concatenate([random_poses(rng, 1500, size=s) for s in (0.3, 2.0, 6.0)]):
        curve = nav.reeds_shepp(np.zeros(3), goal, 1.0)
        letters, signs = curve.word[::2], curve.word[1::2]
        assert all(
            a != b or s != t for a, b, s, t in zip(letters, letters[1:], signs, signs[1:], strict=False)
        )
        assert len(curve.cusps) <= 2
        assert letters.count("S") <= 1
        at = letters.find("S")
        if at >= 0:  # the car shifts gears between two arcs alone
            assert len(set(signs[max(at - 1, 0) : at + 2])) == 1
        assert all(s.length <= np.pi + 1e-9 for s in curve.segments if s.kind != "straight")


def test_the_poses_of_a_curve_are_its_own():
    start = np.zeros(3)
    curve = nav.dubins(start, (1, 2, 3), 1)
    start[:] = 7
    np.testing.assert_array_equal(curve.start, 0)
    assert nav.dubins([0, 0, 0], [1, 2, 3], 1).length == curve.length
    assert nav.dubins_distance((0, 0, 0), (1, 2, 3), 1) == curve.length
