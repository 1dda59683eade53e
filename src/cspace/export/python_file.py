"""One arm as a Python file that needs numpy alone: the arm's numbers and the modules that solve its kind."""

from __future__ import annotations

import ast
import itertools
import re
from pathlib import Path
from typing import Any

import numpy as np

from cspace.export.arm import ExportedArm
from cspace.export.words import filled
from cspace.tolerances import ON_LIMIT

__all__ = ["METHODS", "python_file", "python_method"]

PACKAGE = "cspace.export.python"
EXACT, SKEW = 1e-12, 1e-3
"""Sines below and above which axes count as parallel, and not; arms in between are left to samples."""
WITH_WRIST = 1
THREE_PARALLEL = 2

# The modules of a method, in the order in which they are written down.
CLOSED = ("base", "steps", "closed")
METHODS = {
    "wrist": (*CLOSED, "places", "with_wrist"),
    "three_parallel": (*CLOSED, "three_parallel"),
    "two_turns": (*CLOSED, "two_turns"),
    "companion": ("base", "sampled", "companion"),
    "short": ("base", "short"),
    "turns_first": ("base", "turns_first"),
    "sampled": ("base", "sampled"),
}
WORDS = {
    "companion": "all solutions by the eigenvalues of a 24 x 24 matrix",
    "sampled": "a sample of solutions by descents from many starts",
    "short": "all solutions, directly",
    "turns_first": "all solutions, the turns first and the slides by linear equations",
}
SOLVERS = {
    "companion": "solve_by_companion",
    "sampled": "solve_by_sample",
    "short": "solve_short",
    "turns_first": "solve_turns_first",
}


def python_file(arm: ExportedArm) -> str:
    """The text of the file."""
    method = method_of(arm)
    modules = [module_source(name) for name in (*METHODS[method], *["held"] * bool(arm.held))]
    body = "\n\n".join(without_imports(source) for source in modules)
    words: dict[str, Any] = {
        "name": arm.identifier,
        "title": arm.title,
        "version": arm.version,
        "method": python_method(arm),
        "imports": "\n".join(standard_imports(modules)),
        "body": body,
        "arm": literal(numbers(arm.solved, method), 1),
        "free_turns": 'ARM["free_turns"] = free_turns\n' if method == "three_parallel" else "",
        "branches": "branches" if method in ("wrist", "three_parallel", "two_turns") else "None",
        "joint_names": repr(list(arm.joint_names)),
        "lower": literal(np.array(arm.lower), 0),
        "upper": literal(np.array(arm.upper), 0),
        "on_limit": ON_LIMIT,
        "dof": arm.dof,
        **python_words_of_held(arm),
    }
    return filled("module.py.in", words)


def python_words_of_held(arm: ExportedArm) -> dict[str, str]:
    """The words about joints whose values the caller gives, and how the solver is called."""
    solver = SOLVERS.get(method_of(arm), "solve_closed")
    if not arm.held:
        none = dict.fromkeys(("fixed_sample", "fixed_of_q", "fixed_parameter", "fixed_words", "held_arm"), "")
        return {**none, "whole": "ARM", "solve": f"{solver}(ARM, goal, rest)"}
    count, held = len(arm.held), list(arm.held)
    whole = "ARM" if arm.moving is None else "WHOLE"
    lines = f"HELD = {held}  # {arm.held_names}\n"
    if arm.moving:
        lines += f"WHOLE: dict[str, Any] = {literal(numbers(arm, 'sampled'), 1)}\n"
    values = f"values_of(fixed, {count})"
    of_q = ", ".join(f"q[{k}]" for k in held)
    return {
        "fixed_sample": ", fixed",
        "fixed_of_q": f", [{of_q}]",
        "fixed_parameter": "fixed: npt.ArrayLike, ",
        "fixed_words": f"    fixed ({count},): the values of the held joints, {arm.held_names}.\n",
        "held_arm": lines,
        "whole": whole,
        "solve": f"solve_held({solver}, ARM, {whole}, HELD, {values}, goal, rest)",
    }


def python_method(arm: ExportedArm) -> str:
    """How the file solves the arm, as half a sentence."""
    how = WORDS.get(method_of(arm), "all solutions in closed form")
    return f"{how}, with {arm.held_names} held" if arm.held else how


def method_of(arm: ExportedArm) -> str:
    """How the file solves the arm."""
    arm = arm.solved
    if arm.kind == "closed":
        family = arm.plan["family"]
        return {WITH_WRIST: "wrist", THREE_PARALLEL: "three_parallel"}.get(family, "two_turns")
    if arm.kind == "short":
        return "short"
    if arm.kind == "general" and can_turn_first(arm):
        return "turns_first"
    turning = arm.dof == 6 and "P" not in arm.joint_types
    alone = arm.kind == "general" and turning and arm.plan["plan"]["regular"] > 0
    return "companion" if alone and not arm.plan["has_neighbours"] else "sampled"


def can_turn_first(arm: ExportedArm) -> bool:
    """Whether slides take care of the position: up to three turns, about different directions or all about
    one with slides along it.
    """
    h = np.asarray(arm.axes)
    slides = np.array([kind == "P" for kind in arm.joint_types])
    turns = h[~slides]
    sines = [float(np.linalg.norm(np.cross(a, b))) for a, b in itertools.pairwise(turns)]
    if len(turns) > 3 or not slides.any():
        return False
    if len(turns) == 3 and max(sines) < EXACT:
        along = all(np.linalg.norm(np.cross(axis, turns[0])) < EXACT for axis in h)
        return along and apart(np.asarray(arm.points)[~slides], turns[0])
    return min(sines, default=1.0) > SKEW


def apart(points: Any, axis: Any) -> bool:
    """Whether neighbouring parallel axes stand apart."""
    steps = np.linalg.norm(np.cross(np.diff(points, axis=0), axis), axis=1)
    return bool(steps.min() > SKEW * steps.max())


def numbers(arm: ExportedArm, method: str) -> dict[str, Any]:
    """What the file's functions know of the arm."""
    if arm.kind == "closed" and method != "sampled":
        plan: Any = {key: arm.plan[key] for key in arm.plan if key not in ("chain", "polish", "on_lanes")}
        length = plan["form"]["length"]
    else:
        plan = arm.plan["plan"] if method == "companion" else {}
        length = arm.plan["plan"]["length"] if arm.kind == "general" else size_of(arm)
        plan = {key: plan[key] for key in ("frames", "order") if key in plan}
    return {
        "axes": np.asarray(arm.axes),
        "points": np.asarray(arm.points),
        "slides": np.array([kind == "P" for kind in arm.joint_types]),
        "T_zero": np.asarray(arm.T_zero),
        "length": float(length),
        "plan": plain(plan),
    }


def size_of(arm: ExportedArm) -> float:
    """A length typical of the arm [m]."""
    reach = np.abs(np.vstack([arm.points, arm.T_zero[:3, 3]]) - arm.points[0]).max()
    return float(reach) or 1.0


def plain(value: Any) -> Any:
    """The core's structures as numpy keeps them: poses (4, 4), vectors (3,), turns as complex numbers."""
    if not isinstance(value, dict):
        return [plain(entry) for entry in value] if isinstance(value, list) else value
    keys = set(value)
    if keys == {"R", "t"}:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = value["R"]["m"], plain(value["t"])
        return T
    if keys == {"x", "y", "z"}:
        return np.array([value["x"], value["y"], value["z"]])
    if keys == {"c", "s"}:
        return complex(value["c"], value["s"])
    return {key: plain(entry) for key, entry in value.items()}


def literal(value: Any, depth: int) -> str:
    """A value as Python source."""
    inside = "    " * depth
    if isinstance(value, dict):
        lines = [f"{inside}{key!r}: {literal(entry, depth + 1)},\n" for key, entry in value.items()]
        return "{\n" + "".join(lines) + "    " * (depth - 1) + "}"
    if isinstance(value, np.ndarray):
        return f"np.array({listed(value.tolist())})"
    return listed(value) if isinstance(value, list) else repr(value)


def listed(value: Any) -> str:
    """Nested lists of numbers; infinities as numpy names them."""
    if isinstance(value, list):
        return "[" + ", ".join(map(listed, value)) + "]"
    if isinstance(value, np.ndarray):
        return literal(value, 0)
    return re.sub(r"\binf\b", "np.inf", repr(value))


def module_source(name: str) -> str:
    return (Path(__file__).parent / "python" / f"{name}.py").read_text(encoding="utf-8")


def without_imports(source: str) -> str:
    """A module's text after its imports and its list of names, its docstring as a comment."""
    tree = ast.parse(source)
    end = max(node.end_lineno or 0 for node in tree.body if is_preamble(node))
    title = "\n".join(f"# {line}".rstrip() for line in (ast.get_docstring(tree) or "").splitlines())
    body = "\n".join(source.splitlines()[end:]).strip("\n")
    return f"{title}\n\n{body}\n"


def is_preamble(node: ast.stmt) -> bool:
    """Whether a statement imports something or is __all__."""
    names = [ast.unparse(target) for target in node.targets] if isinstance(node, ast.Assign) else []
    return isinstance(node, (ast.Import, ast.ImportFrom)) or "__all__" in names


def standard_imports(modules: list[str]) -> list[str]:
    """The imports of all modules but those of each other, each once."""
    lines: set[str] = set()
    for source in modules:
        for node in ast.parse(source).body:
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                lines.add(ast.unparse(node))
    own = {line for line in lines if PACKAGE in line or "__future__" in line}
    return sorted(lines - own, key=lambda line: ("numpy" in line, line))
