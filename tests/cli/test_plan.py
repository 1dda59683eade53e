"""`cspace plan`: goals of every form, files of paths, and what goes wrong."""

from __future__ import annotations

import csv
import io
import json
import math
import re
import time

import numpy as np
import pytest

import cspace as cs
from cli import schema
from cli.run import ROOT, cspace
from cspace.cli import progress
from cspace.cli.exits import Exit
from cspace.planning.plan_files import yaml_number

CELL = ROOT / "examples/cell.toml"
START, GOAL = [-60, -80, 90, -100, -90, 0], [60, -80, 90, -100, -90, 0]
LINE = f"plan ur5e --geometry skeleton --deg --scene {CELL}"
ENDS = f"--from {' '.join(map(str, START))} --to {' '.join(map(str, GOAL))}"


@pytest.fixture(scope="module")
def robot() -> cs.Robot:
    return cs.load_robot("ur5e", geometry="skeleton")


def test_the_path_is_that_of_the_library(robot):
    found = cspace(f"{LINE} {ENDS} --json")
    assert (found.code, found.err) == (Exit.DONE, "")
    schema.check(found.json, "cspace.plan/1")
    plan = cs.plan(robot, np.radians(START), np.radians(GOAL), cs.Scene.load(CELL))
    assert found.json["path"] == plan.path.tolist()
    assert found.json["cost"] == plan.cost
    assert found.json["clearance"] == plan.clearance > 0
    assert found.json["certified"]
    np.testing.assert_allclose(found.json["goal"]["configurations"], [np.radians(GOAL)])


def test_corners_are_printed_in_degrees_or_radians():
    path = cspace(f"{LINE} {ENDS} --json").json["path"]
    lines = cspace(f"{LINE} {ENDS}").out.splitlines()
    rows = [line.split()[1:] for line in lines if line.split()[0].isdigit()]
    np.testing.assert_allclose(np.array(rows, dtype=float), np.degrees(path), atol=6e-4)
    assert any(line.startswith("motions") and "proved free" in line for line in lines)
    assert "edges" in cspace(f"{LINE} {ENDS} --details").out
    assert (
        "samples"
        in cspace("plan planar_2r --from 0.2 0.3 --to 1.8 0.8 --planner potential_field --details").out
    )


def test_named_poses_and_several_goals(robot):
    found = cspace("plan ur5e --geometry skeleton --to 2 -1.5 0 0 0 0 --to up --json").json
    poses = robot.named_poses
    assert found["start"] == poses["home"].tolist(), "the start by default"
    assert found["goal"]["configurations"] == [[2, -1.5, 0, 0, 0, 0], poses["up"].tolist()]
    assert found["path"][-1] == found["goal"]["configurations"][found["goal_index"]]


DOWN = cs.pose([0.4, 0.3, 0.3], rpy=[0, np.pi, 0])
GOALS = {
    "--xyz 0.4 0.3 0.3 --rpy 0 180 0": lambda T: np.abs(T - DOWN).max(),
    "--xyz -0.3 -0.3 0.6": lambda T: np.abs(T[:3, 3] - [-0.3, -0.3, 0.6]).max(),
    "--xyz 0.4 0.3 0.3 --direction 0 0 -1": lambda T: np.abs(T[:3, 2] - [0, 0, -1]).max(),
    "--xyz 0.4 0.3 0.3 --direction 0 0 -1 --tool-axis x": lambda T: np.abs(T[:3, 0] - [0, 0, -1]).max(),
}


@pytest.mark.parametrize("goal", GOALS)
def test_goals_of_the_tip_are_reached(robot, goal):
    found = cspace(f"{LINE} --from {' '.join(map(str, START))} {goal} --json")
    assert found.code == Exit.DONE, found.err
    T = robot.fk(found.json["path"][-1])
    assert GOALS[goal](T) < 1e-9
    assert found.json["goal"]["configurations"] is None


def test_boxes_and_angles_make_regions(robot):
    start = " ".join(map(str, START))
    goal = "--xyz 0.4 0.3 0.3 --box 0.2 0.2 10cm --direction 0 0 -1 --within 20 --deg"
    found = cspace(f"{LINE} --from {start} {goal} --json")
    assert found.code == Exit.DONE, found.err
    T = robot.fk(found.json["path"][-1])
    assert (np.abs(T[:3, 3] - [0.4, 0.3, 0.3]) <= [0.1 + 1e-9, 0.1 + 1e-9, 0.05 + 1e-9]).all()
    assert T[2, 2] <= -np.cos(np.radians(20)) + 1e-9
    assert found.json["goal"]["box"] == [0.2, 0.2, 0.1]
    assert found.json["goal"]["within"] == pytest.approx(np.radians(20))
    turned = cspace(f"{LINE} --from {start} --xyz 0.4 0.3 0.3 --rpy 0 180 0 --within 5 --deg --json")
    T = robot.fk(turned.json["path"][-1])
    np.testing.assert_allclose(T[:3, 3], [0.4, 0.3, 0.3], atol=1e-9)
    assert cs.rotation_distance(T[:3, :3], DOWN[:3, :3]) <= np.radians(5) + 1e-9


def test_options_seed_and_margin(robot):
    line = f"{LINE} {ENDS} --json --margin 2mm --seed 3 --option range=0.5 --option edges=100000"
    found = cspace(line).json
    assert (found["margin"], found["seed"]) == (0.002, 3)
    assert found["options"]["range"] == 0.5
    ends = np.radians(START), np.radians(GOAL)
    plan = cs.plan(robot, *ends, cs.Scene.load(CELL), margin=0.002, rng=3, range=0.5, edges=100000)
    assert found["path"] == plan.path.tolist()
    assert found["clearance"] >= 0.0019
    assert cspace(f"{LINE} {ENDS} --json --margin 0.2cm").json["margin"] == 0.002


def test_where_a_descent_ended_keeps_its_names(tmp_path):
    boxes = cs.Scene([cs.Box([0.5, 0.5, 0.5], [1.2, 1.3, 0], name="box")])
    boxes.save(tmp_path / "box.toml")
    ends = f"--from 0.2 0.3 --to 1.8 0.8 --scene {tmp_path}/box.toml"
    found = cspace(f"plan planar_2r {ends} --planner potential_field --json")
    assert (found.code, found.err) == (Exit.NEGATIVE, "")
    schema.check(found.json, "cspace.plan/1")
    own = cs.plan(cs.load_robot("planar_2r"), [0.2, 0.3], [1.8, 0.8], boxes, planner="potential_field")
    rest = found.json["stats"]["rest"]
    assert rest["kind"] == own.stats["rest"].kind == "minimum"
    assert rest["q"] == own.stats["rest"].q.tolist()
    assert rest["pushes"][0]["other"] == "box"
    drawn = cspace(
        f"plan planar_2r {ends} --planner potential_field --plot {tmp_path}/stop.png -o {tmp_path}/w.csv"
    )
    assert drawn.code == Exit.NEGATIVE
    assert (tmp_path / "stop.png").stat().st_size > 10_000
    assert not (tmp_path / "w.csv").exists()


@pytest.mark.parametrize("ending", ["yaml", "yml", "json", "csv"])
def test_files_of_paths_keep_every_digit(tmp_path, ending):
    file = tmp_path / f"way.{ending}"
    found = cspace(f"{LINE} {ENDS} --json -o", str(file))
    assert found.json["written"] == [str(file)]
    text = file.read_text(encoding="utf-8")
    if ending == "csv":
        heading, *rows = csv.reader(io.StringIO(text))
        joints, path = heading, [[float(x) for x in row] for row in rows]
    else:
        values = json.loads(text) if ending == "json" else pytest.importorskip("yaml").safe_load(text)
        joints, path = values["joints"], values["path"]
        assert values["schema"] == "cspace.path/1"
        assert set(values["units"]) == {"rad"}
    assert joints == found.json["joints"]
    assert path == found.json["path"]


@pytest.mark.parametrize("value", [1e-300, -1e-05, 1.5e-7, 2e22, 0.1, -3.0, 1e16])
def test_numbers_of_yaml_are_numbers_for_every_reader(value):
    yaml = pytest.importorskip("yaml")  # a reader of YAML 1.1
    assert yaml.safe_load(yaml_number(value)) == value


def test_spheres_of_a_file_are_used(tmp_path):
    file = tmp_path / "spheres.json"
    file.write_text(json.dumps({"forearm_link": [[0, 0, 0, 0.08]]}))
    found = cspace(f"plan ur5e --to up --spheres {file} --scene {CELL} --json")
    assert found.code == Exit.DONE


def test_a_picture_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    file = tmp_path / "way.png"
    result = cspace(f"{LINE} {ENDS} --plot", str(file))
    assert result.code == Exit.DONE
    assert f"wrote {file}" in result.out
    assert file.read_bytes().startswith(b"\x89PNG")
    assert list(tmp_path.iterdir()) == [file], "no draft is left"


def test_no_path_ends_in_one_and_writes_nothing(tmp_path):
    file = tmp_path / "way.json"
    line = f"{LINE} --from {' '.join(map(str, START))} --xyz 0.55 0 0.35 -o {file}"
    result = cspace(line)
    assert (result.code, result.err) == (Exit.NEGATIVE, "")
    assert "wall" in result.out
    found = cspace(f"{line} --json")
    schema.check(found.json)
    assert (found.code, found.json["status"]) == (Exit.NEGATIVE, "undetermined")
    assert found.json["path"] == found.json["written"] == []
    assert not file.exists()
    budget = cspace(f"{LINE} {ENDS} --option edges=1 --json")
    assert (budget.code, budget.json["status"]) == (Exit.NEGATIVE, "undetermined")


FAULTS = [
    ("plan ur10 --to up", ["no collision geometry", "--spheres FILE", "--geometry skeleton"]),
    ("plan ur5e --geometry skeleton", ["no goal", "--to"]),
    ("plan kr6_r900 --geometry skeleton --to 0 0 0 0 0 0", ["no start", "'home'", "--from"]),
    ("plan ur5e --geometry skeleton --to upp", ["upp", "'up'"]),
    ("plan ur5e --geometry skeleton --to 0 0 0", ["6 joints", "--to has 3 values"]),
    ("plan ur5e --geometry skeleton --to up home", ["--to takes a value per joint", "'up'"]),
    ("plan ur5e --geometry skeleton --to up --xyz 0 0 1", ["--to and --xyz", "leave one out"]),
    ("plan ur5e --geometry skeleton --to up --look-at 0 0 1", ["--to and --look-at"]),
    ("plan ur5e --geometry skeleton --spheres a.json --to up", ["--spheres and --geometry"]),
    ("plan ur5e --geometry bones --to up", ["bones", "skeleton"]),
    ("plan ur5e --geometry skeleton --to up --planner rrt_conect", ["rrt_conect", "rrt_connect"]),
    ("plan ur5e --geometry skeleton --to up --option rang=1", ["rang", "'range'", "rrt_connect"]),
    ("plan ur5e --geometry skeleton --to up --option range=far", ["range", "'far'", "number"]),
    ("plan ur5e --geometry skeleton --to up --option range=-1", ["range is -1"]),
    ("plan ur5e --geometry skeleton --to up --margin 5km", ["--margin", "'5km'"]),
    ("plan ur5e --geometry skeleton --to up --margin=-1", ["margin is -1"]),
    ("plan ur5e --geometry skeleton --to up --seed 1.5", ["--seed", "'1.5'"]),
    ("plan ur5e --geometry skeleton --to up --seed=-1", ["--seed", "'-1'"]),
    ("plan ur5e --geometry skeleton --to up -o way.txt", ["way.txt", ".yaml"]),
    ("plan ur5e --geometry skeleton --to up -o nowhere/way.csv", ["no folder"]),
    ("plan ur5e --geometry skeleton --to up --plot way.bmp", ["way.bmp", ".png"]),
    (f"{LINE} --from 0 -30 60 -30 90 0 --to up", ["start", "wall", "move it away"]),
    ("plan ur5e --geometry skeleton --to 9 0 0 0 0 0", ["goal", "outside its limits"]),
    ("plan ur5e --geometry skeleton --from up --to up --box 1 1 1", ["--box", "--xyz"]),
    ("plan ur5e --geometry skeleton --from up --direction 0 0 1 --box 1 1 1", ["--box", "--xyz"]),
    ("plan ur5e --geometry skeleton --from up --xyz 0 0 1 --within 0.1", ["--within", "--direction"]),
    ("plan ur5e --geometry skeleton --xyz 0.4 0.1 0.3 --rpy 0 0 0 --tool-axis x", ["--tool-axis"]),
]  # fmt: skip


@pytest.mark.parametrize(("line", "words"), FAULTS, ids=[line for line, _ in FAULTS])
def test_what_cannot_be_done_is_said(line, words):
    result = cspace(line)
    assert result.code == Exit.USAGE, result.out
    assert all(word in result.err for word in words), result.err
    assert result.out == ""


@pytest.mark.parametrize("text", ["name = [", '[[objects]]\nname = "a"\nshape = "blob"\n'])
def test_a_bad_scene_is_a_bad_file(tmp_path, text):
    file = tmp_path / "cell.toml"
    file.write_text(text)
    result = cspace(f"plan ur5e --geometry skeleton --to up --scene {file}")
    assert result.code == Exit.BAD_FILE
    assert "cell.toml" in result.err
    assert cspace(f"plan ur5e --geometry skeleton --to up --scene {tmp_path}/no.toml").code == Exit.BAD_FILE


def test_a_search_without_end_heeds_the_time_limit(tmp_path):
    """Two walls divide the plane of an arm of three joints; the budget of motions would last for hours."""
    file = tmp_path / "halves.toml"
    cs.Scene([cs.Box([4.0, 0.1, 1.0], [2.4 * side, 0, 0]) for side in (-1, 1)]).save(file)
    began = time.perf_counter()
    line = "plan planar_3r --geometry skeleton --from pi/2 0 0 --to -pi/2 0 0"
    result = cspace(f"{line} --scene {file} --option edges=1000000000000 --time-limit 1")
    assert result.code == Exit.TIME_LIMIT, result.err
    assert time.perf_counter() - began < 5
    assert "--time-limit" in result.err


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_progress_appears_at_a_terminal_after_a_while_and_is_erased(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", 0.02)
    monkeypatch.setattr(progress, "PERIOD", 0.02)
    monkeypatch.setattr("sys.stderr", stream := Terminal())
    with progress.show_progress("planning"):
        end = time.monotonic() + 20
        while not stream.getvalue() and time.monotonic() < end:
            time.sleep(0.01)
    assert re.match(rf"{re.escape(progress.CLEAR)}planning … \d+ s", stream.getvalue())
    assert stream.getvalue().endswith(progress.CLEAR)
    monkeypatch.setattr(progress, "PATIENCE", 20.0)
    monkeypatch.setattr("sys.stderr", stream := Terminal())
    with progress.show_progress("planning"):
        pass
    assert stream.getvalue() == "", "what is quick shows nothing"
    monkeypatch.setattr(progress, "PATIENCE", 0.02)
    monkeypatch.setattr("sys.stderr", stream := io.StringIO())
    with progress.show_progress("planning"):
        time.sleep(0.1)
    assert stream.getvalue() == "", "nobody watches a pipe"


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        ("--within 20deg", f"--within {math.radians(20)!r}"),
        ("--within 20° --box 10cm 100mm 0", f"--within {math.radians(20)!r} --box 0.1 0.1 0"),
        ("--within 0.2rad --deg", f"--within {math.degrees(0.2)!r} --deg"),
    ],
)
def test_units_may_be_typed(typed, plain):
    goal = "plan ur5e --from up --xyz 40cm -20cm 0.4 --direction 0 0 -1 --json"
    found, same = (cspace(f"{goal} {words}").json for words in (typed, plain))
    np.testing.assert_allclose(found["goal"]["within"], same["goal"]["within"], rtol=1e-15)
    np.testing.assert_allclose(found["path"], same["path"], atol=1e-9)


def test_angles_of_joints_have_units():
    found = cspace("plan ur5e --from 0 -90deg 0 -90° 0 0 --to 1rad -pi/2 0 -1 0 10deg --json").json
    np.testing.assert_allclose(found["start"], [0, -np.pi / 2, 0, -np.pi / 2, 0, 0], rtol=1e-15)
    np.testing.assert_allclose(found["path"][-1][-1], np.radians(10), rtol=1e-15)


@pytest.mark.parametrize(
    ("option", "name", "value"),
    [
        ("grid_search --option cells=60", "cells", [60, 60]),
        ("grid_search --option cells=60,40", "cells", [60, 40]),
        ("grid_search --option step=5deg", "step", np.radians(5)),
        ("rrt_connect --option edges=1e5", "edges", 100000),
        ("rrt_connect --option time_limit=1500ms", "time_limit", 1.5),
        ("rrt_connect --option time_limit=inf", "time_limit", "inf"),
        ("potential_field --option rho_0=25cm", "rho_0", 0.25),
    ],
)
def test_options_take_units_lists_and_powers_of_ten(option, name, value):
    found = cspace(f"plan planar_2r --from 0 0 --to 0.3 0.2 --planner {option} --json").json
    given = (found["stats"] if name == "cells" else found["options"])[name]
    assert given == (value if isinstance(value, str) else pytest.approx(value, rel=1e-15))


@pytest.mark.parametrize("option", ["edges=1.5", "edges=5deg", "range=5kg", "cells=1,x", "step=cm"])
def test_values_of_options_without_sense_are_refused(option):
    planner = "rrt_connect" if option[0] in "er" else "grid_search"
    found = cspace(f"plan planar_2r --from 0 0 --to 1 1 --planner {planner} --option {option}")
    assert found.code == Exit.USAGE
    assert option.split("=")[1] in found.err


def test_a_path_in_time_is_written_as_samples(tmp_path):
    ends = "--from ready --to 1 0.2 0 -1.5 0 1.8 0.8"
    table, message = tmp_path / "move.csv", tmp_path / "move.yaml"
    found = cspace(f"plan panda {ends} --trajectory {table} --rate 50 --json")
    schema.check(found.json, "cspace.plan/1")
    assert found.json["written"] == [str(table)]
    motion = cs.trajectory.from_csv(table)
    assert motion.duration == pytest.approx(found.json["duration"], rel=1e-9)
    np.testing.assert_allclose(motion(0.0), found.json["path"][0], atol=1e-9)
    np.testing.assert_allclose(motion(motion.duration), found.json["path"][-1], atol=1e-9)
    slow = cspace(f"plan panda {ends} --trajectory {message} --acceleration 0.5 --jerk 2")
    assert slow.code == Exit.DONE
    assert float(re.search(r"trajectory: ([0-9.]+) s", slow.out)[1]) > 1.5 * motion.duration
    assert "time_from_start" in message.read_text()
    for words, fault in (
        (f"--trajectory {tmp_path / 'move.txt'}", "must be .yaml, .csv or .json"),
        ("--jerk 2", "--trajectory"),
        (f"--plot {tmp_path / 'move.gif'}", "picture format"),
    ):
        refused = cspace(f"plan panda {ends} {words}")
        assert refused.code == Exit.USAGE
        assert fault in refused.err
