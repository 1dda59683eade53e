"""From the words of a command line to an exit code: the only place that catches everything."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import textwrap
from collections.abc import Mapping, Sequence
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Protocol, cast

from cspace.cli.exits import Exit, TimeLimitReached, UsageError, exit_of
from cspace.errors import CspaceError, suggest

if TYPE_CHECKING:
    import argparse

    from cspace.cli.output import Output


VERBS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "robots": "list the robots of the catalogue, or search it",
        "info": "a robot's joints, limits, frames, geometry and degrees of freedom",
        "fk": "the pose of the tip, or of any frame, at given joints",
        "ik": "every joint configuration that reaches a pose",
        "jacobian": "the Jacobian, its singular values and the distance to singularity",
        "dynamics": "the torques of a motion, or the motion of torques, and the energies",
        "dh": "the Denavit-Hartenberg table and the link matrices",
        "nav": "a path through a map, by one planner or by all of them for comparison",
        "localize": "where a robot was during a log, by a filter on a map",
        "slam": "the trajectory and the map of a log, or the optimum of a pose graph",
        "evaluate": "absolute and relative errors of a trajectory",
        "plan": "a free path of an arm among obstacles, every motion of it proved",
        "planners": "the planners of nav and plan, and their options",
        "space": "the configuration space: exact of a planar arm with two joints, else free share and slices",
        "simulate": "the motion of a robot that is released or held, under gravity and friction",
        "traj": "a motion in time: to a configuration, through waypoints, or along a line of the tip",
        "export": "the inverse kinematics of an arm as C++, C or Python code that does not depend on cspace",
        "doctor": "versions, optional parts and a self-check",
    }
)
"""The verbs, one line each. The verb `x` lives in verbs/x.py, which is imported only to run it."""


SHELL_WORDS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "cs.robots.names()": "cspace robots",
        "cs.robots.search()": "cspace robots WORD",
        ", with inf for none": "",
        "robot.with_spheres(…)": "--spheres FILE",
        'load the robot with geometry="skeleton"': "--geometry skeleton",
        "robot.escape may lead out of it": "move it away from there",
        "permit it by scene.allow": "list the pair under allowed in the scene: ",
    }
)
"""What messages of the library say for Python, and what is typed instead."""


class VerbModule(Protocol):
    """What a file of verbs/ offers."""

    EXAMPLES: str

    def arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare the arguments of the verb."""

    def run(self, args: argparse.Namespace, out: Output) -> int:
        """Run the verb, write the result to `out`, return the exit code."""


def import_verb(verb: str) -> VerbModule:
    """Import the file of one verb."""
    return cast(VerbModule, import_module(f"cspace.cli.verbs.{verb}"))


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv` (default: the process's) and return its exit code."""
    words = list(sys.argv[1:] if argv is None else argv)
    debug = "--debug" in words
    try:
        code = dispatch_verb(words)
        if sys.stdout is not None:  # None: closed by the caller
            sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader of our output has left (`cspace robots | head`): leave too
        silence_output()
        return Exit.CLOSED_PIPE
    except TimeLimitReached as stop:
        print_message(str(stop))
        return Exit.TIME_LIMIT
    except KeyboardInterrupt:
        print_message("interrupted")
        return Exit.INTERRUPTED
    except CspaceError as error:
        if debug:
            raise
        print_message(in_words_of_shell(str(error)))
        return exit_of(error)
    except Exception as error:
        if debug:
            raise
        if isinstance(error, OSError) and error.filename is None:  # a stream; files are named
            print_message(
                f"the answer cannot be written: {error.strerror or error}; free space, or write elsewhere"
            )
            silence_output()
            return Exit.USAGE
        first_line = (str(error).splitlines() or [""])[0]
        print_message(f"internal error: {type(error).__name__}: {first_line}")
        print_message("run the same command with --debug to see where; please report it with that traceback")
        return Exit.INTERNAL


def dispatch_verb(words: list[str]) -> int:
    """Find the verb among the words and run it."""
    if not words or words[0] in ("-h", "--help", "help"):
        print(write_overview())
        return Exit.DONE
    if words[0] in ("-V", "--version"):
        from cspace import __version__

        print(f"cspace {__version__}")
        return Exit.DONE
    verb, *rest = words
    if verb.startswith("-"):
        raise UsageError(f"the verb comes first: cspace VERB {verb} …; verbs: {', '.join(VERBS)}")
    if verb not in VERBS:
        raise suggest("verb", verb, VERBS)
    return run_verb(verb, rest)


def run_verb(verb: str, words: list[str]) -> int:
    """Parse the words of one verb and run its file."""
    from cspace.cli.arguments import Parser, separate_values
    from cspace.cli.output import Output
    from cspace.cli.timing import limit_time

    module = import_verb(verb)
    parser = Parser(verb, VERBS[verb], module.EXAMPLES)
    module.arguments(parser)
    try:
        args = parser.parse_intermixed_args(separate_values(words))
    except SystemExit as stop:  # argparse leaves this way after --help; faults are raised by Parser.error
        return int(stop.code or 0)
    with limit_time(args.time_limit):
        return module.run(args, Output(as_json=args.json))


def write_overview() -> str:
    """The text of `cspace --help`."""
    width, columns = max(map(len, VERBS)), shutil.get_terminal_size().columns
    indent = " " * (width + 4)
    verbs = "\n".join(
        textwrap.fill(f"  {name:<{width}}  {summary}", columns, subsequent_indent=indent)
        for name, summary in VERBS.items()
    )
    return (
        "usage: cspace VERB …\n\n"
        "From a robot's description to its motion.\n\n"
        f"verbs:\n{verbs}\n\n"
        "cspace VERB --help    the arguments of a verb, with examples\n"
        "cspace --version      the version\n\n"
        "A robot is a name of the catalogue (cspace robots) or a file.\nEvery verb takes --json."
    )


def in_words_of_shell(message: str) -> str:
    """The message of an error with the words of the command line instead of the functions."""
    for call, words in SHELL_WORDS.items():
        message = message.replace(call, words)
    return message


def print_message(message: str) -> None:
    """One message for people, on the error stream."""
    with contextlib.suppress(OSError, ValueError):
        text = f"cspace: {message}"
        if sys.stderr is not None and sys.stderr.isatty():
            text = "\n".join(textwrap.wrap(text, shutil.get_terminal_size().columns, break_long_words=False))
        print(text, file=sys.stderr)


def silence_output() -> None:
    """Point the standard output at the null device: Python's flush at exit would fail a second time."""
    null = os.open(os.devnull, os.O_WRONLY)
    with contextlib.suppress(OSError, ValueError):
        os.dup2(null, sys.stdout.fileno())
    os.close(null)
