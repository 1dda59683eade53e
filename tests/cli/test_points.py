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
    assert facts["geometry"]["family"] == "short arm"
