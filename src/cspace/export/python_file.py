"""One arm as a Python file that needs only numpy: the numbers of the arm and its closed form."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

import numpy as np

from cspace.export.arm import ExportedArm
from cspace.export.python_steps import python_steps
from cspace.export.texts import fill_template
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.geometry import as_arrays

PACKAGE = "cspace.export.python"
IMPORTS = (ast.Import, ast.ImportFrom)

# The modules of each kind of arm, in the order in which they are written.
MODULES = {"closed": ("base", "steps", "closed"), "few_joints": ("base", "few_joints")}


def python_file(arm: ExportedArm) -> str:
    """The text of the file; NoClosedFormError for an arm without a closed form."""
    check_method(arm)
    names = (*MODULES[arm.solved.kind], *["locked_joints"] * bool(arm.locked))
    modules = [
        (Path(__file__).parent / "python" / f"{name}.py").read_text(encoding="utf-8") for name in names
    ]
    body = "\n\n".join(without_imports(source) for source in modules)
    words: dict[str, Any] = {
        **arm.words,
        "method": python_method(arm),
        "imports": "\n".join(standard_imports(modules)),
        "body": body,
        "arm": literal(numbers(arm.solved), 1),
        "steps": python_steps(arm.solved) if arm.solved.kind == "closed" else "",
        "joint_names": repr(list(arm.solver.joint_names)),
        "lower": literal(arm.solver.limits.lower, 0),
        "upper": literal(arm.solver.limits.upper, 0),
        **python_words_of_locked(arm),
    }
    return fill_template("module.py.in", words)


def python_words_of_locked(arm: ExportedArm) -> dict[str, str]:
    """The values of the $words about locked joints, and the call of the solver."""
    solver = "solve_few_joints" if arm.solved.kind == "few_joints" else "solve_closed"
    count, chosen = len(arm.locked), list(arm.locked)
    lines = f"LOCKED = {chosen}  # {arm.locked_names}\n"
    lines += f"WHOLE: dict[str, Any] = {literal(chain_numbers(arm), 1)}\n"
    words = {
        "locked_sample": ", locked",
        "locked_of_q": f", [{', '.join(f'q[{k}]' for k in chosen)}]",
        "locked_parameter": "locked: npt.ArrayLike, ",
        "locked_words": f"    locked ({count},): the values of the locked joints, {arm.locked_names}.\n",
        "locked_arm_source": lines,
    }
    if not arm.locked:
        return {**dict.fromkeys(words, ""), "whole": "ARM", "solve": f"{solver}(ARM, goal, rest)"}
    solve = f"solve_locked({solver}, ARM, WHOLE, LOCKED, values_of(locked, {count}), goal, rest)"
    return {**words, "whole": "WHOLE", "solve": solve}


def python_method(arm: ExportedArm) -> str:
    """The method of the file, as a clause."""
    how = "all solutions, directly" if arm.solved.kind == "few_joints" else "all solutions in closed form"
    return f"{how}, with {arm.locked_names} locked" if arm.locked else how


def check_method(arm: ExportedArm) -> None:
    """Raise NoClosedFormError for an arm without a closed form."""
    if arm.solved.kind not in MODULES:
        chosen = f" with {arm.locked_names} locked" if arm.locked else ""
        raise NoClosedFormError(
            f"{arm.title}{chosen} has no closed form, and a Python file can contain only closed forms; "
            "export it with lang='cpp' or lang='c'"
        )


def numbers(arm: ExportedArm) -> dict[str, Any]:
    """The data of the arm that the functions of the file use."""
    if arm.kind == "few_joints":
        return {**chain_numbers(arm), "length": size_of(arm)}
    plan = as_arrays(arm.plan)
    form = {name: plan["form"][name] for name in ("offset", "base", "tool", "deviation")}
    form |= {name: plan[name] for name in ("joint", "sign", "reversed", "idealised", "virtual_joints")}
    return {**chain_numbers(arm), "length": float(plan["form"]["length"]), "form": form}


def chain_numbers(arm: ExportedArm) -> dict[str, Any]:
    """The product of exponentials."""
    chain = arm.chain
    slides = np.array([kind == "P" for kind in chain.joint_types])
    return {"axes": chain.axes, "points": chain.points, "slides": slides, "T_zero": chain.T_zero}


def size_of(arm: ExportedArm) -> float:
    """A length typical of the arm [m]."""
    points = arm.chain.points
    reach = np.abs(np.vstack([points, arm.chain.T_zero[:3, 3]]) - points[0]).max()
    return float(reach) or 1.0


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


def without_imports(source: str) -> str:
    """A module's text after its imports, its docstring as a comment."""
    tree = ast.parse(source)
    end = max(node.end_lineno or 0 for node in tree.body if isinstance(node, IMPORTS))
    title = "\n".join(f"# {line}".rstrip() for line in (ast.get_docstring(tree) or "").splitlines())
    body = "\n".join(source.splitlines()[end:]).strip("\n")
    return f"{title}\n\n{body}\n"


def standard_imports(modules: list[str]) -> list[str]:
    """The imports of all modules but those of each other, each once."""
    nodes = (node for source in modules for node in ast.parse(source).body if isinstance(node, IMPORTS))
    lines = {line for line in map(ast.unparse, nodes) if PACKAGE not in line and "__future__" not in line}
    return sorted(lines, key=lambda line: ("numpy" in line, line))
