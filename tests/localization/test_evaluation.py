"""Absolute and relative errors of trajectories: laws, inputs of all kinds, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, LogError, UnknownNameError
from cspace.localization import TimedPoses, read_poses, write_poses
from localization.trajectories import planar_pair, spatial_pair


@pytest.mark.parametrize("seed", range(5))
def test_alignment_is_the_best_rigid_motion(seed):
    """No nearby motion gives a smaller error, and a rigid motion of the estimate changes nothing."""
    rng = np.random.default_rng(seed)
    truth, estimate = planar_pair(rng)
    best = cs.ate(estimate, truth)
    for _ in range(20):
        nudge = cs.exp_se2(1e-3 * rng.normal(size=3))
        moved = (nudge @ cs.pose_2d(xytheta=best.poses))[:, :2, 2]
        assert np.sqrt(np.mean(np.sum((moved - truth.poses[:, :2]) ** 2, axis=1))) >= best.rmse
    T = cs.random_pose_2d(rng=rng)
    turned = TimedPoses(estimate.times, cs.to_xytheta(T @ cs.pose_2d(xytheta=estimate.poses)))
    assert cs.ate(turned, truth).rmse == pytest.approx(best.rmse, rel=1e-9)
    np.testing.assert_allclose(cs.ate(turned, truth).alignment @ T, best.alignment, atol=1e-9)
    np.testing.assert_allclose(cs.rpe(turned, truth).errors, cs.rpe(estimate, truth).errors, atol=1e-9)


def test_a_moved_truth_has_no_error_after_alignment():
    rng = np.random.default_rng(1)
    truth, _ = planar_pair(rng)
    T = cs.random_pose_2d(rng=rng)
    moved = TimedPoses(truth.times, cs.to_xytheta(T @ cs.pose_2d(xytheta=truth.poses)))
    found = cs.ate(moved, truth)
    assert found.max < 1e-9
    assert found.turn_max < 1e-9
    np.testing.assert_allclose(found.alignment, np.linalg.inv(T), atol=1e-9)
    assert cs.ate(moved, truth, align=None).rmse > 0.1


def test_space_and_plane_agree_on_planar_poses():
    truth, estimate = planar_pair(np.random.default_rng(2))
    for measure in (cs.ate, cs.rpe):
        plane, space = measure(estimate, truth), measure(estimate, truth, align="se3")
        np.testing.assert_allclose(plane.errors, space.errors, atol=1e-9)
        np.testing.assert_allclose(plane.turns, space.turns, atol=1e-7)
    assert space.poses.shape[1:] == (4, 4)


@pytest.mark.parametrize("seed", range(3))
def test_alignment_in_space(seed):
    rng = np.random.default_rng(seed)
    truth, estimate = spatial_pair(rng)
    best = cs.ate(estimate, truth, align="se3")
    for _ in range(20):
        moved = cs.exp_se3(1e-3 * rng.normal(size=6)) @ best.poses
        apart = np.linalg.norm(moved[:, :3, 3] - truth.poses[:, :3, 3], axis=1)
        assert np.sqrt(np.mean(apart**2)) >= best.rmse
    assert np.linalg.det(best.alignment[:3, :3]) == pytest.approx(1.0)


def test_relative_errors_of_a_known_drift():
    """An estimate that overestimates every distance by a tenth is off by a tenth of each stretch."""
    truth = TimedPoses(np.arange(101.0), np.column_stack([0.25 * np.arange(101), np.zeros((101, 2))]))
    longer = TimedPoses(truth.times, truth.poses * [1.1, 1.0, 1.0])
    found = cs.rpe(longer, truth, delta=1.05)
    np.testing.assert_allclose(found.errors, 0.1, atol=1e-12)
    assert found.pairs[:3].tolist() == [[0, 4], [4, 8], [8, 12]]
    np.testing.assert_allclose(found.times[:2], [4.0, 8.0])
    assert cs.rpe(longer, truth, delta=10, unit="s").mean == pytest.approx(0.25)
    assert len(cs.rpe(longer, truth, delta=50, unit="frames")) == 2
    assert cs.rpe(longer, truth, delta=50, unit="frames").median == pytest.approx(1.25)


def test_headings_are_interpolated_the_short_way():
    """A robot that turns past 180° between two poses of a sparse truth."""
    truth = TimedPoses([0.0, 1.0, 2.0], [[0.0, 0, 3.0], [1.0, 0, -3.0], [1.0, 1, -3.0]])
    dense = TimedPoses(np.linspace(0, 2, 9), truth.at(np.linspace(0, 2, 9)))
    found = cs.ate(TimedPoses(dense.times, dense.poses), TimedPoses([0.5, 1.4], truth.at([0.5, 1.4])),
                   interpolate=True, align=None)  # fmt: skip
    np.testing.assert_allclose(found.errors, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.turns, 0.0, atol=1e-12)
    assert abs(abs(found.poses[0, 2]) - np.pi) < 1e-9


def test_nothing_is_interpolated_across_gaps():
    truth = TimedPoses([0.0, 1.0, 9.0, 10.0, 10.1], np.random.default_rng(0).normal(size=(5, 3)))
    sparse = TimedPoses([0.5, 5.0, 9.5], [[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    assert len(cs.ate(sparse, truth, interpolate=True)) == 3
    assert len(cs.ate(sparse, truth, interpolate=True, max_gap=2.0)) == 2


def test_poses_of_space_are_interpolated():
    rng = np.random.default_rng(4)
    truth, _ = spatial_pair(rng)
    middle = 0.5 * (truth.times[:-1] + truth.times[1:])
    halves = cs.interpolate_decoupled(truth.poses[:-1], truth.poses[1:], 0.5)
    sparse = type(truth)(middle[::2], np.asarray(halves)[::2])
    found = cs.ate(sparse, truth, interpolate=True, align="se3")
    assert found.max < 1e-9
    assert found.turn_max < 1e-7


def test_every_kind_of_trajectory_is_read(tmp_path):
    truth, estimate = planar_pair(np.random.default_rng(3))
    expected = cs.ate(estimate, truth).errors
    write_poses(tmp_path / "est.tum", estimate)
    write_poses(tmp_path / "true.tum", truth)
    write_poses(tmp_path / "est.kitti", estimate, format="kitti")
    log = cs.localization.Log(cs.localization.Odometry.from_poses(truth.times, truth.poses), truth=truth)
    pairs = [
        (tmp_path / "est.tum", str(tmp_path / "true.tum")),
        (tmp_path / "est.tum", log),
        (tmp_path / "est.kitti", truth),
        (estimate.poses, truth.poses),
        (estimate.poses, truth),
    ]
    for one, other in pairs:
        np.testing.assert_allclose(cs.ate(one, other).errors, expected, atol=1e-9)
    found = cs.ate(tmp_path / "est.tum", tmp_path / "true.tum", align="se3")
    np.testing.assert_allclose(found.errors, expected, atol=1e-9)
    graph = cs.PoseGraph(truth.poses, [(k, k + 1) for k in range(len(truth) - 1)],
                         np.zeros((len(truth) - 1, 3)), np.eye(3))  # fmt: skip
    assert cs.ate(graph, truth).max < 1e-9


def test_the_errors_show_themselves():
    truth, estimate = planar_pair(np.random.default_rng(3), n=40)
    assert "ate of 40 poses: rmse" in repr(cs.ate(estimate, truth))
    assert "rpe over 1 m of" in repr(cs.rpe(estimate, truth))
    found = cs.ate(estimate, truth)
    assert found.max >= found.rmse >= found.mean > 0
    assert found.median <= found.max
    assert found.turn_rmse <= found.turn_max
    assert len(found) == 40


@pytest.mark.parametrize("planar", [True, False])
def test_files_of_poses_come_back_as_they_were(tmp_path, planar):
    rng = np.random.default_rng(5)
    truth, _ = planar_pair(rng) if planar else spatial_pair(rng)
    write_poses(tmp_path / "a.tum", truth)
    write_poses(tmp_path / "a.kitti", truth, format="kitti")
    tum, kitti = read_poses(tmp_path / "a.tum"), read_poses(tmp_path / "a.kitti")
    np.testing.assert_array_equal(tum.times, truth.times)
    np.testing.assert_array_equal(kitti.times, np.arange(len(truth.times)))
    if planar:
        np.testing.assert_allclose(tum.poses, truth.poses, atol=1e-12)
        np.testing.assert_allclose(kitti.poses, truth.poses, atol=1e-12)
    else:
        np.testing.assert_allclose(tum.poses[:, :2], truth.poses[:, :2, 3], atol=1e-12)
        np.testing.assert_allclose(kitti.poses[:, :2], truth.poses[:, [0, 2], 3], atol=1e-12)


FEW = TimedPoses([0.0, 1.0, 2.0], [[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda: cs.ate(FEW, TimedPoses([10.0, 11.0], [[0.0, 0, 0], [1, 0, 0]])), "by one clock"),
        (lambda: cs.ate(FEW, TimedPoses([0.5, 1.5], [[0.0, 0, 0], [1, 0, 0]])), "interpolate=True"),
        (lambda: cs.ate(FEW, np.zeros((2, 3))), "the truth has no times, and there are 3 poses"),
        (lambda: cs.ate(FEW, TimedPoses([], np.zeros((0, 3)))), "truth has no poses"),
        (lambda: cs.ate(np.zeros((3, 3)), FEW), "at one place"),
        (lambda: cs.ate(np.eye(3) * [1, 0, 0], FEW, align="se3"), "on one line"),
        (lambda: cs.rpe(FEW, FEW, delta=5), "delta is 5 m, and the trajectory of 3 poses is shorter"),
        (lambda: cs.rpe(FEW.poses, FEW, delta=1, unit="s"), 'give unit="m"'),
        (lambda: cs.rpe(FEW, FEW, delta=-1), "delta is -1"),
        (lambda: cs.ate(FEW, FEW, max_difference=-1), "max_difference is -1"),
        (lambda: cs.ate(FEW.poses * np.nan, FEW), "must be finite"),
        (
            lambda: cs.ate(cs.localization.Log(cs.localization.Odometry([0.0], np.zeros((0, 3)))), FEW),
            "without reference",
        ),
    ],
)
def test_what_cannot_be_compared_is_named(call, part):
    with pytest.raises(InputError) as error:
        call()
    assert part in str(error.value)


def test_unknown_words_are_named():
    with pytest.raises(UnknownNameError, match="sim3"):
        cs.ate(FEW, FEW, align="sim3")
    with pytest.raises(UnknownNameError, match="no unit 'metres'"):
        cs.rpe(FEW, FEW, unit="metres")
    with pytest.raises(UnknownNameError, match="euroc"):
        write_poses("x", FEW, format="euroc")


def test_a_bad_file_of_poses_is_named(tmp_path):
    path = tmp_path / "p.txt"
    for text, part in [
        (
            "1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n",
            ":2: the first three columns",
        ),
        ("1 2 3\n", "neither 8 columns"),
        ("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1\n", ":2: the line has 11 columns"),
    ]:
        path.write_text(text)
        with pytest.raises(LogError) as error:
            read_poses(path)
        assert part in str(error.value)
