"""Roadmap: configurations of an arm joined by motions that are free of self-collision, for many scenes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace._core import ArmRoadmap, RoadmapWorld, make_roadmap, restore_roadmap
from cspace.arrays import Array, bounded_number, whole_number
from cspace.collision import RobotGeometry
from cspace.collision.checks import HasGeometry, read_geometry
from cspace.errors import InputError, RoadmapError
from cspace.planning.arm_planner import Seed
from cspace.planning.roadmap_files import MOST_SAMPLES, read_roadmap, write_roadmap
from cspace.planning.space import ArmSpace
from cspace.search import draw_seed
from cspace.tables import html_table, one_line
from cspace.tolerances import LARGEST_NUMBER

SAMPLES: Final = 4000
"""Samples of a roadmap unless told: made in a third of a second for seven joints."""

NEIGHBOURS: Final = 15
"""Nodes that each is joined to unless told."""

MOST_NEIGHBOURS: Final = 1000
"""Neighbours of a node at most."""

MOST_THREADS: Final = 1024
"""Threads that are believed."""

KEPT_WORLDS: Final = 8
"""Scenes of which a roadmap keeps what was checked, as many as a geometry keeps checkers."""

SHARED_DECIMALS: Final = 9
"""Decimals [m, rad] in which two robots must agree to share a roadmap: below what rounding costs checks."""


class Roadmap:
    """A probabilistic roadmap of an arm (Kavraki et al. 1996) that serves every scene.

    Its nodes are the points of a Halton sequence at which the robot is free of self-collision. Each is joined
    to its nearest neighbours by motions that are proved free of self-collision over their whole length. No
    scene can void this, so it is what a file holds. The planners "prm", "lazy_prm" and "prm_star" take it as
    `roadmap=`; what they check of it in a scene is kept as long as the roadmap lives.

    robot: a Robot, or a RobotGeometry. samples: points drawn. neighbours: nodes that each is joined to; None:
    as many as PRM* needs, e (1 + 1/dof) log n (Karaman & Frazzoli 2011). margin [m]: links keep so far away
    from each other; it serves plans with a margin up to that. rng: seed or generator; the same seed gives the
    same roadmap on every machine. threads: 0 for all; the result does not depend on it.

    Raises InputError for a robot without collision geometry and for numbers out of range.
    """

    def __init__(
        self,
        robot: HasGeometry,
        *,
        samples: int = SAMPLES,
        neighbours: int | None = NEIGHBOURS,
        margin: float = 0.0,
        rng: Seed = 0,
        threads: int = 0,
    ) -> None:
        rule = check_rule(samples, neighbours, margin, draw_seed(rng))
        count = whole_number(threads, "threads", 0, MOST_THREADS, "0 for every processor")
        space = ArmSpace(robot, margin=rule["margin"])
        self._fill(space.geometry, rule, make_core(space, rule, None, count))

    def _fill(self, geometry: RobotGeometry, rule: Mapping[str, Any], core: ArmRoadmap) -> None:
        self.robot, self.geometry, self.core = geometry.robot, geometry, core
        self.samples: int = rule["samples"]
        self.neighbours: int = core.neighbours
        self.margin: float = rule["margin"]
        self.seed: int = rule["seed"]
        self.is_star: bool = rule["neighbours"] == 0
        self._rule = dict(rule)
        self._worlds: dict[Any, tuple[RoadmapWorld, object]] = {}

    @classmethod
    def _restore(cls, geometry: RobotGeometry, rule: Mapping[str, Any], core: ArmRoadmap) -> Roadmap:
        made = cls.__new__(cls)
        made._fill(geometry, rule, core)
        return made

    @property
    def nodes(self) -> Array:
        """The configurations (n, dof) [rad or m]."""
        return self.core.nodes

    @property
    def edges(self) -> npt.NDArray[np.int32]:
        """The pairs of nodes (e, 2) that are joined, by number."""
        return self.core.edges

    @property
    def components(self) -> int:
        """The number of parts that hang together, before any scene."""
        return self.core.components

    def extend(self, samples: int, *, threads: int = 0) -> Roadmap:
        """A roadmap with so many more samples: the one that is made with all of them at once.

        The proofs of edges that both have are taken over. threads: 0 for all.
        """
        more = whole_number(samples, "samples", 0, MOST_SAMPLES)
        count = whole_number(threads, "threads", 0, MOST_THREADS, "0 for every processor")
        rule = self._rule | {"samples": whole_number(self.samples + more, "samples", 0, MOST_SAMPLES)}
        space = ArmSpace(self.geometry, margin=self.margin)
        return self._restore(self.geometry, rule, make_core(space, rule, self.core, count))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to a file, which is complete or untouched; InputError where that is impossible."""
        header = self._rule | {"robot": self.robot, "fingerprint": fingerprint_geometry(self.geometry)}
        write_roadmap(path, header, self.nodes, self.edges)

    @classmethod
    def load(cls, path: str | os.PathLike[str], robot: HasGeometry) -> Roadmap:
        """The roadmap of a file, for the robot that it was made for.

        Raises RoadmapError for a file that is damaged, incomplete or no roadmap, and for one of a robot with
        other joints, limits or spheres.
        """
        geometry = read_geometry(robot)
        header, nodes, edges = read_roadmap(
            path, geometry.robot, fingerprint_geometry(geometry), geometry.dof
        )
        try:
            rule, core = restore_core(geometry, header, nodes, edges)
        except ValueError as error:
            raise RoadmapError(
                f"the file is damaged: {error}; save the roadmap again", path=str(path)
            ) from error
        return cls._restore(geometry, rule, core)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """What a file holds of it, and the geometry."""
        return unpack_roadmap, (self.geometry, self._rule, self.nodes, self.edges)

    def _world(self, space: ArmSpace, proves_search: bool, resolution: float) -> RoadmapWorld:
        """What is known of it in a scene; InputError for a space of another robot or a larger margin."""
        self._check_space(space)
        attached = space.scene is not None and bool(space.scene.attached)
        version = None if space.scene is None else space.scene.version
        key = (version, space.margin, None if proves_search else resolution)
        world, checker = self._worlds.pop(key, (None, None))
        if world is None or checker is not space.checker.core:
            world = RoadmapWorld(self.core, space.checker.core, not attached, proves_search, resolution)
            for name in list(self._worlds)[: max(0, len(self._worlds) - KEPT_WORLDS + 1)]:
                self._worlds.pop(name, None)
        self._worlds[key] = world, space.checker.core
        return world

    def _check_space(self, space: ArmSpace) -> None:
        if space.geometry is not self.geometry and fingerprint_geometry(
            space.geometry
        ) != fingerprint_geometry(self.geometry):
            raise InputError(
                f"roadmap is of {self.robot}, and the plan is of {space.geometry.robot} with other joints,"
                " limits or spheres; make one with cs.planning.Roadmap(robot)"
            )
        if space.margin > self.margin:
            raise InputError(
                f"roadmap has the margin {self.margin:g} m, and the plan needs {space.margin:g} m; make one"
                f" with cs.planning.Roadmap(robot, margin={space.margin:g})"
            )

    def __len__(self) -> int:
        """The number of nodes."""
        return len(self.core)

    def __bool__(self) -> bool:
        """Always true: an empty roadmap is one, too."""
        return True

    def _facts(self) -> list[tuple[str, str]]:
        return [
            ("nodes", f"{len(self)} of {self.samples} samples"),
            ("edges", f"{self.core.edge_count}, {self.neighbours} nearest neighbours"),
            ("components", f"{self.components}"),
            ("margin", f"{1000 * self.margin:.3g} mm"),
        ]

    def __repr__(self) -> str:
        return one_line("Roadmap", f"of {self.robot}: " + "; ".join(f"{a} {b}" for a, b in self._facts()))

    def _repr_html_(self) -> str:
        return html_table(f"Roadmap of {self.robot}", ("of it", "value"), self._facts())


def check_rule(samples: Any, neighbours: Any, margin: Any, seed: int) -> dict[str, Any]:
    """What a roadmap is made of, checked; neighbours 0: as PRM* needs."""
    count = 0 if neighbours is None else whole_number(neighbours, "neighbours", 1, MOST_NEIGHBOURS)
    gap = bounded_number(margin, "margin", 0.0, "it must be a length [m], 0 or more", largest=LARGEST_NUMBER)
    points = whole_number(samples, "samples", 1, MOST_SAMPLES)
    return {"samples": points, "neighbours": count, "margin": gap, "seed": seed}


def make_core(space: ArmSpace, rule: Mapping[str, Any], part: ArmRoadmap | None, threads: int) -> ArmRoadmap:
    """The roadmap of a robot alone."""
    numbers = rule["samples"], rule["neighbours"], rule["seed"]
    return make_roadmap(space.checker.core, space.bounds, space.wraps, *numbers, part, threads)


def restore_core(
    geometry: RobotGeometry, header: Mapping[str, Any], nodes: Array, edges: npt.NDArray[np.int32]
) -> tuple[dict[str, Any], ArmRoadmap]:
    """What a saved roadmap is made of, and the roadmap; ValueError for numbers that no roadmap has."""
    samples, neighbours, margin, seed = (header[key] for key in ("samples", "neighbours", "margin", "seed"))
    rule = check_rule(samples, neighbours or None, margin, draw_seed(seed))
    space = ArmSpace(geometry, margin=rule["margin"])
    numbers = rule["samples"], rule["neighbours"], rule["seed"]
    core = restore_roadmap(space.checker.core, space.bounds, space.wraps, *numbers, nodes, edges)
    return rule, core


def unpack_roadmap(
    geometry: RobotGeometry, rule: Mapping[str, Any], nodes: Array, edges: npt.NDArray[np.int32]
) -> Roadmap:
    """The roadmap that was pickled."""
    return Roadmap._restore(geometry, *restore_core(geometry, rule, nodes, edges))


def fingerprint_geometry(geometry: RobotGeometry) -> str:
    """A word for all that self-collision depends on: joints, limits, spheres and solids, checked pairs."""
    from hashlib import sha256

    kept = geometry._kept
    if "fingerprint" not in kept:
        digest = sha256()
        for numbers in (geometry.joints, geometry.lower, geometry.upper, geometry.spheres, geometry.solids):
            rounded = np.round(numbers, SHARED_DECIMALS) + 0.0  # no negative zeros
            digest.update(f"{rounded.shape}".encode() + rounded.astype("<f8").tobytes())
        for counts in (geometry.link_bodies, geometry.sphere_links, geometry.sphere_solids, geometry.pairs):
            digest.update(f"{counts.shape}".encode() + counts.astype("<i8").tobytes())
        kept["fingerprint"] = digest.hexdigest()
    word: str = kept["fingerprint"]
    return word
