"""`cspace nav`: maps of every ending, planners by name, pictures, and what goes wrong."""

from __future__ import annotations

import json

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cspace.cli.exits import Exit
from data import ROOT

YARD = f"nav {ROOT}/examples/yard.txt --start 1 1"


def test_all_planners_side_by_side():
    found = cspace(f"{YARD} --goal 9 9 --planner all --json").json
    assert [route["planner"] for route in found["routes"]] == sorted(cs.navigation.PLANNERS)
    shortest = min(route["length"] for route in found["routes"])
    for route in found["routes"]:
        if route["status"] == "found":
            assert route["ratio_to_shortest"] == pytest.approx(route["length"] / shortest)
            assert route["clearance"] >= 0


def test_clearance_is_that_from_the_walls_of_the_map():
    [route] = cspace(f"{YARD} --goal 9 9 --radius 0.3 --json").json["routes"]
    assert 0.3 - 1e-9 <= route["clearance"] < 0.302


def test_a_planner_on_cells_may_refuse_what_others_answer():
    line = f"{YARD} --goal 1.9 3 --resolution 0.3 --planner any_angle,a_star"
    result = cspace(line)
    assert result.code == Exit.DONE
    assert "a_star: goal (1.9, 3) lies in cell" in result.out
    document = cspace(f"{line} --json").json
    assert [route["planner"] for route in document["routes"]] == ["any_angle"]
    assert list(document["refused"]) == ["a_star"]


def test_no_way_ends_in_one():
    result = cspace(f"{YARD} --goal 3.5 3.5 --planner bug_2,any_angle")
    assert result.code == Exit.NEGATIVE
    assert result.out.count("unreachable") == 2


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (f"{YARD} --goal 9 9 --planner bug_3", ["bug_3", "bug_2"]),
        (f"{YARD} --goal 2.5 2.5", ["goal", "inside obstacle 0"]),
        (f"{YARD} --goal 20 2.5", ["goal", "outside the world"]),
        (f"{YARD} --goal 1.95 3 --radius 0.1", ["goal", "grown by the robot's radius, 0.1 m"]),
        (f"{YARD} --goal 9 9 --plot ways.txt", ["ways.txt", ".png"]),
        (f"{YARD} --goal 9 9 --animate ways.mp4", ["ways.mp4", ".gif"]),
        ("nav yard.dxf --start 1 1 --goal 9 9", ["yard.dxf", ".geojson"]),
    ],
)
def test_what_cannot_be_done_is_said(line, words):
    result = cspace(line)
    assert result.code == Exit.USAGE
    assert all(word in result.err for word in words)


def test_a_map_that_is_not_there():
    result = cspace("nav nowhere.txt --start 1 1 --goal 9 9")
    assert result.code == Exit.BAD_FILE
    assert "nowhere.txt" in result.err


def test_maps_of_every_ending(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocked = np.zeros((10, 10), bool)
    blocked[4:6, :8] = True
    cs.OccupancyGrid(blocked).save_ros("yard.yaml")
    (tmp_path / "yard.map").write_text(
        "type octile\nheight 10\nwidth 10\nmap\n"
        + "\n".join("".join(".@"[int(b)] for b in row) for row in blocked)
    )
    box = [[[0, 4], [8, 4], [8, 6], [0, 6], [0, 4]]]
    (tmp_path / "yard.geojson").write_text(
        json.dumps({"type": "Polygon", "coordinates": box, "bbox": [0, 0, 10, 10]})
    )
    lengths = [
        cspace(f"nav yard{ending} --start 1 1 --goal 1 9 --json").json["routes"][0]["length"]
        for ending in (".yaml", ".map", ".geojson")
    ]
    assert lengths == pytest.approx([lengths[0]] * 3)


def test_pictures(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    result = cspace(
        f"{YARD} --goal 9 9 --planner visibility_graph,bug_1 --plot ways.png --animate search.gif"
    )
    assert result.code == Exit.DONE
    assert (tmp_path / "ways.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "search.gif").read_bytes()[:3] == b"GIF"
    import matplotlib.pyplot as plt

    assert not plt.get_fignums(), "pictures that are saved are closed"
