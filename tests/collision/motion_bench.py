"""The robots and problems of the shared data: published spheres, MotionBenchMaker scenes."""

import gzip
import json

import cspace as cs
from cspace.model import Description, Joint, Link
from cspace.model.values import from_rpy
from data import shared_data

ROBOTS = ("panda", "ur5", "fetch")

SLACK = 1e-5
"""Added to the bounds [rad or m]: some ends of problems are outside those of the robot by rounding."""


def published_robot(name):
    """A robot with its published spheres, bounds and allowed pairs, and the data itself."""
    data = json.loads((shared_data() / "planning" / f"robot_{name}.json").read_text())
    links = dict.fromkeys(j[end] for j in data["joints"] for end in ("parent", "child"))
    bounds = data["bounds_used_by_vamp"]
    given = dict(zip(data["planned_joints"], zip(bounds["lower"], bounds["upper"], strict=True), strict=True))
    joints = []
    for j in data["joints"]:
        limits = {}
        if j["name"] in given:
            low, high = given[j["name"]]
            limits = {"lower": low - SLACK, "upper": high + SLACK}
        kind = "revolute" if j["type"] == "continuous" and limits else j["type"]
        origin = from_rpy(tuple(j["xyz"]), tuple(j["rpy"]))
        joints.append(
            Joint(j["name"], kind, j["parent"], j["child"], origin, j.get("axis") or (0, 0, 1), **limits)
        )
    disabled = tuple((a, b, why) for a, b, why in data["srdf_disabled_pairs"] if a in links and b in links)
    tree = Description(name, tuple(map(Link, links)), tuple(joints), allowed_pairs=disabled)
    tip = next(j["child"] for j in data["joints"] if j["name"] == data["planned_joints"][-1])
    rows = {}
    for sphere in data["spheres"]:
        rows.setdefault(sphere["link"], []).append([*sphere["center"], sphere["radius"]])
    return cs.Robot(tree, tip=tip).with_spheres(rows), data


def problems(name):
    """(set, index, scene, start, goals) of each problem.

    Cylinders are capsules, as VAMP reads them, but boxes in the set "box".
    """
    text = gzip.decompress((shared_data() / "planning" / f"mbm_{name}.json.gz").read_bytes())
    for group, rows in json.loads(text)["problems"].items():
        for row in rows:
            shapes = [obstacle(o, group == "box") for o in row["objects"]]
            yield group, row["index"], cs.Scene(shapes), row["start"], row["goals"]


def obstacle(given, as_box):
    """A shape of a problem."""
    place, name = cs.pose(given["position"], xyzw=given["quat_xyzw"]), given["name"]
    if given["type"] == "box":
        return cs.Box(given["size"], place, name)
    if given["type"] == "sphere":
        return cs.Sphere(given["radius"], place, name)
    radius, length = given["radius"], given["length"]
    if as_box:
        return cs.Box([2 * radius, 2 * radius, length], place, name)
    return cs.Capsule(radius, length, place, name)
