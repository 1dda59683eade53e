"""`cspace ik`: every solution, its limits, its order, its picture; and a reason where there is none."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cli import schema
from cli.run import cspace

GOAL = "--xyz 0.4 0.1 0.3 --rpy 0 pi 0"


def poses(result) -> np.ndarray:
    robot = cs.load_robot(result["robot"])
    return robot.fk([row["q"] for row in result["solutions"]])


def test_every_solution_reaches_the_goal():
    found = cspace(f"ik ur5e {GOAL} --json").json
    assert len(found["solutions"]) == 8
    T = cs.pose([0.4, 0.1, 0.3], rpy=[0, np.pi, 0])
    np.testing.assert_allclose(found["goal"]["matrix"], T, atol=1e-15)
    np.testing.assert_allclose(poses(found), np.broadcast_to(T, (8, 4, 4)), atol=1e-12)
    assert max(row["residual"] for row in found["solutions"]) < 1e-12
    assert len({row["branch"] for row in found["solutions"]}) == 8


def test_all_forms_of_a_pose_mean_the_same():
    T = cs.pose([0.4, 0.1, 0.3], rpy=[0.4, -1.2, 3.0])
    forms = {
        "rpy": [0.4, -1.2, 3.0],
        "wxyz": cs.to_wxyz(T),
        "xyzw": cs.to_xyzw(T),
    }
    wanted = cs.load_robot("ur5e").ik(T).q
    assert len(wanted)
    for form, numbers in forms.items():
        found = cspace(f"ik ur5e --xyz 0.4 0.1 0.3 --json --{form}", *map(repr, map(float, numbers))).json
        np.testing.assert_allclose([row["q"] for row in found["solutions"]], wanted, atol=1e-9)
    found = cspace("ik ur5e --json --matrix", *map(repr, map(float, T.ravel()))).json
    np.testing.assert_allclose([row["q"] for row in found["solutions"]], wanted, atol=1e-9)
    found = cspace(
        "ik ur5e --xyz 0.4 0.1 0.3 --json --deg --rpy", *map(repr, np.degrees([0.4, -1.2, 3.0]).tolist())
    ).json
    np.testing.assert_allclose([row["q"] for row in found["solutions"]], wanted, atol=1e-9)


@pytest.mark.parametrize("word", ["-1.2", "-1.2e0", "-12e-1", "-.12e1"])
def test_negative_numbers_are_values(word):
    plain = cspace(f"ik ur5e --xyz 0.4 0.1 0.3 --rpy {word} 0 3 --json")
    assert plain.code == 0
    np.testing.assert_allclose(
        plain.json["goal"]["matrix"], cs.pose([0.4, 0.1, 0.3], rpy=[-1.2, 0, 3]), atol=1e-15
    )


def test_the_nearest_comes_first():
    near = [0.0, -1.5, 1.5, 0.0, 1.0, 0.0]
    found = cspace(f"ik ur5e {GOAL} --json --near", *map(str, near)).json
    away = [row["distance"] for row in found["solutions"]]
    assert away == sorted(away)
    robot = cs.load_robot("ur5e")
    best = robot.ik(found["goal"]["matrix"]).nearest(near).q[0]
    np.testing.assert_allclose(np.sin(0.5 * (found["solutions"][0]["q"] - best)), 0.0, atol=1e-9)


def test_limits_are_marked_dropped_or_kept():
    goal = "--xyz 0.4 0.1 0.5 --rpy 0 pi/2 0"
    mark = cspace(f"ik kr6_r900 {goal} --json").json["solutions"]
    drop = cspace(f"ik kr6_r900 {goal} --limits drop --json").json["solutions"]
    keep = cspace(f"ik kr6_r900 {goal} --limits keep --json").json["solutions"]
    assert len(mark) == len(keep) == 8
    inside = [row for row in mark if row["within_limits"]]
    assert 0 < len(inside) == len(drop) < 8
    limits = cs.load_robot("kr6_r900").limits
    for row in drop:
        assert (np.array(row["q"]) >= limits.lower).all()
        assert (np.array(row["q"]) <= limits.upper).all()
    for row in mark:
        assert row["within_limits"] == (row["out_of_limits"] == {})
    assert {row["within_limits"] for row in keep} == {None}
    text = cspace(f"ik kr6_r900 {goal} --deg --details".replace("pi/2", "90")).out
    assert " out by " in text
    assert " deg" in text


def test_unreachable_says_by_how_much_and_exits_with_one(tmp_path):
    picture = tmp_path / "no.png"
    result = cspace(f"ik ur5e --xyz 2 0 0.3 --rpy 0 pi 0 --plot {picture}")
    assert (result.code, result.err) == (1, "")
    found = cspace("ik ur5e --xyz 2 0 0.3 --rpy 0 pi 0 --json")
    assert found.code == 1
    schema.check(found.json)
    assert found.json["solutions"] == []
    assert found.json["status"] == "unreachable"
    assert 0.8 < found.json["out_of_reach"] < 1.8
    assert found.json["reason"] in result.out
    assert not picture.exists(), "nothing reached, nothing drawn"


def test_a_picture_is_written_whole(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "all.png"
    result = cspace(f"ik ur5e {GOAL} --plot", str(picture))
    assert result.code == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in tmp_path.iterdir()] == ["all.png"], "no draft is left"
    import matplotlib.pyplot as plt

    assert plt.get_fignums() == []


def test_degrees_in_the_table_are_those_of_the_json():
    rows = cspace(f"ik ur5e {GOAL} --json").json["solutions"]
    table = cspace("ik ur5e --xyz 0.4 0.1 0.3 --rpy 0 180 0 --deg --details").out.splitlines()[2:]
    for row, line in zip(rows, table, strict=True):
        shown = np.array(line.split()[1:7], dtype=float)
        np.testing.assert_allclose(shown, np.degrees(row["q"]), atol=6e-4)
        assert row["branch"] in line
