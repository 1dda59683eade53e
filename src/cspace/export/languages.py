"""The languages that an arm can be exported to."""

from __future__ import annotations

import keyword
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import Any

from cspace.errors import InputError, InputTypeError, Renamed, name_new_keywords, name_type, suggest
from cspace.export.arm import ExportedArm, exported_arm
from cspace.export.cpp import c_files, cpp_header, words_of
from cspace.export.python_file import python_file, python_method
from cspace.export.texts import fill_template
from cspace.files import check_target, path_of, write_text
from cspace.ik.solver import HasSolver
from cspace.tables import html_table, one_line

LANGUAGES = MappingProxyType(
    {
        "cpp": "a C++17 header",
        "c": "a C99 header and a C++17 file",
        "python": "a file that needs only numpy, for closed forms",
    }
)
BY_SUFFIX = MappingProxyType({".hpp": "cpp", ".hh": "cpp", ".hxx": "cpp", ".h": "c", ".py": "python"})
SUFFIXES = MappingProxyType({"cpp": ".hpp", "c": ".h", "python": ".py"})


@dataclass(frozen=True)
class Export(Renamed):
    """An arm as source code. language: one of LANGUAGES; name: the namespace or the prefix; method: how the
    arm is solved; files: the texts by file name, first the one that users include; example: a program that
    uses it; locked: the joints whose values are arguments.
    """

    language: str
    name: str
    method: str
    files: Mapping[str, str]
    example: str
    locked: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return one_line("Export", f"{self.name} in {self.language}, {self.method}: {', '.join(self.files)}")

    def _repr_html_(self) -> str:
        rows = [[name, str(text.count("\n"))] for name, text in self.files.items()]
        return html_table(f"{self.name}: {self.method}", ["file", "lines"], rows)

    def __post_init__(self) -> None:
        object.__setattr__(self, "files", MappingProxyType(dict(self.files)))

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle makes it from again: a view that refuses changes cannot be pickled itself."""
        values = (self.language, self.name, self.method, dict(self.files), self.example, self.locked)
        return type(self), values

    @property
    def text(self) -> str:
        """The file that users include or import."""
        return next(iter(self.files.values()))

    def write(self, folder: str | os.PathLike[str] = ".") -> list[Path]:
        """Write every file into a folder, each whole or not at all; returns their paths.

        Raises InputError where writing is impossible.
        """
        paths = [Path(path_of(folder)) / name for name in self.files]
        for path in paths:  # before the first of them is written
            check_target(path)
        for path, text in zip(paths, self.files.values(), strict=True):
            write_text(path, text)
        return paths

    def write_example(self, path: str | os.PathLike[str]) -> None:
        """Write the program that uses it; raises InputError where writing is impossible."""
        write_text(path, self.example)


@name_new_keywords
def export(
    robot: HasSolver,
    lang: str | None = None,
    path: str | os.PathLike[str] | None = None,
    *,
    name: str | None = None,
    locked: Any = None,
) -> Export:
    """The inverse and forward kinematics of an arm as source code that does not depend on cspace.

    lang: "cpp", "c" or "python"; by default the language of the ending of path, else "cpp". path: where the
    (first) file is written. name: the namespace or the prefix in it; by default derived from the name of the
    robot. locked: joints, by name or number, whose values are arguments of the exported function; by default
    those that the solver chooses if the arm is redundant.

    Raises UnknownNameError for an unknown language, InputError for an invalid name, path or choice of joints,
    and NoClosedFormError for an arm that robot.ik does not solve, or, with lang="python", has no closed form.
    """
    target = None if path is None else PurePath(path_of(path))
    language = language_of(lang, target)
    arm = exported_arm(robot, name, locked)
    main = f"{arm.identifier}_ik{SUFFIXES[language]}" if target is None else target.name
    check_file_name(main, language)
    made = write_out(arm, language, main)
    if target is not None:
        made.write(target.parent)
    return made


def language_of(lang: str | None, target: PurePath | None) -> str:
    """The given language, or that of the file's ending."""
    if lang is None:
        if target is None:
            return "cpp"
        if target.suffix not in BY_SUFFIX:
            raise InputError(
                f"the ending of {target.name!r} is not that of a language; "
                f"known endings: {', '.join(BY_SUFFIX)}; select the language with lang="
            )
        return BY_SUFFIX[target.suffix]
    if not isinstance(lang, str):
        raise InputTypeError(f"lang is {name_type(lang)}, expected one of {', '.join(LANGUAGES)}")
    if lang not in LANGUAGES:
        raise suggest("language", lang, LANGUAGES)
    return lang


def check_file_name(name: str, language: str) -> None:
    """Raise InputError for names that an #include or an import cannot contain."""
    if not name:
        raise InputError("path is empty, expected the name of a file")
    if not name.isprintable() or set(name) & set('"\\'):
        raise InputError(
            f"the file name {name!r} contains characters that are not allowed in an #include; "
            "use printable characters without quotes and backslashes"
        )
    stem, suffix = PurePath(name).stem, PurePath(name).suffix
    if language == "c" and suffix == ".cpp":
        raise InputError(
            f"the file name {name!r} ends in .cpp, which is reserved for the second file; use the ending .h"
        )
    if language == "python" and (not stem.isidentifier() or keyword.iskeyword(stem) or suffix != ".py"):
        raise InputError(
            f"the file name {name!r} is not that of a module; expected letters, digits, underscores, then .py"
        )


def write_out(arm: ExportedArm, language: str, main: str) -> Export:
    if language == "c":
        files = c_files(arm, main)
    else:
        files = {main: cpp_header(arm) if language == "cpp" else python_file(arm)}
    ending = {"cpp": ".cpp", "c": ".c", "python": ".py"}[language]
    words = {**words_of(arm), "header": main, "file": f"main{ending}", "sample": sample_configuration(arm)}
    words["source"] = PurePath(main).with_suffix(".cpp").name
    words["object"] = PurePath(main).with_suffix(".o").name
    words["module"] = PurePath(main).stem
    example = fill_template(f"example{ending}.in", words)
    chosen = tuple(arm.solver.joint_names[k] for k in arm.locked)
    method = python_method(arm) if language == "python" else arm.method
    return Export(language, arm.identifier, method, files, example, chosen)


def sample_configuration(arm: ExportedArm) -> str:
    """An irregular configuration inside the limits, as a list of numbers."""
    values = []
    for i, (lower, upper) in enumerate(zip(*arm.solver.limits.range.tolist(), strict=True)):
        low, high = max(lower, -2.0), min(upper, 2.0)
        values.append(round(low + (high - low) * (0.37 + 0.31 * i) % 1.0, 3))
    return ", ".join(map(str, values))
