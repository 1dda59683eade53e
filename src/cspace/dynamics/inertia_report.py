"""Report on the masses of a robot: which link cannot be a rigid body, and which motions have no inertia."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cspace.dynamics.inertia_checks import InertiaFault, check_body, check_size
from cspace.dynamics.massless_motions import massless_motions
from cspace.kinematics import Assembly
from cspace.kinematics.batch import check_robot
from cspace.model import Description
from cspace.tables import align_cells, html_table, join_words, one_line


class DescribedModel(Protocol):
    """A Robot."""

    name: str
    mass: float
    description: Description
    frames: tuple[str, ...]
    _assembly: Assembly


@dataclass(frozen=True, eq=False)
class InertiaReport:
    """What is wrong with the masses of a robot; truthy if nothing is.

    robot: its name. mass [kg]: of all its links. faults: what breaks a law of rigid bodies, and hints, which
    do not count. singular: the joints that move without any inertia; with them the mass matrix is singular,
    and forward dynamics has no answer.
    """

    robot: str
    mass: float
    faults: tuple[InertiaFault, ...]
    singular: tuple[str, ...]

    def __bool__(self) -> bool:
        return not self.singular and all(fault.hint for fault in self.faults)

    @property
    def summary(self) -> str:
        """The verdict in one line."""
        if self.mass == 0.0:
            return f"no link of {self.robot} has a mass; add inertial data to its description"
        faults = sum(not fault.hint for fault in self.faults)
        hints = len(self.faults) - faults
        parts = [f"{self.mass:.6g} kg", count_noun(faults, "fault")]
        parts += [count_noun(hints, "hint")] if hints else []
        if self.singular:
            move = "moves" if len(self.singular) == 1 else "move"
            parts.append(f"the mass matrix is singular: {join_words(self.singular)} {move} without inertia")
        return ", ".join(parts)

    def __repr__(self) -> str:
        return one_line("InertiaReport", f"of {self.robot}: {self.summary}")

    def _cells(self) -> tuple[list[str], list[list[str]]]:
        words = [fault.fault + (" (hint)" if fault.hint else "") for fault in self.faults]
        rows = [[fault.part, word, fault.detail] for fault, word in zip(self.faults, words, strict=True)]
        return ["part", "fault", "numbers"], rows

    def __str__(self) -> str:
        titles, rows = self._cells()
        head = f"{self.robot}: {self.summary}"
        return head if not rows else f"{head}\n{align_cells([titles, *rows])}"

    def _repr_html_(self) -> str:
        return html_table(f"{self.robot}: {self.summary}", *self._cells())


def count_noun(number: int, noun: str) -> str:
    """A number with its noun."""
    return f"{number or 'no'} {noun}{'' if number == 1 else 's'}"


def inertia_report(robot: DescribedModel) -> InertiaReport:
    """What is wrong with the masses of a robot: which link, and why.

    Reported are tensors that are not positive or break the triangle inequality, tensors without mass, and
    joints that move without inertia. Hints are links with a mass but no tensor, links with shapes but no
    mass, joints that carry no mass themselves, and tensors that seem to be in other units. Links that are
    fixed to each other are also checked as the one body that dynamics moves.

    Nothing is refused here; functions that need an inverse of the mass matrix raise InputError where it is
    singular.
    """
    check_robot(robot)
    faults = [*check_links(robot), *check_bodies(robot)] if robot.mass > 0.0 else list(check_links(robot))
    return InertiaReport(robot.name, robot.mass, tuple(faults), massless_motions(robot._assembly))


def check_links(robot: DescribedModel) -> Iterator[InertiaFault]:
    """The faults of single links, from the root outward."""
    description = robot.description
    for name in description.ordered_links:
        link = description.link_by_name[name]
        if name not in robot._assembly.frame_index:
            continue
        if link.inertial is not None:
            yield from check_body(name, link.inertial.mass, link.inertial.inertia)
            yield from check_size(description, link)
        elif robot.mass > 0.0 and (link.visual or link.collision) and name != description.root:
            text = "the link has shapes, but no mass properties"
            yield InertiaFault(name, "no mass", text, 0.0, (0.0, 0.0, 0.0), hint=True)


def check_bodies(robot: DescribedModel) -> Iterator[InertiaFault]:
    """The faults of what the base and the joints carry as one body, where several links form it."""
    assembly, description = robot._assembly, robot.description
    carried: list[list[str]] = [[] for _ in range(assembly.n_joints + 1)]
    for name, index in assembly.frame_index.items():
        if name in description.link_by_name:  # not the frame of a tool
            carried[int(assembly.frame_joint[index]) + 1].append(name)
    for k, links in enumerate(carried):
        heavy = [name for name in links if description.link_by_name[name].inertial is not None]
        mass, inertia = float(assembly.mass[k]), assembly.inertia[k]
        if len(heavy) > 1:
            yield from check_body(f"{links[0]} with {count_noun(len(heavy) - 1, 'more link')}", mass, inertia)
        elif mass == 0.0 and not np.any(inertia) and k > 0 and links:
            text = "what the joint carries has no mass itself"
            yield InertiaFault(links[0], "massless", text, 0.0, (0.0, 0.0, 0.0), hint=True)
