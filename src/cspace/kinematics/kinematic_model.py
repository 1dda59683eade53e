"""What every function of kinematics takes first: the joints, frames and limits of a robot or of a chain."""

from __future__ import annotations

from typing import Any

from cspace._core import KinematicsBase
from cspace.kinematics.assembly import Assembly, screws
from cspace.model import Chain


class KinematicModel(KinematicsBase):
    """A chain or a tree of joints with its compiled kinematics: `fk`, `jacobian`, `fk_jacobian`.

    `Robot` and `ik.Solver` are kinematic models. name: of the robot. dof: number of velocities. joint_names:
    the n coordinates of a configuration, in order; joint_types: "R" (revolute) or "P" (prismatic) per
    coordinate. limits: each (n,). base, tip, leaves: names of links; tip is None for a tree that leaves the
    choice. frames: every name that fk accepts. floating: whether the base moves freely. mass: of all links
    [kg].
    """

    def __init__(self, assembly: Assembly, name: str) -> None:
        super().__init__(assembly)
        self._assembly = assembly
        self.name = name
        self.base, self.tip, self.floating = assembly.base, assembly.tip, assembly.floating
        self.leaves = assembly.leaves
        self.frames = tuple(assembly.frame_index)
        self.joint_names, self.joint_types = assembly.coordinates, assembly.coordinate_types
        self.limits = assembly.limits
        self.mass = float(assembly.mass.sum())
        self._auto_rows: dict[int, tuple[list[int], int]] = {}  # per frame: rows that count, generic rank

    def __setattr__(self, name: str, value: Any) -> None:
        """Refuses to set what describes the model: its compiled kinematics would not change with it."""
        if "_auto_rows" in self.__dict__ and not name.startswith("_"):
            text = f"{name} of {type(self).__name__} {self.name} cannot be set; build another one instead"
            raise AttributeError(text, name=name, obj=self)
        super().__setattr__(name, value)

    @property
    def chain(self) -> Chain:
        """The path from base to tip as screws at zero, tool and mounting included.

        axes (n, 3), points (n, 3) [m], joint_types, T_zero (4, 4), coordinates: see cspace.model.Chain.
        Raises InputError for a tree without tip.
        """
        return screws(self._assembly, self.name)
