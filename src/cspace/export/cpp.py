"""One arm as one self-contained C++17 header, and as a C99 header with one C++17 file."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePath
from string import Template
from typing import Any

from cspace.errors import CspaceError, InputError
from cspace.export.arm import ExportedArm, vector_field
from cspace.export.texts import fill_template, in_ascii, read_template

TABLES_AT_START = "#define CSPACE_TABLES_AT_START\n\n"
"""Tables are computed when the program starts; on first use they would need the C++ run-time library."""

ENUMS = {"family": "ik::Family", "kind": "ik::PieperCase"}
INFINITY = "std::numeric_limits<double>::infinity()"


def cpp_header(arm: ExportedArm, *, one_file: bool = False) -> str:
    """The text of the header: the arm's numbers, the headers of the core that solve it, the interface.

    one_file: only one file of the program will include it, and link without the run-time library of C++.
    """
    words = {**words_of(arm), "storage": "static" if one_file else "inline"}
    headers, code = solver_source(arm)
    code = Template(code).substitute(words, plan=write_initialiser(plan_of(arm)))
    if arm.moving:
        around = {
            **words,
            "solver": code,
            "plan": write_initialiser(chain_of(arm)),
            "moving_room": arm.moving.room,
        }
        code = fill_template("solve_locked_joints.hpp.in", around)
    core = TABLES_AT_START * one_file + in_ascii(amalgamate_headers(headers))
    solve = f"namespace cspace {{\n\n{code}\n}}  // namespace cspace\n"
    parts = [core, fill_template("types.hpp.in", words), solve, fill_template("interface.hpp.in", words)]
    text = rename_core("\n".join(parts), words)
    undefined = "".join(f"#undef {macro}\n" for macro in left_macros(text, words["MACRO"]))
    return f"{fill_template('head.hpp.in', words)}\n{text}\n{undefined}\n#endif\n"


def c_files(arm: ExportedArm, header: str) -> dict[str, str]:
    """File names and texts: the header and the source."""
    source = PurePath(header).with_suffix(".cpp").name
    words = {**words_of(arm), "source": source, "object": PurePath(header).with_suffix(".o").name}
    body = (
        f'#include "{header}"\n\n{cpp_header(arm, one_file=True)}\n{fill_template("interface.c.in", words)}'
    )
    return {header: fill_template("interface.h.in", words), source: body}


def words_of(arm: ExportedArm) -> dict[str, Any]:
    """The values of the $words in the templates."""
    return {
        **arm.words,
        "method": arm.method,
        "MACRO": f"{arm.identifier.upper()}_IK_",
        "room": arm.room,
        "joint_names": ", ".join(quote_text(name) for name in arm.solver.joint_names),
        "prismatic": write_literal([kind == "P" for kind in arm.chain.joint_types])[1:-1],
        "lower": write_bounds(arm.solver.limits.lower.tolist()),
        "upper": write_bounds(arm.solver.limits.upper.tolist()),
        **words_of_locked(arm),
    }


def words_of_locked(arm: ExportedArm) -> dict[str, Any]:
    """The values of the $words about locked joints; empty texts without locked joints."""
    count, numbers = len(arm.locked), ", ".join(map(str, arm.locked))
    names = arm.locked_names
    moving = [k for k in range(arm.solver.dof) if k not in arm.locked]
    words = {
        "locked_count": count,
        "locked_joints": numbers,
        "moving_count": len(moving),
        "moving_joints": ", ".join(map(str, moving)),
        "locked_types": (
            f"inline constexpr int locked_count = {count}, "
            f"locked_joints[locked_count] = {{{numbers}}};  // {names}\n"
        ),
        "locked_types_c": f"enum {{ {arm.identifier}_locked = {count} }}; /* {names} */\n",
        "locked_extern": f"extern const int {arm.identifier}_locked_joints[{count}];\n",
        "locked_extern_c": f"const int {arm.identifier}_locked_joints[{count}] = {{{numbers}}};\n",
        "locked_of_sample": f"    const double locked_values[] = "
        f"{{{', '.join(f'q[{k}]' for k in arm.locked)}}};\n",
        "locked_parameter": "const double* locked_values, ",
        "locked_argument": "locked_values, ",
        "locked_sample": ", locked_values",
        "locked_of_q": f", [{', '.join(f'q[{k}]' for k in arm.locked)}]",
        "locked_words": (
            f"// locked_values: the values of the locked joints ({names}), "
            f"{count} in the order of locked_joints.\n"
        ),
        "locked_words_c": f"\n * locked_values: the values of the locked joints ({names}), "
        f"{count} in this order.",
    }
    return words if arm.locked else dict.fromkeys(words, "")


def chain_of(arm: ExportedArm) -> dict[str, Any]:
    """The whole arm as a chain of the headers."""
    chain = arm.chain
    return {
        "n": arm.solver.dof,
        "axis": [vector_field(axis) for axis in chain.axes],
        "point": [vector_field(point) for point in chain.points],
        "prismatic": [kind == "P" for kind in chain.joint_types],
        "tip": {"R": {"m": chain.T_zero[:3, :3].tolist()}, "t": vector_field(chain.T_zero[:3, 3])},
    }


def plan_of(arm: ExportedArm) -> dict[str, Any]:
    if arm.kind == "locked":
        return chain_of(arm)
    if arm.kind != "general":
        return arm.plan
    return {**arm.plan, "solve": "&ik::solve_general", "propose": "&ik::propose_solutions"}


def solver_source(arm: ExportedArm) -> tuple[list[str], str]:
    """The headers of the core that solve the arm, and the code that calls them."""
    headers = ["cspace/math/isa.hpp", "cspace/ik/goal.hpp", "cspace/ik/chain.hpp"]
    parts = ["refused", "given", f"solve_{arm.kind}"]
    if arm.kind == "few_joints":
        headers += ["cspace/ik/position/pose.hpp"]
        parts.remove("given")
    elif arm.kind == "general":
        headers += ["cspace/ik/general/singular.hpp", "cspace/ik/self_motion/bifurcations.hpp"]
    elif arm.kind == "closed":
        quick = arm.plan["on_lanes"] and not arm.plan["virtual_joints"]
        headers += ["cspace/ik/self_motion/bifurcations.hpp", *["cspace/ik/fast_path.hpp"] * quick]
        parts.append("solve_closed_fast" if quick else "solve_closed_slow")
    elif arm.kind == "locked":
        headers += ["cspace/ik/redundancy/locked_joints.hpp"]
        parts = ["solve_locked"]
    else:
        headers += ["cspace/ik/arm.hpp"]
    return headers, "\n".join(read_template(f"{part}.hpp.in") for part in parts)


def rename_core(text: str, words: dict[str, Any]) -> str:
    """The namespace and the macros of the core under the name of the arm, so that no names collide.

    The namespace of the instruction set holds all of the core, because C++17 knows no nested inline ones.
    """
    text = text.replace("::inline CSPACE_ISA", "")
    text = re.sub(r"\bcspace\b(?=::|;| \{)", f"{words['name']}::detail::CSPACE_ISA", text)
    return text.replace("CSPACE_", words["MACRO"])


def left_macros(text: str, prefix: str) -> list[str]:
    """The macros that the text defines and does not undefine."""
    defined = set(re.findall(rf"^#define ({prefix}\w+)", text, re.M))
    return sorted(defined - set(re.findall(rf"^#undef ({prefix}\w+)", text, re.M)))


# --- literals of C++ --------------------------------------------------------------------------------------
def write_initialiser(value: Mapping[str, Any]) -> str:
    """An aggregate, one field per paragraph, each with its name as comment."""
    lines = ["{"]
    for name, entry in value.items():
        text = textwrap.wrap(write_literal(entry, name) + ",", 96, break_on_hyphens=False)
        lines += [f"    {text[0]}  // {name}"] if len(text) == 1 else [f"    // {name}"]
        lines += [f"    {line}" for line in text] if len(text) > 1 else []
    return "\n".join([*lines, "}"])


def write_literal(value: Any, name: str = "") -> str:
    """A number, a list or a nested aggregate; text is unchanged."""
    if isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return "{" + ", ".join(write_literal(entry, key) for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "{" + ", ".join(write_literal(entry, name) for entry in value) + "}"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return f"{ENUMS[name]}({value})" if name in ENUMS else str(value)
    if not math.isfinite(value):
        raise InputError(f"{name} of the arm's plan is {value}; an export can contain only finite numbers")
    return repr(float(value))


def write_bounds(values: Iterable[float]) -> str:
    """Limits one after another; infinities where there are none."""
    return ", ".join(repr(v) if math.isfinite(v) else "-" * (v < 0) + INFINITY for v in values)


def quote_text(text: str) -> str:
    """A string literal in plain ASCII: everything else as the octal numbers of its UTF-8."""
    plain = {c: c for c in map(chr, range(32, 127)) if c not in '"\\?'}
    return (
        '"'
        + "".join(
            plain.get(c) or "".join(f"\\{b:03o}" for b in c.encode(errors="backslashreplace")) for c in text
        )
        + '"'
    )


# --- the headers of the core as one text ----------------------------------------------------------------
def include_folder() -> Path:
    """The folder that contains cspace/version.hpp: in the installed package or in the source tree."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "include", package.parents[1] / "include"):
        if (folder / "cspace" / "version.hpp").is_file():
            return folder
    raise CspaceError(f"the C++ headers are not in {package / 'include'}; install cspace again")


def amalgamate_headers(entries: Iterable[str]) -> str:
    """The headers in `entries` and everything that they include, each once, after its own includes."""
    folder = include_folder()
    parts: list[str] = []
    seen: set[str] = set()

    def append_header(name: str) -> None:
        if name in seen:
            return
        seen.add(name)
        own: list[str] = []
        for line in (folder / name).read_text(encoding="utf-8").splitlines():
            if included := re.match(r'#include "(cspace/[^"]+)"', line):
                append_header(included.group(1))
            elif line != "#pragma once":
                own.append(line)
        parts.append(f"// --- {name.removeprefix('cspace/')} ---\n" + "\n".join(own) + "\n")

    for entry in entries:
        append_header(entry)
    return "\n".join(parts)
