"""`cspace traj`: what it refuses, and motions that leave limits."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from data import ROOT


def write_waypoints(path, rows):
    path.write_text("\n".join(",".join(f"{x!r}" for x in row) for row in np.asarray(rows).tolist()) + "\n")
    return path


@pytest.mark.parametrize(
    ("goal", "option"),
    [
        *(("--to ready", f"--{name} 0") for name in ("blend", "speed", "turn-rate")),
        *(("--line 0.4 0.2 0.4", f"--{name} 0") for name in ("duration", "blend")),
        *(("--to ready", f"--{name} 1") for name in ("blend", "speed", "turn-rate")),
        ("--to ready", "--torque"),
    ],
)
def test_options_of_another_goal_are_refused_even_if_zero(goal, option):
    result = cspace(f"traj panda --from ready {goal} {option}")
    assert result.code == 2
    assert f"{option.split()[0]} does not go with {goal.split()[0]}" in result.err


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["panda", "ur5e", "so101"])
def test_a_spline_that_leaves_the_limits_is_no_motion(tmp_path, name, seed):
    """The waypoints are within the limits; the spline through them overshoots, blends do not."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(seed)
    corners = rng.integers(0, 2, (5, robot.dof))
    rows = np.where(corners, robot.limits.upper - 1e-3, robot.limits.lower + 1e-3)
    file = write_waypoints(tmp_path / "way.csv", rows)
    line = f"traj {name} --velocity 1 --acceleration 3 --waypoints {file} -o {tmp_path / 'motion.csv'}"
    overshot = cspace(line)
    assert overshot.code == 1
    assert "limit from" in overshot.out
    assert "--blend" in overshot.out
    assert not (tmp_path / "motion.csv").exists()
    assert cspace(f"{line} --blend 0.1").code == 0
    assert (tmp_path / "motion.csv").exists()


def test_limits_of_the_caller_are_told_apart_from_those_of_the_robot():
    result = cspace("traj panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8 --velocity 10")
    assert result.code == 0
    assert "panda_joint1 exceeds its velocity limit" in result.out
    assert "TrajectoryCheck" not in result.out


@pytest.mark.parametrize("verb", ["traj", "plan"])
def test_missing_limits_are_named_by_their_options(verb, tmp_path):
    goal = f"--trajectory {tmp_path / 'a.yaml'}" if verb == "plan" else ""
    result = cspace(f"{verb} ur5e --to up {goal}")
    assert result.code == 2
    assert "pass --acceleration" in result.err
    assert "=" not in result.err


@pytest.mark.parametrize(
    "words",
    [
        "traj panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8",
        "traj panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8 --profile quintic",
        "traj panda --from ready --line 0.4 0.2 0.4 --jerk 400",
        "plan panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8",
    ],
)
def test_a_json_file_is_the_motion_itself(words, tmp_path):
    file, samples = tmp_path / "a.json", tmp_path / "a.csv"
    option = "--trajectory" if words.startswith("plan") else "-o"
    assert cspace(f"{words} {option} {file}").code == 0
    assert cspace(f"{words} {option} {samples} --rate 250").code == 0
    motion, read = cs.trajectory.from_json(file), cs.trajectory.from_csv(samples)
    assert motion.duration == read.duration
    t = motion.sample(250.0).times
    np.testing.assert_allclose(motion(t), read(t), atol=1e-12)


@pytest.mark.slow
def test_a_film_and_a_picture_of_a_motion(tmp_path):
    words = "traj planar_3r --from 2.2 -1.2 -0.6 --to 1.9 -1.1 -0.5 --velocity 2 --acceleration 6 --jerk 40"
    for name, magic in (("a.gif", b"GIF8"), ("a.png", b"\x89PNG")):
        assert cspace(f"{words} --plot {tmp_path / name}").code == 0
        assert (tmp_path / name).read_bytes()[:4] == magic


def test_the_heading_of_waypoints_gives_the_order_of_joints(tmp_path):
    robot = cs.load_robot("panda")
    ready = np.array(robot.named_poses["ready"])
    rows = np.array([ready, ready + 0.1, ready - 0.1])
    order = np.random.default_rng(0).permutation(robot.dof)
    plain, named = tmp_path / "plain.csv", tmp_path / "named.csv"
    write_waypoints(plain, rows)
    write_waypoints(named, rows[:, order])
    heading = ",".join(robot.joint_names[k] for k in order)
    named.write_text(f"{heading}\n{named.read_text()}")
    found = [cspace(f"traj panda --waypoints {file} --json").json for file in (plain, named)]
    assert found[0] == found[1]


@pytest.mark.parametrize("row", ["0,-.5,,0,-2,0,1.6,.8", "0,-.5,0,-2,0,1.6,.8,", ",0,-.5,0,-2,0,1.6"])
def test_an_empty_cell_of_a_waypoint_is_refused(tmp_path, row):
    file = tmp_path / "way.csv"
    file.write_text(f"0,-.5,0,-2,0,1.6,.8\n{row}\n")
    result = cspace(f"traj panda --waypoints {file}")
    assert result.code != 0
    assert "way.csv:2" in result.err


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        ("traj panda --from ready --to ready --rate 50", "--rate has no effect without -o"),
        ("traj panda --from ready --to ready --rate 50 -o {}/a.json", "--rate has no effect without -o"),
        ("plan panda --from ready --to ready --rate 50", "--rate has no effect without --trajectory"),
        ("traj panda --waypoints {}", "this is a folder; give the CSV file inside it"),
        ("traj panda --from ready --line 1e300 0 0.4 --acceleration 5", "the largest allowed value"),
        ("traj panda --from ready --to ready --profile septic --velocity 1e-300", ""),
        ("traj panda --from ready --to extended --profile septic --velocity 1e-300", "the motion would last"),
        ("localize {} --filter histogram --seed 3", "--seed is the seed of --filter mcl"),
        ("localize {} --filter mcl --smooth", "--smooth is of the Kalman filters"),
    ],
)
def test_options_without_effect_and_hostile_numbers(words, fault, tmp_path):
    words = words.format(ROOT / "examples/small_drive" if words.startswith("localize") else tmp_path)
    result = cspace(words)
    assert result.code in ((2, 3) if fault else (0,)), result.err
    assert fault in result.err
