"""The data of a robot that an export needs."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type, shown
from cspace.export.texts import in_ascii
from cspace.ik.conditions import NoClosedFormError, explain_missing_form
from cspace.ik.locked_joints import between_others, joint_number
from cspace.ik.solver import MAX_SETTLED, HasSolver, Solver, as_solver
from cspace.model import Chain
from cspace.tolerances import ON_LIMIT

# Words that cannot name a namespace in C++ or a prefix in C.
TAKEN = frozenset(
    [
        *("alignas", "alignof", "asm", "auto", "bool", "case", "catch", "char", "const", "constexpr"),
        *("decltype", "default", "delete", "detail", "do", "double", "enum", "explicit", "export", "extern"),
        *("float", "friend", "goto", "inline", "int", "long", "main", "mutable", "namespace", "new"),
        *("noexcept", "nullptr", "operator", "private", "protected", "public", "register", "short", "signed"),
        *("sizeof", "static", "std", "struct", "switch", "template", "this", "throw", "typedef", "typeid"),
        *("typename", "union", "unsigned", "using", "virtual", "void", "volatile", "xor"),
        *("and_eq", "bitand", "bitor", "char8_t", "char16_t", "char32_t", "co_await", "co_return"),
        *("co_yield", "compl", "concept", "const_cast", "consteval", "constinit", "dynamic_cast", "false"),
        *("friend", "mutable", "not_eq", "or_eq", "reinterpret_cast", "requires", "restrict"),
        *("static_assert", "static_cast", "thread_local", "true", "typeof", "wchar_t", "xor_eq"),
    ]
)
# Macros of the standard headers of C and C++, and of compilers.
MACROS = frozenset(
    [
        *("assert", "complex", "errno", "i386", "imaginary", "linux", "math_errhandling", "noreturn"),
        *("offsetof", "setjmp", "signals", "slots", "stderr", "stdin", "stdout", "unix"),
        *("BUFSIZ", "DOMAIN", "EDOM", "EILSEQ", "EOF", "ERANGE", "FALSE", "I", "INFINITY", "NAN", "NDEBUG"),
        *("NULL", "OVERFLOW", "SING", "TRUE", "UNDERFLOW"),
    ]
)
MACRO_FAMILIES = re.compile(
    "(CHAR|CLOCKS|DBL|DECIMAL|EXIT|FE|FILENAME|FLT|FOPEN|FP|HUGE|INT|INTMAX|INTPTR|L|LC|LDBL|LLONG|LONG|M|MATH|"
    "MB|PTRDIFF|RAND|SCHAR|SEEK|SHRT|SIG|SIZE|TMP|U|UCHAR|UINT|UINTMAX|UINTPTR|ULLONG|ULONG|USHRT|WCHAR|WINT)"
    "_[A-Z0-9_]+|U?INT(_LEAST|_FAST)?(8|16|32|64)_(MIN|MAX|C)|SIG[A-Z]+|(PRI|SCN)[diouxX][A-Z0-9]+"
)
"""INT_MAX, M_PI, UINT64_C, SIGINT, PRId64 and the like."""

METHODS = {
    "closed": "solved in closed form",
    "general": "solved by elimination of all joint angles but one",
    "few_joints": "solved directly",
    "any": "solved by a plan computed when the program starts",
    "locked": "solved by a plan computed in every call, for the values of the locked joints",
}


@dataclass(frozen=True)
class ExportedArm:
    """kind: a key of METHODS; plan: the numbers of that solver, named as in the headers; identifier: its name
    in C++. locked: the joints whose values are arguments, by number from 0; moving: the arm of the other
    joints, with the locked ones at zero, if these are at the ends.
    """

    solver: Solver
    identifier: str
    kind: str
    plan: dict[str, Any]
    locked: tuple[int, ...] = ()
    moving: ExportedArm | None = None

    @property
    def chain(self) -> Chain:
        """Its joints as screws."""
        return self.solver.chain

    @property
    def room(self) -> int:
        """The largest number of solutions."""
        return 8 if self.kind == "few_joints" else 16

    @property
    def title(self) -> str:
        """Its name, for comments of any language."""
        printed = re.sub(r'[^ -~]|["\\*]', "", in_ascii(" ".join(str(self.solver.name).split())))
        return " ".join(printed.split()) or "arm"

    @property
    def words(self) -> dict[str, Any]:
        """The $words of every language."""
        about = {"name": self.identifier, "title": self.title, "version": _core.__version__}
        return about | {"dof": self.solver.dof, "on_limit": ON_LIMIT}

    @property
    def solved(self) -> ExportedArm:
        """The arm that the solver works on: without the locked joints at the ends."""
        return self.moving or self

    @property
    def method(self) -> str:
        """The method of its solver, as a clause."""
        if not self.locked:
            return METHODS[self.kind]
        return f"{METHODS[self.kind]}, with {self.locked_names} locked"

    @property
    def locked_names(self) -> str:
        """The locked joints, for comments of any language."""
        return ", ".join(
            re.sub(r"[^\w .:/-]|/(?=/)", "", in_ascii(self.solver.joint_names[k])) for k in self.locked
        )


def exported_arm(robot: HasSolver, name: str | None, locked: Any = None) -> ExportedArm:
    """The robot as data for an export. locked: names or numbers of the joints whose values are arguments.

    Raises NoClosedFormError and InputError.
    """
    solver = as_solver(robot)
    chosen = checked_locked_joints(solver, locked)
    identifier = check_name(name) if name is not None else identifier_from(solver.name)
    if not chosen:
        return ExportedArm(solver, identifier, *numbers_of(solver))
    if between_others(solver.dof, chosen):
        return ExportedArm(solver, identifier, "locked", {}, chosen)
    others = solver.lock(dict.fromkeys(chosen, 0.0))
    kind, plan = numbers_of(others)
    return ExportedArm(solver, identifier, kind, plan, chosen, ExportedArm(others, "moving", kind, plan))


def numbers_of(solver: Solver) -> tuple[str, dict[str, Any]]:
    """The kind of the solver and its numbers; NoClosedFormError if the arm is redundant."""
    if solver.is_redundant:
        raise NoClosedFormError(explain_missing_form(solver))
    return _core._ik_numbers(solver)


def vector_field(v: Array) -> dict[str, float]:
    """A vector as a field of the headers."""
    return {axis: float(x) for axis, x in zip("xyz", v, strict=True)}


def checked_locked_joints(solver: Solver, locked: Any) -> tuple[int, ...]:
    """The joints to lock, by number, ascending: the given ones, else those that the solver chooses."""
    joints = len(solver.joint_names)
    if locked is None:
        return solver.redundant_joints if solver.is_redundant else ()
    if isinstance(locked, (str, int)):
        locked = [locked]
    if isinstance(locked, Mapping) or not isinstance(locked, Iterable) or getattr(locked, "ndim", 1) == 0:
        raise InputTypeError(
            f"locked is {name_type(locked)}, expected joint names; their values are arguments of each call"
        )
    chosen = [joint_number(solver, key, "locked") for key in locked]
    if len(set(chosen)) < len(chosen):
        raise InputError(
            f"locked is {list(chosen)}, by number from 0, and names a joint twice; name each joint once"
        )
    if not 1 <= joints - len(chosen) <= MAX_SETTLED:
        raise InputError(
            f"locked names {len(chosen)} of {joints} joints; 1 to {MAX_SETTLED} must remain unlocked"
        )
    return tuple(sorted(chosen))


def check_name(name: str) -> str:
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or is_taken(name):
        raise InputError(
            f"name is {shown(name)}, expected a letter, then letters, digits and single underscores, "
            "and no keyword of C++ or Python or macro of their headers"
        )
    return name


def identifier_from(name: str) -> str:
    """The name of a robot as an identifier; every other character becomes an underscore."""
    word = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9]", "_", name)).strip("_").lower()
    if not word or not word[0].isalpha():
        word = f"arm_{word}".rstrip("_")
    return f"{word}_arm" if is_taken(word) else word


def is_taken(word: str) -> bool:
    is_macro = word in MACROS or MACRO_FAMILIES.fullmatch(word) is not None
    return word in TAKEN or is_macro or keyword.iskeyword(word) or "__" in word
