"""Every answer has a one-line representation; tables of notebooks are well-formed."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Mapping, ValuesView
from dataclasses import fields, is_dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import cspace as cs
from cspace import navigation, trajectory
from cspace.search import Planner
from cspace.tables import LONGEST_LINE, MOST_ROWS, html_table, list_fields, markdown_table, one_line

ROOMS = ("ik", "kinematics", "navigation", "model", "export", "maps", "search", "robot")
WORLD = cs.PolygonWorld([[(2, 2), (4, 2), (4, 4)]], (0, 0, 10, 10))
GRID = cs.OccupancyGrid(np.zeros((12, 12), dtype=bool), 1.0)


def arm_answers():
    """Answers about arms, also of many joints with long names."""
    out = []
    for name in ("ur5e", "panda", "planar_3r", "yumi_l", "icub_right_arm"):
        if name not in cs.robots.names():
            continue
        robot = cs.load_robot(name)
        q = np.full(robot.dof, 0.3)
        T = robot.fk(q)
        far = T + 50.0 * np.eye(4, k=3)
        found = [robot.ik(T), robot.ik(far), robot.ik(np.stack([T, far])), robot.ik(position=T[:3, 3])]
        out += [*found, *found[0].self_motions, robot, robot.solver, robot.limits, robot.chain]
        out += [robot.singularity(q), robot.singularity(0 * q), robot.manipulability_ellipsoid(q)]
        out += [robot.manipulability_ellipsoid([q, q]), robot.workspace(100, rng=0), robot.description]
        track = robot.track(np.stack([robot.fk(q + 0.01 * k) for k in range(4)]))
        out += [track, *track.branches, robot.ik_plan(), robot.ik_numeric(T, 0 * q), robot.ik_numeric(far, q)]
        out += [robot.ik_many_starts(T, starts=8, rng=0), robot.link_matrices(), robot.export("cpp")]
        out += [robot.to_dh(convention=word) for word in ("standard", "modified")]
        if robot.dof == 7:
            redundancy = robot.redundancy(T)
            out += [redundancy, *redundancy.intervals]
    robot = cs.load_robot("ur5e")
    singular = robot.ik(robot.fk([0.1, 0.2, 0.3, 0.4, 0.0, 0.5]))
    task = cs.ik.PoseTask("tool0", robot.fk(np.full(6, 0.3)))
    return [*out, singular, *singular.self_motions, robot.ik_tasks([task], np.zeros(6))]


def plane_answers():
    """Routes of every planner of worlds of polygons and of grids, with their traces and evidence."""
    out = [WORLD, GRID]
    for name in navigation.PLANNERS:
        for world in (WORLD, GRID):
            try:
                route = cs.navigate(world, (1.5, 1.5), (9.5, 9.5), planner=name)
            except cs.CspaceError:  # a planner of the other kind of world, or one that needs an option
                continue
            out += [route, route.stats, route.trace, route.evidence]
    run = navigation.follow([[0, 0], [5, 0], [8, 3]])
    car = navigation.hybrid_a_star(GRID, (1.5, 1.5, 0.0), (6.5, 2.0, 0.0))
    return [*out, run, car, car.curve, navigation.coverage(GRID, (1.5, 1.5))]


@pytest.fixture(scope="module")
def answers():
    return [*arm_answers(), *plane_answers()]


def test_every_answer_is_represented_by_one_short_line(answers):
    for answer in answers:
        line = repr(answer)
        assert "\n" not in line, (type(answer), line)
        assert len(line) <= LONGEST_LINE, (type(answer), line)


def test_every_kind_of_answer_is_examined(answers):
    """An answer has a reason: what a room exports with that property stands in the list above."""
    kinds = {type(answer) for answer in answers}
    for room in ROOMS:
        module = importlib.import_module(f"cspace.{room}")
        for name in getattr(module, "__all__", ()):
            thing = getattr(module, name)
            if inspect.isclass(thing) and isinstance(getattr(thing, "reason", None), property):
                assert thing in kinds, name


def test_tables_of_answers_are_well_formed(answers):
    tables = 0
    for answer in answers:
        if hasattr(answer, "_repr_html_"):
            body = ElementTree.fromstring(f"<div>{answer._repr_html_()}</div>")
            widths = {len(row) for row in body.iter("tr")}
            assert len(widths) == 1, type(answer)
            tables += 1
        if hasattr(answer, "_repr_markdown_"):
            assert "|---|" in answer._repr_markdown_() or "$$" in answer._repr_markdown_()
            tables += 1
    assert tables > 20


def test_cells_are_escaped_and_long_tables_end_with_a_count():
    rows = [[f"<{k}>", "a & b"] for k in range(MOST_ROWS + 3)]
    text = html_table("x < y", ["a", "b"], rows)
    body = ElementTree.fromstring(f"<div>{text}</div>")
    assert len(list(body.iter("tr"))) == 1 + MOST_ROWS
    assert next(body.iter("td")).text == "<0>"
    assert "and 3 more rows" in text
    assert markdown_table(["a", "b"], [["1", "2"]]) == "| a | b |\n|---|---|\n| 1 | 2 |"


def test_a_long_line_ends_with_an_ellipsis():
    assert one_line("Kind", "two\n  lines") == "<Kind two lines>"
    line = one_line("Kind", "word " * 50)
    assert len(line) <= LONGEST_LINE
    assert line.endswith("…>")


# Classes that nobody gets as an answer: bases of others, and those that Markdown shows.
BASES = {"HasSolver", "KinematicModel", "MotionNoise", "WheelBase"}
UNEXAMINED = {"plot", "cli", "errors", "files", "tables"}


def public_classes():
    """Every class that a room offers, errors aside, with its room."""
    for path in sorted((Path(cs.__file__).parent).iterdir()):
        room = path.stem
        if room in UNEXAMINED or room.startswith(("_", ".")) or not (path.is_dir() or path.suffix == ".py"):
            continue
        module = importlib.import_module(f"cspace.{room}")
        for name in getattr(module, "__all__", ()):
            thing = getattr(module, name)
            if inspect.isclass(thing) and not issubclass(thing, BaseException) and name not in BASES:
                yield room, thing


def has_short_fields(kind):
    """Whether the representation that dataclasses make cannot be long: numbers, choices and options alone."""
    return all(re.fullmatch(r"(float|int|bool|str|None|[| ])+", str(f.type)) for f in fields(kind) if f.repr)


@pytest.mark.parametrize(
    ("room", "kind"), [pytest.param(*x, id=f"{x[0]}.{x[1].__name__}") for x in public_classes()]
)
def test_every_public_class_has_a_line_and_a_table(room, kind):
    assert kind.__repr__ is not object.__repr__
    assert hasattr(kind, "_repr_html_") or hasattr(kind, "_repr_markdown_")
    if is_dataclass(kind) and hasattr(kind.__repr__, "__wrapped__"):
        assert issubclass(kind, Planner) or has_short_fields(kind), "show_fields makes its line"


def parts_of(answer, depth=3):
    """What the fields of an answer contain, objects of this library alone."""
    yield answer
    names = [n for n in dir(type(answer)) if isinstance(inspect.getattr_static(type(answer), n), property)]
    names = [*names, *list_fields(answer)] if depth else []
    for name in names:
        if name.startswith("_"):
            continue
        try:
            value = getattr(answer, name)
        except (cs.CspaceError, AttributeError):
            continue
        values = value.values() if isinstance(value, Mapping) else value
        values = values if isinstance(values, (list, tuple, ValuesView)) else (value,)
        for part in list(values)[:3]:
            if type(part).__module__.startswith("cspace"):
                yield from parts_of(part, depth - 1)


def motions():
    """Motions that exist and those that do not, with what they follow."""
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.4, -0.8, 0.7, 0.1])
    path = cs.spline([q, q + 0.2, q - 0.1])
    there = robot.fk(q + 0.05)
    line, far = (trajectory.line_path(robot.fk(q), T) for T in (there, cs.pose(xyz=[9.0, 0, 0]) @ there))
    jerky = trajectory.state_to_state([0, 0], [1, 2], velocity=1, acceleration=2, jerk=9)
    batch = trajectory.state_to_state(np.zeros((2, 1)), np.ones((2, 1)), velocity=1, acceleration=2)
    timed = cs.time_parametrize(path, robot, acceleration=4)
    out = [
        path,
        timed,
        line,
        jerky,
        batch,
        timed.check(robot.limits),
        trajectory.JoinedTrajectory([jerky, jerky]),
    ]
    return [*out, *(cs.cartesian.move_cartesian(robot, way, q, acceleration=4) for way in (line, far))]


def test_what_answers_are_made_of_has_lines_and_tables_too():
    robot = cs.load_robot("ur5e")
    panda = cs.load_robot("panda")
    catalogue = cs.robots.rows()
    wholes = [robot.description, robot.ik_plan(), panda.ik_plan(), robot.collision, robot.link_matrices()]
    wholes += [catalogue[0], robot.ik_plan().tables, cs.LaserScanner(), cs.Scene([cs.Sphere(0.1)])]
    wholes += [
        robot.collision.shapes,
        robot.collision.compiled,
        cs.spatial.screw_of(robot.fk(np.full(6, 0.3))),
    ]
    wholes += [robot.clearance(np.full(6, 0.3)), robot.edge(np.zeros(6), np.full(6, 0.1))]
    wholes += [robot.ik(robot.fk(np.full((2, 6), 0.3))), cs.plan(robot, np.zeros(6), np.full(6, 0.1))]
    wholes += motions()
    seen = 0
    for whole in wholes:
        for part in parts_of(whole):
            line = repr(part)
            if type(part).__name__ in ("CatalogueRows", "mappingproxy", "dict"):
                continue
            assert "\n" not in line, type(part)
            assert len(line) <= LONGEST_LINE, (type(part), line)
            assert " object at 0x" not in line, line
            if hasattr(part, "_repr_html_"):
                ElementTree.fromstring(f"<div>{part._repr_html_()}</div>")
            seen += 1
    assert seen > 100
