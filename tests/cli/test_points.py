"""`cspace ik` with a point as the goal."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cli import schema
from cli.run import cspace


@pytest.mark.parametrize(
    ("line", "count"),
    [
        ("--xy 1 0.5", 2),
        ("--xyz 1 0.5 0", 2),
        ("--xy 3 0", 0),
        ("--xy 2 0", 1),
    ],
)
def test_a_planar_arm_reaches_a_point(line, count):
    """The four cases of a lecture but the last: none, one when stretched, two."""
    result = cspace(f"ik planar_2r {line} --json")
    assert result.code == (0 if count else 1), result.err
    schema.check(result.json)
    assert len(result.json["solutions"]) == count
    if count:
        point = np.array([float(x) for x in line.split()[1:3]])
        reached = cs.load_robot("planar_2r").fk([row["q"] for row in result.json["solutions"]])
        np.testing.assert_allclose(reached[:, :2, 3], np.tile(point, (count, 1)), atol=1e-9)


@pytest.mark.parametrize(
    ("line", "rows"),
    [
        ("planar_2r --xy 0.3 0.4", ("vx", "vy")),
        ("planar_3r --xy 0.3 0.4", ("vx", "vy")),
        ("planar_3r --xyz 0.3 0.4 0", ("vx", "vy")),
        ("planar_3r --xyz 0.3 any any", ("vx",)),
        ("planar_3r --xy 0.3 0.4 --angle 1", ("vx", "vy", "wz")),
        ("simplified_puma --xyz 0.3 0.4 0.5", "linear"),
        ("ur5e --xyz 0.3 any 0.5", ("vx", "vz")),
    ],
)
def test_the_freedoms_of_the_goal_count_for_singularity(line, rows):
    robot = cs.load_robot(line.split()[0])
    found = cspace(f"ik {line} --json").json["solutions"]
    assert found
    for row in found:
        expected = robot.distance_to_singularity(row["q"], rows=rows)
        assert row["singularity"] == pytest.approx(expected, rel=1e-9)
        assert row["singularity"] > 1e-3


def test_singularity_is_not_shown_where_no_joint_moves_what_is_asked(tmp_path):
    slides = cs.Robot.from_screws(np.eye(3), np.zeros((3, 3)), np.eye(4), joint_types="PPP")
    file = tmp_path / "slides.urdf"
    file.write_text(slides.to_urdf())
    rotation = "--rotation 1 0 0 0 1 0 0 0 1"
    result = cspace(f"ik {file} {rotation} --json")
    schema.check(result.json, "cspace.ik/1")
    assert [row["singularity"] for row in result.json["solutions"]] == [None]
    assert "singularity" not in cspace(f"ik {file} {rotation}").out
    plane = cspace("ik planar_3r --xyz any any 0 --json").json
    assert [row["singularity"] for row in plane["solutions"]] == [None] * len(plane["solutions"])


def test_at_the_base_a_planar_arm_of_equal_links_turns_freely():
    found = cspace("ik planar_2r --xy 0 0 --json").json
    assert found["status"] == "singular"
    assert "joint_1" in found["reason"]


def test_more_than_three_joints_reach_a_point_from_the_middle_of_their_limits():
    found = cspace("ik ur5e --xyz 0.4 0.1 0.3 --json").json
    assert len(found["solutions"]) == 1
    T = cs.load_robot("ur5e").fk(found["solutions"][0]["q"])
    np.testing.assert_allclose(T[:3, 3], [0.4, 0.1, 0.3], atol=1e-9)


def test_joints_to_spare_are_sampled():
    found = cspace("ik panda --xyz 0.4 0.1 0.3 --rpy 0 3 0 --json").json
    assert len(found["solutions"]) >= 16


def test_every_point_of_a_spatial_arm_has_its_ways():
    found = cspace("ik simplified_puma --xyz 0.4 0.2 0.1 --json").json
    assert len(found["solutions"]) == 4
    reached = cs.load_robot("simplified_puma").fk([row["q"] for row in found["solutions"]])
    np.testing.assert_allclose(reached[:, :3, 3], np.tile([0.4, 0.2, 0.1], (4, 1)), atol=1e-12)
    assert {name: value for name, value in found["goal"].items() if value is not None} == {
        "position": [0.4, 0.2, 0.1]
    }


@pytest.mark.parametrize("name", ["planar_1r", "planar_2r", "planar_3r", "simplified_puma", "rpr"])
def test_the_sheet_names_the_closed_form_of_a_short_arm(name):
    facts = cspace(f"info {name} --json").json
    assert facts["geometry"]["closed_form"]
    assert facts["geometry"]["family"] == "fewer than six joints"


@pytest.mark.parametrize("name", ["planar_2r", "planar_3r", "simplified_puma", "so101", "ur5e", "panda"])
def test_the_singularity_of_a_pose_is_that_of_the_library(name):
    robot = cs.load_robot(name)
    q = np.full(robot.dof, 0.3)
    matrix = [f"{x:.17g}" for x in robot.fk(q).ravel()]
    found = cspace(f"ik {name} --json --matrix", *matrix).json["solutions"]
    assert found
    for row in found:
        expected = robot.distance_to_singularity(row["q"])
        assert row["singularity"] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    told = cspace(f"jacobian {name} --json", *map(str, q)).json
    assert told["distance_to_singularity"] == pytest.approx(robot.distance_to_singularity(q), rel=1e-12)
    assert told["manipulability"] == pytest.approx(robot.manipulability(q), rel=1e-12)
