"""The words that verbs share: numbers as people type them, robots, poses, formats."""

from __future__ import annotations

import argparse
import io
import math
import re
import shutil
import sys
import textwrap
import threading
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, NoReturn

from cspace.cli.exits import UsageError
from cspace.errors import RENAMED

OF_PI: Final = re.compile(r"([+-]?)(\d+(?:\.\d*)?|\.\d+)?\*?pi(?:/(\d+(?:\.\d*)?))?")
"""Multiples of π: pi, -pi/2, 3pi/4, 0.5*pi."""

NEGATIVE_AXES: Final = frozenset({"-x", "-y", "-z"})
NO_VALUE: Final = re.compile(r"(--[\w-]+=|-[a-z]=?)--")
"""An option with -- for its value, of which argparse makes none."""
LENGTHS: Final = {"mm": 1000.0, "cm": 100.0, "m": 1.0}
"""The units of lengths, in units per metre; of those that fit the end of a word the first counts."""
ANGLES: Final = {"deg": 180.0 / math.pi, "°": 180.0 / math.pi, "rad": 1.0}
"""The units of angles, in units per radian."""
TIMES: Final = {"ms": 1000.0, "s": 1.0}
"""The units of times, in units per second."""
UNITS: Final = {"m": LENGTHS, "rad": ANGLES, "s": TIMES}
"""The units that a value may be typed in, by the unit of the value."""
OPEN: Final = "any"
"""What is typed for a coordinate that does not matter."""


class Parser(argparse.ArgumentParser):
    """The parser of one verb: --json and --debug for all, faults raised as UsageError."""

    def __init__(self, verb: str, summary: str, examples: str) -> None:
        super().__init__(
            prog=f"cspace {verb}",
            description=summary[0].upper() + summary[1:] + ".",
            epilog="examples:\n" + "\n".join("  " + line for line in examples.strip().splitlines()),
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        add_option(self, "--json", "machine-readable output: radians, metres")
        add_option(self, "--debug", "show the traceback of an error")
        add_option(self, "--time-limit S", "stop after S seconds, with exit code 5", read_seconds)

    def print_help(self, file: Any = None) -> None:
        """Write the help; that of argparse would not report a failure, such as a full disk."""
        folded = fold_help(self.format_help(), shutil.get_terminal_size().columns)
        (file or sys.stdout or io.StringIO()).write(folded)

    def error(self, message: str) -> NoReturn:
        """Raise the fault instead of printing the usage and leaving the process."""
        unguarded = re.sub(r"(?<=[\s'])\s+(?=-)", "", message)
        for word in unguarded.removeprefix("unrecognized arguments: ").split():
            old = word.partition("=")[0]
            ours = "--" + RENAMED.get(old.removeprefix("--"), "").replace("_", "-")
            if old.startswith("--") and ours in self._option_string_actions:
                unguarded = f"unknown option {old}: use {ours}"
        raise UsageError(f"{unguarded}; see {self.prog} --help")


def fold_help(text: str, width: int) -> str:
    """A help whose lines fit a terminal: sentences go on below their indent, commands behind a backslash."""
    lines: list[str] = []
    for line in text.splitlines():
        if len(line) <= width:
            lines.append(line)
            continue
        indent = " " * (len(line) - len(line.lstrip()))
        is_command = line.lstrip().startswith("cspace ")
        folded = textwrap.wrap(
            line,
            width - 2 if is_command else width,
            subsequent_indent=indent + "    " if is_command else indent,
            break_long_words=False,
            break_on_hyphens=False,
        )
        lines += [part + " \\" for part in folded[:-1]] + folded[-1:] if is_command else folded
    return "\n".join(lines) + "\n"


def add_option(where: Any, typed: str, text: str, read: Any = None, **more: Any) -> None:
    """Add an option as it is typed: --deg is a flag, --tip LINK takes a value, --xy X Y two, --near Q… any
    number. where: a parser or a group. text: its help. read: what makes a value of a word.
    """
    words = typed.split()
    names = [word for word in words if word.startswith("-")]
    values = [word.removesuffix("…") for word in words[len(names) :]]
    if values:
        more |= {"type": read, "metavar": tuple(values) if len(values) > 1 else values[0]}
        if typed.endswith("…") or len(values) > 1:
            more["nargs"] = "+" if typed.endswith("…") else len(values)
    elif "choices" not in more:
        more.setdefault("action", "store_true")
    where.add_argument(*names, help=text, **more)


class Radians(float):
    """A number typed as a multiple of π, or with a unit of angles: radians, also where degrees are typed."""


def read_radians(value: float, *, degrees: bool) -> float:
    """A typed angle [rad]; `degrees`: it was typed in degrees, unless with pi."""
    return math.radians(value) if degrees and not isinstance(value, Radians) else float(value)


def read_number(text: str) -> float:
    """A finite number, or a multiple of π: 0.5, -1e-3, pi, -pi/2, 3pi/4."""
    word = text.strip()
    match = OF_PI.fullmatch(word.lower())
    if match:
        sign, factor, divisor = match.groups()
        value = math.pi * float(factor or 1) / float(divisor or 1) if float(divisor or 1) else math.inf
        value = Radians(-value if sign == "-" else value)
    else:
        try:
            value = float(word)
            if "_" in word:  # Python reads 1_0 as ten
                raise ValueError
        except ValueError:
            raise argparse.ArgumentTypeError(f"{word!r} is not a number") from None
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{word!r} is not a finite number")
    return value


def read_seconds(text: str) -> float:
    """A positive time [s]."""
    value = read_number(text)
    if value <= 0.0 or value > threading.TIMEOUT_MAX:
        raise argparse.ArgumentTypeError(
            f"{text.strip()!r} is not a time limit; expected more than 0 s, at most "
            f"{threading.TIMEOUT_MAX:.2g} s"
        )
    return value


def read_length(text: str) -> float:
    """A length [m], or with its unit: 0.005, 5mm, 0.5cm."""
    return read_unit(text, LENGTHS)


def read_angle(text: str) -> float:
    """A number as by read_number, or an angle with its unit: 0.3, pi/2, 20deg, -90°, 0.3rad."""
    unit = unit_of(text, ANGLES)
    return Radians(read_unit(text, ANGLES)) if unit else read_number(text)


def read_unit(text: str, units: Mapping[str, float]) -> float:
    """A number, divided by the factor of the unit behind it."""
    word, unit = text.strip(), unit_of(text, units)
    try:
        return read_number(word[: len(word) - len(unit)]) / units.get(unit, 1.0)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{word!r} is not a number") from None


def unit_of(text: str, units: Iterable[str]) -> str:
    """The unit at the end of a word, "" without one."""
    return next((unit for unit in units if text.strip().lower().endswith(unit)), "")


def read_seed(text: str) -> int:
    """A seed of random numbers: a whole number below 2⁶⁴, not negative."""
    word = text.strip()
    if not re.fullmatch(r"\d{1,20}", word, re.ASCII) or int(word) >= 2**64:
        raise argparse.ArgumentTypeError(
            f"{word!r} is not a seed; expected a whole number from 0 to 2^64 - 1"
        )
    return int(word)


def split_numbers(words: Sequence[str], option: str) -> list[float] | None:
    """Words as numbers, or None for one word that is a name. Raises UsageError for a mixture."""
    if len(words) == 1 and not is_number(words[0].strip()):
        return None
    try:
        return [read_angle(word) for word in words]
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"{option} takes a value per joint, or one named pose: {error}") from None


def named_value(text: str) -> tuple[str, str]:
    """A name and a value with = between them, or := as in ROS."""
    name, sign, value = text.strip().partition("=")
    name = name.removesuffix(":").strip()
    if not sign or not name:
        raise argparse.ArgumentTypeError(f"{text.strip()!r} is not of the form NAME=VALUE")
    return name, value.strip()


def named_number(text: str) -> tuple[str, float]:
    """A name and a finite number, or an angle with its unit, with = between them."""
    name, value = named_value(text)
    return name, read_angle(value)


def read_coordinate(text: str) -> float | None:
    """A length, or `any` for a coordinate that does not matter."""
    return None if text.strip().lower() == OPEN else read_length(text)


def separate_values(words: Sequence[str]) -> list[str]:
    """Words as argparse takes them: 1,-2,3 as three, and a blank before -1e-3, -pi/2 or -z, which are values
    and no options. Raises UsageError for -- as the value of an option.
    """
    out: list[str] = []
    for word in words:
        if NO_VALUE.fullmatch(word):
            raise UsageError(
                f"{word}: -- is not a value; write it alone, before arguments that are not options"
            )
        option, sign, value = word.partition("=")
        if sign and option.startswith("--") and is_list(value):
            out.append(option)
            word = value
        parts = word.split(",") if is_list(word) else [word]
        out += [" " + part if part.startswith("-") and is_value(part) else part for part in parts]
    return out


def is_list(word: str) -> bool:
    """Whether a word is several numbers with commas between them."""
    return "," in word and all(is_value(part) for part in word.split(","))


def is_value(word: str) -> bool:
    """Whether a word that begins with a sign may be a value: a number, a coordinate, an axis."""
    return word in NEGATIVE_AXES or word.lower() == OPEN or is_number(word)


def is_number(word: str) -> bool:
    """Whether a word reads as a number, finite or not."""
    number = word[: len(word) - len(unit_of(word, [*ANGLES, *LENGTHS]))]
    if OF_PI.fullmatch(number.lower()):
        return True
    try:
        float(number)
    except ValueError:
        return False
    return True


def add_robot(parser: argparse.ArgumentParser) -> None:
    """The robot: a name of the catalogue or a file, and what a file may need besides."""
    parser.add_argument("robot", metavar="ROBOT", help="a name of the catalogue (cspace robots) or a file")
    group = parser.add_argument_group("options for robot files")
    text = "the joint frames of one UR arm, from ur_calibration"
    add_option(group, "--calibration FILE", text)
    text = "how far the file rounds right angles, which then are exact, such as 1e-5 for 1.5708"
    add_option(group, "--right-angles RADIANS", text, read_number)
    text = "an argument of a xacro file; may be repeated"
    add_option(group, "--xacro-arg NAME=VALUE", text, named_value, action="append", default=[])
    text = "a folder with ROS packages, or one package; may be repeated"
    add_option(group, "--package-path FOLDER", text, action="append", default=[])


def add_chain(parser: argparse.ArgumentParser) -> None:
    """The ends of the chain, for files that leave the choice."""
    add_option(parser, "--base LINK", "the link where the chain begins")
    add_option(parser, "--tip LINK", "the link where the chain ends")


def add_joints(parser: argparse.ArgumentParser) -> None:
    """One value per joint or a named pose, and a frame."""
    text = "one value per joint [rad, m]; pi/2 or 90deg may be typed"
    parser.add_argument("q", metavar="Q", nargs="*", type=read_angle, help=text)
    add_option(parser, "--pose NAME", "a named pose of the robot instead of values, such as home")
    add_option(parser, "--frame LINK", "a frame other than the tip")


def add_degrees(parser: argparse.ArgumentParser) -> None:
    """Degrees instead of radians, typed and read; --json stays in radians."""
    group = parser.add_mutually_exclusive_group()
    add_option(group, "--deg", "type and read angles in degrees; pi/2 typed is 90")
    add_option(group, "--rad", "angles in radians (the default)", action="store_false", dest="deg")
