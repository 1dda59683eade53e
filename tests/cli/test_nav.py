"""`cspace nav`: maps of every ending, planners by name, pictures, and what goes wrong."""

from __future__ import annotations

import json

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cli.schema import check
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
            assert route["seconds_first"] >= route["seconds"] > 0


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


def test_options_and_seeds():
    line = f"{YARD} --goal 9 9 --planner rrt,prm,a_star --seed 3 --option prm.samples=300 --option step=0.5"
    result = cspace(f"{line} --json")
    check(result.json, "cspace.nav/1")
    rrt, prm, a_star = result.json["routes"]
    assert rrt["options"] == {"samples": 20000, "step": 0.5, "goal_bias": 0.05, "rng": 3}
    assert (prm["options"]["samples"], prm["options"]["rng"]) == (300, 3)
    assert "rng" not in a_star["options"]
    again = cspace(f"{line} --json").json["routes"]
    assert [route["path"] for route in again] == [route["path"] for route in result.json["routes"]]
    world = cs.PolygonWorld.from_text(ROOT / "examples/yard.txt")
    assert rrt["path"] == cs.navigate(world, (1, 1), (9, 9), "rrt", step=0.5, rng=3).path.tolist()


@pytest.mark.parametrize(
    ("typed", "value"),
    [
        ("theta_star.lazy=True", True),
        ("tangent_bug.range=inf", "inf"),
        ("tangent_bug.range=2", 2.0),
        ("tangent_bug.hand=none", None),
        ("tangent_bug.hand=right", "right"),
        ("approximate_cells.depth=7", 7),
    ],
)
def test_values_are_of_the_type_of_their_option(typed, value):
    planner, name = typed.partition("=")[0].split(".")
    [route] = cspace(f"{YARD} --goal 9 9 --planner {planner} --option {typed} --json").json["routes"]
    assert route["options"][name] == value


def test_planners_and_their_options():
    document = cspace("planners --json").json
    check(document, "cspace.planners/1")
    every = [*cs.navigation.PLANNERS.values(), *cs.planning.PLANNERS.values()]
    assert [row["name"] for row in document["planners"]] == [row.name for row in every]
    worlds = {"polygons", "grid", "arm"}
    assert {row["world"] for row in document["planners"]} == worlds
    table = cspace("planners").out
    assert all(row.summary in table for row in every)
    told = cspace("planners rrt any_angle").out
    assert all(option.meaning in told for option in cs.navigation.PLANNERS["rrt"].options.values())
    assert "no options" in told
    assert "rrt_star" in cspace("planners rrt_stat").err


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (f"{YARD} --goal 9 9 --planner rrt --option sampels=3", ["sampels", "planner 'rrt'", "'samples'"]),
        (f"{YARD} --goal 9 9 --planner rrt,prm --option sampels=3", ["these planners", "'samples'"]),
        (f"{YARD} --goal 9 9 --planner rrt --option prm.samples=3", ["no planner 'prm'", "--planner", "rrt"]),
        (f"{YARD} --goal 9 9 --planner rrt --option samples=many", ["samples", "'many'", "whole number"]),
        (f"{YARD} --goal 9 9 --planner rrt --option samples=0", ["samples is 0", "1 to"]),
        (f"{YARD} --goal 9 9 --planner rrt --option samples", ["'samples'", "NAME=VALUE"]),
        (f"{YARD} --goal 9 9 --planner rrt --option rng=1 --seed 2", ["rng", "twice"]),
        (f"{YARD} --goal 9 9 --planner a_star --seed 2", ["rng", "a_star"]),
        (f"{YARD} --goal 9 9 --planner a_star --option metric=octil", ["octil", "'octile'"]),
        (f"{YARD} --goal 9 9 --planner a_star --option costs=2", ["costs", "cells"]),
        (f"{YARD} --goal 9 9 --planner theta_star --option lazy=maybe", ["lazy", "'maybe'", "true or false"]),
        (f"{YARD} --goal 9 9 --plot nowhere/ways.png", ["nowhere"]),
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
    assert result.out.splitlines()[-2:] == ["wrote ways.png", "wrote search.gif"]
    assert (tmp_path / "ways.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "search.gif").read_bytes()[:3] == b"GIF"
    import matplotlib.pyplot as plt

    assert not plt.get_fignums(), "pictures that are saved are closed"


def path_lines(out):
    return [line for line in out.splitlines() if len(line.split()) == 2 and line.startswith("  ")]


def test_a_long_path_is_printed_by_its_ends_unless_all_of_it_is_wanted():
    line = f"{YARD} --goal 9 9 --planner fast_marching"
    path = cspace(f"{line} --json").json["routes"][0]["path"]
    assert len(path) > 40
    short, long = cspace(line).out, cspace(f"{line} --details").out
    assert [[*map(float, row.split())] for row in path_lines(long)] == [
        [round(x, 6), round(y, 6)] for x, y in path
    ]
    assert path_lines(short) == [*path_lines(long)[:10], *path_lines(long)[-10:]]
    assert f"… {len(path) - 20} of {len(path)} points; --details prints all …" in short
    few = f"{YARD} --goal 9 9"
    assert path_lines(cspace(few).out) == path_lines(cspace(f"{few} --details").out)


def test_seeds_that_were_drawn_are_printed_and_make_the_same_path():
    line = f"{YARD} --goal 9 9 --planner rrt,a_star,prm"
    told = dict(row.split(": --seed ") for row in cspace(line).out.splitlines() if ": --seed " in row)
    assert list(told) == ["rrt", "prm"]
    first = cspace(f"{YARD} --goal 9 9 --planner rrt --details").out
    seed = first.split(": --seed ")[1].split()[0]
    again = cspace(f"{YARD} --goal 9 9 --planner rrt --details --seed {seed}").out
    assert path_lines(again) == path_lines(first)


def test_an_animation_tells_whose_search_it_shows(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    shown = cspace(f"{YARD} --goal 9 9 --planner bug_1,any_angle --animate search.gif").out.splitlines()
    assert shown[-2:] == ["search.gif: the search of bug_1", "wrote search.gif"]
