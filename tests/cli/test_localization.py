"""`cspace localize | slam | evaluate`: answers, files, pictures, exit codes."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cli.schema import check
from cspace.cli.exits import Exit
from cspace.localization import simulate
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


def write_room(folder):
    """A ROS map of a room in unknown space, and a log of its laser, as a folder of files; the frame of the
    map is turned and shifted against that of the reference poses."""
    blocked = np.zeros((60, 90), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = blocked[20:30, 40:55] = blocked[:12, 70:74] = True
    room = cs.OccupancyGrid(blocked, 0.1, (-1.0, -2.0))
    run = cs.navigation.follow([(0, 0), (6, 0), (6.5, 2.5), (0.5, 3)], vehicle=cs.Unicycle(), world=room)
    log = simulate(run, room, cs.LaserScanner(most_range=9.0), period=0.4, rng=3)
    cells = np.pad(np.where(blocked, 1.0, 0.0), 25, constant_values=np.nan)
    cs.maps.EvidenceGrid.from_probability(cells, 0.1, (-3.5, -4.5)).save_ros(folder / "room.yaml")
    lines = []
    for time, pose in zip(log.odometry.times, log.odometry.dead_reckoning().poses, strict=True):
        lines.append((time, "ODOM {:.6f} {:.6f} {:.6f} 0 0 0 {t:.4f} nohost {t:.4f}".format(*pose, t=time)))
    for k, time in enumerate(log.scans.times):
        ranges = " ".join(f"{r:.3f}" for r in np.nan_to_num(log.scans.ranges[k], nan=81.0, posinf=81.0))
        pose = "{:.6f} {:.6f} {:.6f}".format(*log.truth.at(time))
        head = f"ROBOTLASER1 0 {log.scans.angles[0]:.6f} {np.ptp(log.scans.angles):.6f} "
        head += f"{log.scans.angles[1] - log.scans.angles[0]:.6f} 80 0.01 0 {len(log.scans.angles)} "
        tail = f" 0 {pose} {pose} 0 0 0 0 0 {time:.4f} nohost {time:.4f}"
        lines.append((time, head + ranges + tail))
    (folder / "drive.log").write_text("\n".join(text for _, text in sorted(lines)) + "\n")
    return log


@pytest.mark.parametrize("name", ["mcl", "histogram"])
def test_unknown_cells_of_a_ros_map_are_no_walls(tmp_path, name):
    """A map of SLAM is mostly unknown: were that solid, every scan would fit there."""
    log = write_room(tmp_path)
    saved = tmp_path / "found.tum"
    line = f"localize {tmp_path / 'drive.log'} --map {tmp_path / 'room.yaml'} --filter {name} --json"
    seed = "--seed 5" if name == "mcl" else ""
    result = cspace(f"{line} {seed} --save", saved)
    assert result.code == Exit.DONE, result.out
    assert np.hypot(*(cs.localization.read_poses(saved).poses[-1] - log.truth.poses[-1])[:2]) < 0.2


def test_the_map_of_slam_is_saved_and_localises_in_its_own_frame(tmp_path):
    pytest.importorskip("matplotlib")
    log = write_room(tmp_path)
    drive, saved, found = (tmp_path / name for name in ("drive.log", "made.yaml", "found.tum"))
    made = cspace(f"slam {drive} --json --save-map {saved} --plot {tmp_path / 'slam.png'}")
    assert made.code == Exit.DONE
    assert str(saved) in made.json["written"]
    assert cs.maps.EvidenceGrid.from_ros(saved).known.any()
    line = f"localize {drive} --map {saved} --filter mcl --seed 5 --start 0 0 0"
    assert cspace(f"{line} --save {found} --plot {tmp_path / 'run.png'}").code == Exit.DONE
    assert cs.ate(cs.localization.read_poses(found), log.truth, interpolate=True).rmse < 0.1


def test_errors_on_a_map_with_another_frame_are_those_after_alignment(tmp_path):
    moved = cs.pose_2d(xytheta=[3.0, -1.0, 2.0])
    log = cs.read_log(DRIVE)
    known, first = log.landmarks, log.truth.at(log.odometry.times[0])
    points = known.points @ moved[:2, :2].T + moved[:2, 2]
    for name, there in (("here.txt", known.points), ("map.txt", points)):
        np.savetxt(tmp_path / name, np.column_stack([known.names, there]), fmt=("%d", "%.9f", "%.9f"))
    start = cs.to_xytheta(moved @ cs.pose_2d(xytheta=first))
    line = f"localize {DRIVE} --map {tmp_path / 'map.txt'} --start {start[0]} {start[1]} {start[2]}"
    here = cspace(f"localize {DRIVE} --map {tmp_path / 'here.txt'} --align se2 --json").json["rmse"]
    assert cspace(f"{line} --align se2 --json").json["rmse"] == pytest.approx(here, rel=1e-6)
    assert "with --align se2: map and truth have other frames" in cspace(line).out


def test_a_folder_of_several_robots_is_evaluated_with_the_one_that_is_named(tmp_path):
    two = tmp_path / "two"
    shutil.copytree(DRIVE, two)
    for kind in ("Odometry", "Measurement", "Groundtruth"):
        shutil.copy(two / f"Robot1_{kind}.dat", two / f"Robot2_{kind}.dat")
    assert cspace(f"evaluate {two} {two} --robot 2 --json").json["ate"]["max"] == 0.0
    refused = cspace(f"evaluate {two} {two}")
    assert refused.code == Exit.USAGE
    assert "holds robots 1, 2; say which one" in refused.err


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


def test_slam_begins_at_the_pose_that_is_given():
    result = cspace(f"slam {DRIVE} --method ekf --json --start 3 -2 90 --deg")
    assert result.code == Exit.DONE
    assert result.json["poses"][0] == pytest.approx([3, -2, np.pi / 2], abs=0.05)


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
        (f"slam {DRIVE}", Exit.USAGE, "take --method ekf or fastslam"),
        (f"slam {DRIVE} --method ekf --save-map x.yaml", Exit.USAGE, "makes no map of cells"),
        (f"slam {DRIVE} --save-map x.png", Exit.USAGE, "does not end with .yaml"),
        (f"slam {GRAPH} --save-map x.yaml", Exit.USAGE, "are for logs"),
        (f"localize {DRIVE} --map x.png --filter mcl", Exit.USAGE, "--resolution 0.05"),
        (f"localize {DRIVE} --map x.yaml --resolution 1", Exit.USAGE, "--resolution is for images"),
        (f"slam {GRAPH} --start 0 0 0", Exit.USAGE, "are for logs"),
        (f"slam {GRAPH} --method ekf", Exit.USAGE, "are for logs"),
        (f"slam {DRIVE} --robust dcs", Exit.USAGE, "is for pose graphs"),
        (f"slam {DRIVE} --method ekf --save x.g2o", Exit.USAGE, "has no pose graph"),
    ],
)
def test_what_goes_wrong_is_named(line, code, part):
    result = cspace(line)
    assert result.code == code
    assert part in result.err


@pytest.mark.parametrize(
    ("line", "part"),
    [
        (f"slam {GRAPH} --robot 2", "--robot"),
        (f"slam {GRAPH} --seed 2", "--seed"),
        (f"slam {DRIVE} --method ekf --seed 2", "no effect with ekf"),
        (f"localize {DRIVE} --resolution 0.1", "no effect without"),
        (f"localize {DRIVE} --map {{}} --resolution 0.1", "is a text of landmarks"),
    ],
)
def test_options_without_effect_are_refused(tmp_path, line, part):
    landmarks = tmp_path / "map.txt"
    landmarks.write_text("6 2 -1\n7 5 1.5\n8 2 4\n9 -1 1.5\n")
    result = cspace(line.format(landmarks))
    assert result.code == Exit.USAGE
    assert part in result.err


@pytest.mark.parametrize(
    "text", ["", "# nothing\n", "6.5 2 -1\n", "6 2 -1\n6 3 1\n", "-2 1 1\n", "6 1e300 0\n"]
)
def test_landmarks_that_are_no_map_are_named_with_their_file(tmp_path, text):
    landmarks = tmp_path / "map.txt"
    landmarks.write_text(text)
    result = cspace(f"localize {DRIVE} --map {landmarks}")
    assert result.code == Exit.BAD_FILE
    assert f"{landmarks}:1: " in result.err


@pytest.mark.parametrize(
    "line", ["VERTEX_SE2", "EDGE_SE2 0", "FIX x", "EDGE_SE2 0 1 1", "VERTEX_SE2 " + "9" * 5000]
)
def test_cut_graphs_are_named_with_their_line(tmp_path, line):
    graph = tmp_path / "cut.g2o"
    graph.write_text(f"VERTEX_SE2 0 0 0 0\n{line}\n")
    result = cspace(f"slam {graph}")
    assert result.code == Exit.BAD_FILE
    assert f"{graph}:2: " in result.err
    assert len(result.err) < 400 + len(str(graph))
