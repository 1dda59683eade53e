"""The verbs: a name and one line each. The verb `x` lives in verbs/x.py, which is imported only to run it."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Protocol, cast

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
        "dh": "the Denavit-Hartenberg table and the link matrices",
        "nav": "a path through a map, by one planner or by all of them for comparison",
        "planners": "the planners of nav, and their options",
        "export": "the inverse kinematics of an arm as C++, C or Python code that does not depend on cspace",
        "doctor": "versions, optional parts and a self-check",
    }
)


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
