"""Laws of scan matching: equal to brute force, turned problems have turned answers, the truth is found, and
what is ambiguous or does not overlap is said to be so."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.maps import ByteField


def points_of(rng, count=60, reach=3.0):
    """Points on two walls of a corner, in the order of the beams."""
    t = np.sort(rng.uniform(-1, 1, count))
    corner = np.where(
        (t < 0)[:, None], np.stack([1.5 + 0 * t, reach * t], -1), np.stack([1.5 - reach * t, 0 * t + 0.4], -1)
    )
    return corner + rng.normal(0, 0.01, (count, 2))


def place(pose, points):
    T = cs.pose_2d(xytheta=pose)
    return points @ T[:2, :2].T + T[:2, 2]


def brute(field, points, guess, reach, step, turns):
    """The best score, by looking every cell up for every translation and rotation."""
    shifts = round(reach / field.resolution)
    padded = np.pad(field.scores.astype(int), 400, constant_values=field.outside)
    best = -1
    for angle in np.arange(-turns, turns + 1) * step:
        p = place([guess[0], guess[1], guess[2] + angle], points)
        cell = np.floor((p - field.origin) / field.resolution).astype(int) + 400
        for dy in range(-shifts, shifts + 1):
            for dx in range(-shifts, shifts + 1):
                best = max(best, padded[cell[:, 1] + dy, cell[:, 0] + dx].sum())
    return best / (255 * len(points))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("reach", "turn"), [(0.3, 0.05), (0.4, 0.4)])
def test_the_search_is_exhaustive(seed, reach, turn):
    rng = np.random.default_rng(seed)
    points = rng.uniform(-2.5, 2.5, (20, 2))
    field = ByteField(rng.integers(0, 256, (70, 90)).astype(np.uint8), 0.05, rng.uniform(-3, -1, 2), 7)
    guess = rng.uniform(-0.5, 0.5, 3)
    found, _, pose, _, score, _ = cs._core.match_points(
        field.scores, 0.05, field.origin, 7, points, guess, reach, turn, False
    )
    spread = np.sqrt((points**2).sum(axis=1).mean())
    step = np.clip(0.05 / spread, 0.004, 0.0175)
    assert found
    assert score == pytest.approx(
        brute(field, points, guess, reach, step, int(np.ceil(turn / step))), abs=1e-12
    )
    cell = np.floor((place(pose.ravel(), points) - field.origin) / 0.05).astype(int)
    inside = (cell >= 0).all(axis=1) & (cell[:, 0] < 90) & (cell[:, 1] < 70)
    at = np.where(inside, field.scores[np.where(inside, cell[:, 1], 0), np.where(inside, cell[:, 0], 0)], 7)
    assert at.sum() / (255 * 20) == pytest.approx(score, abs=0.06)  # rounding moves points between cells


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_large_windows_are_searched_as_exactly_as_small_ones(seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(-2, 2, (12, 2))
    field = ByteField((rng.random((80, 80)) < 0.05).astype(np.uint8) * 255, 0.05, np.array([-2.0, -2.0]))
    found, _, _, _, score, second = cs._core.match_points(
        field.scores, 0.05, field.origin, 0, points, np.zeros(3), 1.0, 3.1, False
    )
    step = np.clip(0.05 / np.sqrt((points**2).sum(axis=1).mean()), 0.004, 0.0175)
    assert found
    assert second <= score
    assert score == pytest.approx(brute(field, points, np.zeros(3), 1.0, step, int(np.ceil(3.1 / step))))


@pytest.mark.parametrize("quarter", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_turned_problems_have_turned_answers(seed, quarter):
    rng = np.random.default_rng(seed)
    points = points_of(rng)
    field = ByteField(rng.integers(0, 256, (60, 80)).astype(np.uint8), 0.05, np.array([-1.0, -2.0]))
    guess = np.array([*rng.uniform(-0.3, 0.3, 2), rng.uniform(-3, 3)])
    first = cs.match_scan(points, field, guess=guess, least_score=0.0)
    scores, (x, y), (rows, columns) = field.scores, field.origin, field.scores.shape
    turned_guess = guess.copy()
    for _ in range(quarter):
        scores, x, y, rows, columns = np.rot90(scores, -1), -(y + rows * 0.05), x, columns, rows
        turned_guess = np.array([-turned_guess[1], turned_guess[0], turned_guess[2] + np.pi / 2])
    turned = ByteField(np.ascontiguousarray(scores), 0.05, np.array([x, y]))
    second = cs.match_scan(points, turned, guess=turned_guess, least_score=0.0)
    T = cs.pose_2d(xytheta=[0, 0, quarter * np.pi / 2]) @ cs.pose_2d(xytheta=first.pose)
    assert np.allclose(cs.pose_2d(xytheta=second.pose), T, atol=1e-9)
    assert second.score == pytest.approx(first.score, abs=1e-12)
    assert second.second == first.second
    assert np.allclose(second.covariance, first.covariance, atol=1e-12)


@pytest.mark.parametrize("method", ["correlation", "icp"])
@pytest.mark.parametrize("seed", range(8))
def test_the_motion_between_two_scans_is_found(seed, method):
    rng = np.random.default_rng(seed)
    world = points_of(rng, 400)
    reach = 1.0 if method == "correlation" else 0.15
    truth = rng.uniform(-reach, reach, 3) * [0.7, 0.7, 0.2]
    scan = place(cs.to_xytheta(np.linalg.inv(cs.pose_2d(xytheta=truth))), points_of(rng, 150))
    found = cs.match_scan(scan, world, method=method, window=(0.8, 0.26))
    assert found, found.reason
    assert np.hypot(*(found.pose - truth)[:2]) < 0.02
    assert abs(found.pose[2] - truth[2]) < 0.01
    assert (np.linalg.eigvalsh(found.covariance) > 0).all()


def test_the_covariance_of_a_corridor_is_long():
    x = np.linspace(-3, 3, 200)
    walls = np.concatenate([np.stack([x, 0 * x + 1], -1), np.stack([x, 0 * x - 1], -1)])
    found = cs.match_scan(walls[::3] * [0.5, 1], walls, guess=(0.1, 0.05, 0.02))
    deviations = np.sqrt(np.diag(found.covariance))
    assert deviations[0] > 5 * deviations[1]


def test_two_equal_places_are_ambiguous():
    rng = np.random.default_rng(1)
    scan = points_of(rng, 80, 0.5)
    twice = np.concatenate([scan + np.array([0.6, 0.0]), scan - np.array([0.6, 0.0])])
    found = cs.match_scan(scan, twice)
    assert not found
    assert found.status == "ambiguous"
    assert found.second > 0.95 * found.score
    assert cs.match_scan(scan, twice, guess=(0.6, 0, 0), window=(0.3, 0.1))


def test_far_scans_do_not_overlap():
    scan = points_of(np.random.default_rng(2))
    found = cs.match_scan(scan, scan + 50.0)
    assert not found
    assert found.status == "no overlap"
    assert found.score < 0.3
    assert cs.match_scan(scan, scan + 50.0, method="icp").status == "not converged"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"scan": np.zeros((0, 2))}, "no points"),
        ({"scan": [[np.nan, 0.0]]}, "scan"),
        ({"window": (0.0, 0.1)}, "window"),
        ({"window": (1.0, 4.0)}, "3.14"),
        ({"window": (1e9, 1.0)}, "window"),
        ({"method": "ipc"}, "icp"),
        ({"guess": [0, 0]}, "guess"),
        ({"sigma": -1}, "sigma"),
        ({"field": [[0.0, 0.0], [1e7, 1e7]]}, "far"),
    ],
)
def test_bad_input_is_named(arguments, words):
    given = {"scan": [[1.0, 0.0], [0.0, 1.0]], "field": [[1.0, 0.0], [0.0, 1.0]], **arguments}
    with pytest.raises(cs.CspaceError, match=words):
        cs.match_scan(given.pop("scan"), given.pop("field"), **given)


def test_icp_needs_points():
    field = ByteField(np.ones((3, 3), np.uint8), 0.1, np.zeros(2))
    with pytest.raises(cs.CspaceError, match="another scan"):
        cs.match_scan([[1.0, 0.0]], field, method="icp")


@pytest.mark.parametrize("window", [(100.0, 3.0), (100.0, 0.5), (60.0, 3.1), (30.0, 3.1)])
def test_windows_of_too_many_poses_are_refused(window):
    """Their places exceed 32 bits, which had ended in a crash."""
    points = np.random.default_rng(0).uniform(-3, 3, (60, 2))
    with pytest.raises(InputError, match="search_pose"):
        cs.match_scan(points, points, window=window, resolution=0.02)
