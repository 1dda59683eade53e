"""Answers of localisation and SLAM can be copied and pickled; filters that run refuse both by name."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputTypeError
from cspace.localization import EkfSlam, FastSlam, HistogramFilter, simulate
from data import ROOT

LOG = cs.read_log(ROOT / "examples/small_drive")
BLOCKED = np.zeros((40, 60), dtype=bool)
BLOCKED[[0, -1]] = BLOCKED[:, [0, -1]] = BLOCKED[10:20, 20:30] = True
GRID = cs.OccupancyGrid(BLOCKED, 0.1)
RUN = cs.navigation.follow([(0.5, 0.5), (4, 0.5), (4, 3)], vehicle=cs.Unicycle(), world=GRID)
SEEN = simulate(RUN, GRID, cs.LaserScanner(most_range=6.0, readings=61), rng=1)
GRAPH = cs.PoseGraph.read(ROOT / "examples/two_rounds.g2o")
FOUND = cs.localize(LOG)
COPIES = [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))]

ANSWERS = {
    "log": LOG,
    "filter": FOUND,
    "smoother": FOUND.smoothed(),
    "mcl": cs.localize(SEEN, GRID, filter="mcl", rng=1),
    "histogram": cs.localize(SEEN, GRID, filter="histogram"),
    "graph": GRAPH,
    "optimum": GRAPH.optimize(robust="dcs"),
    "certificate": GRAPH.optimize().certificate(),
    "slam": cs.slam(SEEN),
    "ekf": cs.slam(LOG, method="ekf"),
    "fastslam": cs.slam(LOG, method="fastslam", rng=1),
    "errors": cs.ate(FOUND, LOG.truth),
    "match": cs.match_scan(SEEN.scans[0], SEEN.scans[1]),
    "calibration": cs.mobile.calibrate(LOG.odometry, LOG.truth, window=0.5),
}


@pytest.mark.parametrize("name", ANSWERS)
@pytest.mark.parametrize("make", COPIES, ids=["copy", "deepcopy", "pickle"])
def test_answers_are_copied(name, make):
    made = make(ANSWERS[name])
    assert repr(made) == repr(ANSWERS[name])
    if hasattr(made, "poses"):
        assert (made.poses == ANSWERS[name].poses).all()


@pytest.mark.parametrize("options", [{}, {"robust": "dcs"}, {"kernel": "huber"}, {"robust": "gnc"}])
@pytest.mark.parametrize("make", COPIES, ids=["copy", "deepcopy", "pickle"])
def test_a_copied_optimum_has_the_same_covariances_and_certificate(options, make):
    answer = GRAPH.optimize(**options)
    made = make(answer)
    for one, other in ((made.marginals, answer.marginals), (made.covariance(3, 7), answer.covariance(3, 7))):
        assert np.abs(one - other).max() < 1e-4 * np.abs(other).max()  # of states one last step apart
    assert made.certificate().certified == answer.certificate().certified


RUNNING = {
    "ParticleFilter": lambda: cs.ParticleFilter(GRID, rng=1),
    "HistogramFilter": lambda: HistogramFilter(GRID),
    "EkfSlam": EkfSlam,
    "FastSlam": FastSlam,
    "IncrementalGraph": lambda: cs.IncrementalGraph([0, 0, 0]),
}


@pytest.mark.parametrize("name", RUNNING)
@pytest.mark.parametrize("make", COPIES, ids=["copy", "deepcopy", "pickle"])
def test_what_runs_is_not_copied_in_part(name, make):
    with pytest.raises(InputTypeError, match=f"an? {name} is neither copied nor pickled; keep"):
        make(RUNNING[name]())
