"""`cspace export`: an arm's inverse kinematics as source code."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Final

from cspace.cli.arguments import add_chain, add_option, add_robot
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, check_writable
from cspace.cli.robot import joint_called, load_chosen, need_chain

if TYPE_CHECKING:
    from cspace.export import Export


EXAMPLES: Final = """
cspace export ur5e --lang cpp -o ur5e_ik.hpp
cspace export gen3_lite --lang c -o gen3_lite_ik.h --example main.c
cspace export panda -o panda_ik.hpp --locked panda_joint7
cspace export arm.urdf --lang python --name my_arm > my_arm.py
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "cpp, c or python (default: by the ending of FILE, else cpp)"
    add_option(parser, "--lang LANGUAGE", text)
    add_option(parser, "-o --output FILE", "output file (default: print the text)", Path)
    add_option(parser, "--name NAME", "namespace or prefix (default: derived from the name of the robot)")
    add_option(parser, "--locked JOINT…", "joints whose values are arguments of the code; q7 is the seventh")
    add_option(parser, "--example FILE", "write a program that uses the exported code", Path)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Write the files, or show the one there is."""
    targets = [path for path in (args.output, args.example) if path is not None]
    for path in targets:
        check_writable(path)
    if args.output is not None and args.example is not None:
        check_apart(args.lang, args.output, args.example)
    robot = load_chosen(args)
    need_chain(robot)
    locked = None if args.locked is None else [joint_called(word, robot) for word in args.locked]
    made = robot.export(args.lang, args.output, name=args.name, locked=locked)
    if args.output is None and len(made.files) > 1 and not out.as_json:
        raise UsageError(f"{made.language} needs {len(made.files)} files: give their location with -o FILE")
    if args.example is not None:
        made.write_example(args.example)
    report_files(made, args, out)
    return Exit.DONE


def check_apart(lang: str | None, output: Path, example: Path) -> None:
    """Refuse an example in the place of what it is an example of."""
    from cspace.export.languages import language_of

    behind = [output.with_suffix(".cpp")] if language_of(lang, output) == "c" else []
    for path in (output, *behind):
        if path.resolve() == example.resolve():
            raise UsageError(f"--example {str(example)!r} would overwrite {path.name!r}: choose another name")


def report_files(made: Export, args: argparse.Namespace, out: Output) -> None:
    """What was written, or the text itself."""
    written = [] if args.output is None else [str(args.output.parent / name) for name in made.files]
    written += [str(args.example)] * (args.example is not None)
    if out.as_json:
        texts = dict(made.files) if args.output is None else {}
        out.document(
            {
                "schema": "cspace.export/1",
                "language": made.language,
                "name": made.name,
                "method": made.method,
                "written": written,
                "files": texts,
            }
        )
    elif args.output is None:
        out.stream.write(made.text)
    else:
        for path in written:
            out.line(path)
