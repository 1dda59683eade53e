"""`cspace localize | slam | evaluate`: answers, files, pictures, exit codes."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cli.schema import check
from cspace.cli.exits import Exit
from data import ROOT

DRIVE = ROOT / "examples/small_drive"
GRAPH = ROOT / "examples/two_rounds.g2o"


@pytest.mark.parametrize("name", ["ekf", "iekf", "ukf", "information"])
def test_each_filter_localises(name):
    result = cspace(f"localize {DRIVE} --filter {name} --json")
    assert result.code == Exit.DONE
    check(result.json, "cspace.localize/1")
    assert result.json["rmse"] < 0.06


def test_poses_are_saved_and_evaluated(tmp_path):
    saved = tmp_path / "found.tum"
    result = cspace(f"localize {DRIVE} --smooth --json --save", saved)
    assert result.json["filter"] == "ekf, smoothed"
    errors = cspace(f"evaluate {saved} {DRIVE} --align none --interpolate --rpe 1 m --rpe 5 s --json").json
    check(errors, "cspace.evaluate/1")
    assert errors["ate"]["rmse"] == pytest.approx(result.json["rmse"], rel=1e-9)
    assert [each["unit"] for each in errors["rpe"]] == ["m", "s"]


def test_a_map_and_a_start_may_be_given(tmp_path):
    landmarks = tmp_path / "map.txt"
    landmarks.write_text("# name x y\n6 2 -1\n7 5 1.5\n8 2 4\n9 -1 1.5\n")
    line = f"localize {DRIVE} --map {landmarks} --start 0 0 0deg --json"
    assert cspace(line).json["status"] == "localised"
    landmarks.write_text("6 2\n")
    result = cspace(line)
    assert result.code == Exit.BAD_FILE
    assert f"{landmarks}:1: a map of landmarks has lines NAME X Y" in result.err


def test_a_lost_robot_ends_in_one(tmp_path):
    """Without any reading the poses are dead reckoning."""
    blind = tmp_path / "blind"
    shutil.copytree(DRIVE, blind)
    (blind / "Robot1_Measurement.dat").write_text("# nothing seen\n")
    result = cspace(f"localize {blind}")
    assert result.code == Exit.NEGATIVE
    assert "lost" in result.out


def test_particles_on_landmarks_find_the_robot():
    result = cspace(f"localize {DRIVE} --filter mcl --seed 7 --json")
    assert result.code in (Exit.DONE, Exit.NEGATIVE)
    check(result.json, "cspace.localize/1")


def test_pictures_of_a_drive(tmp_path):
    pytest.importorskip("matplotlib")
    plot, film = tmp_path / "run.png", tmp_path / "run.gif"
    result = cspace(f"localize {DRIVE} --plot {plot} --animate {film}")
    assert result.code == Exit.DONE
    assert f"wrote {plot}" in result.out
    assert min(plot.stat().st_size, film.stat().st_size) > 5000


def test_a_graph_is_optimized_and_saved_without_its_false_loop(tmp_path):
    saved = tmp_path / "optimum.g2o"
    result = cspace(f"slam {GRAPH} --robust dcs --json --save", saved)
    assert result.code == Exit.DONE
    check(result.json, "cspace.slam/1")
    assert [(each["first"], each["second"]) for each in result.json["rejected"]] == [(2, 9)]
    again = cs.PoseGraph.read(saved)
    np.testing.assert_allclose(again.poses, result.json["poses"], atol=1e-9)
    assert len(again.edges) == 27


def test_slam_of_landmarks(tmp_path):
    pytest.importorskip("matplotlib")
    saved, plot = tmp_path / "slam.tum", tmp_path / "slam.png"
    result = cspace(f"slam {DRIVE} --method ekf --json --save {saved} --plot {plot}")
    assert result.code == Exit.DONE
    check(result.json, "cspace.slam/1")
    assert result.json["rmse"] < 0.1
    assert len(result.json["landmarks"]) == 4
    assert cs.ate(saved, DRIVE).rmse < 0.1


@pytest.mark.parametrize(
    ("line", "code", "part"),
    [
        (f"evaluate {DRIVE} {DRIVE} --rpe 1 km", Exit.USAGE, "the unit must be m, s or frames"),
        (f"evaluate {DRIVE} {DRIVE} --rpe 1.5 frames", Exit.USAGE, "must be whole"),
        (f"evaluate {DRIVE} nowhere.tum", Exit.BAD_FILE, "nowhere.tum"),
        (f"evaluate {DRIVE} {DRIVE} --rpe 1e4 m", Exit.USAGE, "is shorter"),
        (f"localize {DRIVE} --robot 4", Exit.BAD_FILE, "no robot 4 in the folder"),
        (f"localize {DRIVE} --filter kalman", Exit.USAGE, "invalid choice: 'kalman'"),
        (f"localize {DRIVE} --animate run.png", Exit.USAGE, "does not end with .gif"),
        (f"localize {GRAPH}", Exit.BAD_FILE, "belongs to a pose graph"),
        (f"slam {DRIVE}", Exit.USAGE, "the log has no scans"),
        (f"slam {GRAPH} --method ekf", Exit.USAGE, "are for logs"),
        (f"slam {DRIVE} --robust dcs", Exit.USAGE, "is for pose graphs"),
        (f"slam {DRIVE} --method ekf --save x.g2o", Exit.USAGE, "has no pose graph"),
    ],
)
def test_what_goes_wrong_is_named(line, code, part):
    result = cspace(line)
    assert result.code == code
    assert part in result.err
