"""Errors of trajectories against evo, which runs in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.util import find_spec

import numpy as np
import pytest

import cspace as cs
from cspace.localization import TimedPoses, write_poses
from data import shared_data
from localization.trajectories import Spatial, planar_pair, spatial_pair

pytestmark = [
    pytest.mark.oracle,
    pytest.mark.skipif(find_spec("evo") is None, reason="evo is not installed: pip install evo==1.38.1"),
]

JUDGE = """
import json, sys
from evo.core import metrics, sync
from evo.core.sync_method import SyncMethod
from evo.tools import file_interface
estimate, truth, units, method = sys.argv[1:]
true, found = (file_interface.read_tum_trajectory_file(p) for p in (truth, estimate))
true, found = sync.associate_trajectories(true, found, sync_method=SyncMethod[method])
answers = {}
for delta, unit in json.loads(units):
    rpe = metrics.RPE(metrics.PoseRelation.translation_part, delta, metrics.Unit[unit])
    rpe.process_data((true, found))
    turn = metrics.RPE(metrics.PoseRelation.rotation_angle_rad, delta, metrics.Unit[unit])
    turn.process_data((true, found))
    answers[f"{delta} {unit}"] = [rpe.error.tolist(), turn.error.tolist()]
for name, is_aligned in (("none", False), ("aligned", True)):
    if is_aligned:
        found.align(true)
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((true, found))
    turn = metrics.APE(metrics.PoseRelation.rotation_angle_rad)
    turn.process_data((true, found))
    answers[name] = [ape.error.tolist(), turn.error.tolist(), ape.get_all_statistics()]
print("answers", json.dumps(answers))
"""

UNITS = [(1.0, "meters"), (5.0, "meters"), (1, "frames"), (7, "frames")]
OURS = {"meters": "m", "frames": "frames"}


def judge(tmp_path, estimate, truth, method="nearest_time"):
    """What evo says of two trajectories."""
    write_poses(tmp_path / "estimate", estimate)
    write_poses(tmp_path / "truth", truth)
    call = [sys.executable, "-c", JUDGE, "estimate", "truth", json.dumps(UNITS), method]
    done = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.rsplit("answers", 1)[1])


def check(tmp_path, estimate, truth, align, **options):
    """Our errors are those of evo to 1e-9."""
    found = judge(tmp_path, estimate, truth, "interpolation" if options else "nearest_time")
    for key, how in (("none", None), ("aligned", align)):
        ours = cs.ate(estimate, truth, align=how, **options)
        np.testing.assert_allclose(ours.errors, found[key][0], atol=1e-9)
        np.testing.assert_allclose(ours.turns, found[key][1], atol=1e-7)  # evo takes an arc cosine
        for name in ("rmse", "mean", "median", "max"):
            assert getattr(ours, name) == pytest.approx(found[key][2][name], abs=1e-9)
    for delta, unit in UNITS:
        ours = cs.rpe(estimate, truth, delta=delta, unit=OURS[unit], align=align, **options)
        np.testing.assert_allclose(ours.errors, found[f"{delta} {unit}"][0], atol=1e-9)
        np.testing.assert_allclose(ours.turns, found[f"{delta} {unit}"][1], atol=1e-7)


@pytest.mark.parametrize("seed", range(3))
def test_planar_trajectories(tmp_path, seed):
    truth, estimate = planar_pair(np.random.default_rng(seed))
    check(tmp_path, estimate, truth, "se2")


@pytest.mark.parametrize("seed", range(3))
def test_trajectories_of_space(tmp_path, seed):
    truth, estimate = spatial_pair(np.random.default_rng(seed))
    check(tmp_path, estimate, truth, "se3")


@pytest.mark.parametrize("is_truth_sparse", [True, False])
def test_association_of_different_clocks(tmp_path, is_truth_sparse):
    """Jittered stamps, some within 0.01 s, some not; either side may have fewer poses."""
    rng = np.random.default_rng(7)
    truth, estimate = planar_pair(rng, n=400, times=np.arange(400) * 0.05)
    kept = np.sort(rng.choice(400, 150, replace=False))
    jitter = np.sort(kept * 0.05 + rng.uniform(-0.02, 0.02, 150))
    if is_truth_sparse:
        truth = TimedPoses(jitter, truth.poses[kept])
    else:
        estimate = TimedPoses(jitter, estimate.poses[kept])
    assert 20 < len(cs.ate(estimate, truth)) < 150
    check(tmp_path, estimate, truth, "se2")


@pytest.mark.parametrize("is_planar", [True, False])
def test_interpolation(tmp_path, is_planar):
    """Times between those of a dense truth; evo looks for a pose within 0.01 s first, and there is one."""
    rng = np.random.default_rng(8)
    truth, estimate = planar_pair(rng) if is_planar else spatial_pair(rng)
    times = np.arange(len(truth.times)) * 0.015
    kept = np.arange(5, 150, 3)
    make = TimedPoses if is_planar else Spatial
    sparse = make(times[kept] + rng.uniform(-0.007, 0.007, len(kept)), estimate.poses[kept])
    check(tmp_path, sparse, make(times, truth.poses), "se2" if is_planar else "se3", interpolate=True)


@pytest.mark.data
@pytest.mark.parametrize("name", ["intel", "freiburg-079"])
def test_real_logs(tmp_path, name):
    log = cs.read_log(shared_data() / f"localization/carmen/{name}-corrected.log.gz")
    check(tmp_path, log.odometry.dead_reckoning(log.truth.poses[0]), log.truth, "se2")
