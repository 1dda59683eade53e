"""What an export needs to know of a robot, taken from it once."""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass
from typing import Any

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.export.plain import in_ascii
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.prepare import prepare

__all__ = ["ExportedArm", "exported_arm"]

# Words that name no namespace of C++ and no prefix of C.
TAKEN = frozenset(
    [
        *("alignas", "alignof", "asm", "auto", "bool", "case", "catch", "char", "const", "constexpr"),
        *("decltype", "default", "delete", "detail", "do", "double", "enum", "explicit", "export", "extern"),
        *("float", "friend", "goto", "inline", "int", "long", "main", "mutable", "namespace", "new"),
        *("noexcept", "nullptr", "operator", "private", "protected", "public", "register", "short", "signed"),
        *("sizeof", "static", "std", "struct", "switch", "template", "this", "throw", "typedef", "typeid"),
        *("typename", "union", "unsigned", "using", "virtual", "void", "volatile", "xor"),
    ]
)

SETTLED = 6

METHODS = {
    "closed": "solved in closed form",
    "general": "solved by elimination to one joint's angle",
    "short": "solved directly",
    "any": "solved by a plan made when the program starts",
}


@dataclass(frozen=True)
class ExportedArm:
    """kind: how it is solved (closed, general, short, any); plan: the numbers of that solver, named as in the
    headers; room: rows that its solutions may need; identifier: its name as one of C++.
    """

    identifier: str
    title: str
    kind: str
    plan: dict[str, Any]
    dof: int
    room: int
    joint_names: tuple[str, ...]
    joint_types: str
    lower: list[float]
    upper: list[float]
    axes: Array
    points: Array
    T_zero: Array
    version: str = _core.__version__

    @property
    def method(self) -> str:
        """How it is solved, as half a sentence."""
        return METHODS[self.kind]


def exported_arm(robot: Any, name: str | None) -> ExportedArm:
    """The robot as the exports see it; raises NoClosedFormError and InputError."""
    prepare(robot)
    joints = len(robot.chain.joint_types)
    if joints > SETTLED:
        raise NoClosedFormError(
            f"{robot.name} has {joints} joints, more than the {SETTLED} that a pose settles; arms of up to"
            f" {SETTLED} can be exported"
        )
    kind, plan = _core._ik_numbers(robot)
    chain = robot.chain
    return ExportedArm(
        identifier=checked(name) if name is not None else identifier_from(robot.name),
        title=in_ascii(" ".join(str(robot.name).split()).replace("*/", "")) or "arm",
        kind=kind,
        plan=plan,
        dof=len(chain.joint_types),
        room=8 if kind == "short" else 16,
        joint_names=tuple(robot.joint_names),
        joint_types=str(chain.joint_types),
        lower=[float(x) for x in robot.limits.lower],
        upper=[float(x) for x in robot.limits.upper],
        axes=chain.axes,
        points=chain.points,
        T_zero=chain.T_zero,
    )


def checked(name: str) -> str:
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or is_taken(name):
        raise InputError(
            f"name is {name!r}, expected letters, digits and single _, a letter first, and no keyword"
        )
    return name


def identifier_from(name: str) -> str:
    """The name of a robot as an identifier: what is no letter or digit becomes _."""
    word = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9]", "_", name)).strip("_").lower()
    if not word or not word[0].isalpha():
        word = f"arm_{word}".rstrip("_")
    return f"{word}_arm" if is_taken(word) else word


def is_taken(word: str) -> bool:
    return word in TAKEN or keyword.iskeyword(word) or "__" in word
