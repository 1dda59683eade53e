"""The robot: one object with every function of the library, each the free function of its package."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike

from cspace import kinematics, model
from cspace._core import RobotBase
from cspace.arrays import Array, one_array
from cspace.errors import InputError, InputTypeError, Renamed, name_new_keywords, suggest
from cspace.kinematics import KinematicModel
from cspace.late_imports import import_room, postpone_interrupts
from cspace.model import Chain, Description, DHTable, LinkMatrices
from cspace.spatial.checks import PoseLike, one_pose
from cspace.tables import html_table, shown

if TYPE_CHECKING:
    from cspace import cartesian, dynamics, ik, trajectory
    from cspace.collision import RobotGeometry, checks
    from cspace.collision.escape import escape as escape_collision
    from cspace.export import Export

    Seed = int | np.random.Generator | None

__all__ = ["Robot"]


class _Later:
    """A method that is a function of a room, which is imported when the method is first used."""

    def __init__(self, room: str) -> None:
        self.room = room

    def __set_name__(self, owner: type, name: str) -> None:
        self.owner, self.name = owner, name

    def __get__(self, robot: Robot | None, owner: type) -> Any:
        setattr(self.owner, self.name, getattr(import_room(self.room), self.name))
        return getattr(owner if robot is None else robot, self.name)


class Robot(Renamed, RobotBase, KinematicModel):
    """A robot: a kinematic chain or tree with its poses, velocities, inverse kinematics and export.

    description: links and joints. base, tip: links. With a tip, or when the joints form a chain anyway, the
    robot is the chain from base to tip, and joints off the chain are locked with what they carry. Without a
    tip it may be a tree, whose frames are addressed by name. floating: the base moves freely, and six
    velocities precede those of the joints; None takes it from the description. locked: joint name → value
    [rad or m] of joints off the chain, zero unless given. geometry: "collision" or "skeleton", cover [m]:
    what collision checks use, see `collision`. described: a description whose shapes the spheres of this one
    stand for, see `collision.deficits`. T_world_base, T_tip_tool (4, 4): the mounting of the base and
    the tool on the tip; both apply in every function. name: of the robot.

    dof: number of velocities. joint_names: the n coordinates of a configuration, in order; joint_types: "R"
    (revolute) or "P" (prismatic) per coordinate. limits: each (n,). frames: every name that fk accepts.
    base, tip, leaves: names of links. mass: of all links of the robot [kg]. floating, description: as
    given.

    Raises UnknownNameError for a link, a locked joint or a geometry that does not exist, InputError for a
    base= with more than one possible tip, and for a locked joint that moves the tip.
    """

    description: Description
    _knows_foreign_names: ClassVar = True

    def __init__(
        self,
        description: Description,
        base: str | None = None,
        tip: str | None = None,
        *,
        floating: bool | None = None,
        locked: Mapping[str, float] | None = None,
        geometry: str = "collision",
        cover: float = 0.01,
        described: Description | None = None,
        T_world_base: PoseLike | None = None,
        T_tip_tool: PoseLike | None = None,
    ) -> None:
        if not isinstance(description, Description):
            raise InputTypeError(
                f"Robot needs a Description, got {type(description).__name__}; load_robot takes names and"
                " paths, Robot.from_urdf, from_dh, from_screws and from_toml what their names say"
            )
        if geometry != "collision":
            from cspace.collision.robot_geometry import check_geometry

            check_geometry(geometry)
        self._ends = (base, tip)
        self._collision: RobotGeometry | None = None
        self._geometry, self._cover, self._described = geometry, cover, described
        self._made_with: dict[str, Any] = {"floating": floating, "locked": dict(locked or {})}
        self._T_world_base = None if T_world_base is None else one_pose(T_world_base, "T_world_base").copy()
        self._T_tip_tool = None if T_tip_tool is None else one_pose(T_tip_tool, "T_tip_tool").copy()
        assembly = kinematics.assemble(description, base, tip, floating=floating, locked=locked)
        if self._T_world_base is not None:
            kinematics.mount(assembly, description.name, self._T_world_base)
        if self._T_tip_tool is not None:
            kinematics.add_tool(assembly, description.name, self._T_tip_tool)
        super().__init__(assembly, description.name)
        self.__dict__["description"] = description  # all else is set; see __setattr__

    @classmethod
    def from_urdf(
        cls,
        source: str | os.PathLike[str] | bytes,
        base: str | None = None,
        tip: str | None = None,
        *,
        floating: bool | None = None,
        locked: Mapping[str, float] | None = None,
        package_paths: Sequence[Any] = (),
    ) -> Robot:
        """A robot from a URDF file or its text; see model.from_urdf, which also names the errors."""
        description = model.from_urdf(source, package_paths=package_paths)
        return cls(description, base, tip, floating=floating, locked=locked)

    @classmethod
    def from_mjcf(
        cls,
        source: str | os.PathLike[str] | bytes,
        base: str | None = None,
        tip: str | None = None,
        *,
        floating: bool | None = None,
        locked: Mapping[str, float] | None = None,
        package_paths: Sequence[Any] = (),
    ) -> Robot:
        """A robot from an MJCF file or its text; see model.from_mjcf, which also names the errors."""
        description = model.from_mjcf(source, package_paths=package_paths)
        return cls(description, base, tip, floating=floating, locked=locked)

    @classmethod
    def from_toml(
        cls,
        source: str | os.PathLike[str],
        base: str | None = None,
        tip: str | None = None,
        *,
        floating: bool | None = None,
        locked: Mapping[str, float] | None = None,
        package_paths: Sequence[Any] = (),
    ) -> Robot:
        """A robot from a TOML file or its text; see model.from_toml, which also names the errors."""
        description = model.from_toml(source, package_paths=package_paths)
        return cls(description, base, tip, floating=floating, locked=locked)

    @classmethod
    def from_dh(cls, table: Any, **options: Any) -> Robot:
        """A serial robot from a Denavit–Hartenberg table (n, 4), columns alpha, a, d, theta.

        options: convention="standard" or "modified", joint_types, T_base, T_tool, limits, names, as in
        model.from_dh, which also names the errors.
        """
        return cls(model.from_dh(table, **options))

    @classmethod
    def from_screws(cls, axes: Any, points: Any, T_zero: PoseLike, **options: Any) -> Robot:
        """A serial robot from its joint axes at zero: axes (n, 3), points (n, 3) [m], T_zero (4, 4).

        options: joint_types, lower, upper, velocity and the other limits, name, joint_names, base, tip, as in
        model.from_screws, which also names the errors.
        """
        return cls(model.from_screws(axes, points, one_pose(T_zero, "T_zero"), **options))

    def to_urdf(self, path: str | os.PathLike[str] | None = None) -> str:
        """The text of a URDF file, written to `path` if one is given; see model.to_urdf.

        The text contains the whole description, including tool and mounting.
        """
        return model.to_urdf(self._whole(), path)

    def to_toml(self, path: str | os.PathLike[str] | None = None) -> str:
        """The text of a TOML file, written to `path` if one is given; see model.to_toml.

        The text contains the whole description, including tool and mounting.
        """
        return model.to_toml(self._whole(), path)

    def to_dh(self, *, convention: str) -> DHTable:
        """The Denavit–Hartenberg table from base to tip, including tool and mounting; see model.to_dh."""
        return model.to_dh(self.chain, convention=convention)

    def link_matrices(self, *, convention: str = "standard") -> LinkMatrices:
        """The matrices of the links and their products, with c1, s12 and the like as symbols.

        convention: of the underlying Denavit–Hartenberg table, "standard" or "modified". The result prints,
        has to_markdown() and to_latex(), and can be evaluated; see model.link_matrices.
        """
        return model.link_matrices(self.to_dh(convention=convention))

    def to_screws(self) -> Chain:
        """The joint axes at zero from base to tip, including tool and mounting; the same as chain."""
        return self.chain

    def _whole(self) -> Description:
        """The description with the tool as a link on the tip and the mounting under a new root."""
        whole = self.description
        if self._T_tip_tool is not None:
            whole = model.with_frame(whole, *self._place_of(str(self.tip)))
        return whole if self._T_world_base is None else model.mounted(whole, self.base, self._T_world_base)

    def _place_of(self, frame: str) -> tuple[str, Array]:
        """The link of the description that carries a frame, and the pose (4, 4) of the frame in it."""
        if self._T_tip_tool is not None and frame == self.tip:
            return str(self._constructor(T_tip_tool=None)().tip), self._T_tip_tool
        if frame not in self.frames:
            raise suggest("frame", frame, self.frames, owner=self.name)
        return frame, np.eye(4)

    fk_all = kinematics.forward_kinematics_all
    jacobian_dot = kinematics.jacobian_dot
    center_of_mass = kinematics.center_of_mass
    center_of_mass_jacobian = kinematics.center_of_mass_jacobian
    singular_values = kinematics.singular_values
    manipulability = kinematics.manipulability
    manipulability_ellipsoid = kinematics.manipulability_ellipsoid
    distance_to_singularity = kinematics.distance_to_singularity
    singularity = kinematics.singularity
    workspace = kinematics.workspace
    if TYPE_CHECKING:
        clearance = checks.clearance
        contact = checks.contact
        edge = checks.edge
        escape = escape_collision
        ik_many_starts = ik.ik_many_starts
        ik_numeric = ik.ik_numeric
        ik_plan = ik.ik_plan
        ik_tasks = ik.ik_tasks
        inertia_report = dynamics.inertia_report
        operational_space = dynamics.operational_space
        simulate = dynamics.simulate
        redundancy = ik.redundancy
        resolved_rate = ik.resolved_rate
        task_velocity = ik.task_velocity
        track = ik.track
        move_to = trajectory.move_to
        move_arc = cartesian.move_arc
        move_linear = cartesian.move_linear
        move_through = cartesian.move_through

        def export(
            self,
            lang: str | None = None,
            path: str | os.PathLike[str] | None = None,
            *,
            name: str | None = None,
            locked: Any = None,
        ) -> Export: ...

    else:
        clearance, contact, edge, escape = (_Later("cspace.collision") for _ in range(4))
        export = _Later("cspace.export")
        inertia_report, operational_space, simulate = (_Later("cspace.dynamics") for _ in range(3))
        ik_many_starts, ik_numeric, ik_plan, ik_tasks = (_Later("cspace.ik") for _ in range(4))
        redundancy, resolved_rate, task_velocity, track = (_Later("cspace.ik") for _ in range(4))
        move_to = _Later("cspace.trajectory")
        move_arc, move_linear, move_through = (_Later("cspace.cartesian") for _ in range(3))

    @property
    def collision(self) -> RobotGeometry:
        """What collision checks use, made when first read: spheres on links, and the pairs that are checked.

        The collision elements of the description, covered by spheres within `cover` [m], or with
        geometry="skeleton" capsules along the arm. Falsy, with a reason, if there are none; then every check
        raises InputError. Raises DescriptionError for meshes that are not found or cannot be read.
        """
        if self._collision is None:
            from cspace.collision import robot_geometry

            self._collision = robot_geometry(
                self,
                self.description,
                geometry=self._geometry,
                cover=self._cover,
                described=self._described,
                T_world_base=self._T_world_base,
            )
        return self._collision

    def with_spheres(
        self,
        spheres: Mapping[str, Any] | str | os.PathLike[str] | None = None,
        *,
        cover: float | None = None,
    ) -> Robot:
        """The same robot with other spheres for collision checks.

        spheres: link → rows (n, 4) of centres in the frame of the link and radii [m], or the path of a file
        of them (.json, .toml, or a URDF whose collision elements are spheres); links that are not named have
        none. `collision.deficits` then measures what the spheres leave outside. cover: instead, the excess
        [m] of the spheres that cover the shapes of the description. Raises UnknownNameError for a link that
        does not exist, DescriptionError for a file that cannot be read, InputError for a radius that is not
        positive.
        """
        if spheres is None:
            return self._constructor(geometry="collision", **({} if cover is None else {"cover": cover}))()
        if cover is not None:
            raise InputTypeError("give with_spheres either spheres or cover=")
        from cspace.collision import replace_spheres

        return self._constructor(
            description=replace_spheres(self.description, spheres),
            geometry="collision",
            described=self._described or self.description,
        )()

    @property
    def named_poses(self) -> dict[str, Array]:
        """The named configurations of the description: name → q (n,) [rad or m], such as "home" or "ready".

        Only those that have a value for every joint of the robot. An unknown name raises UnknownNameError
        with the similar ones.
        """
        return model.named_poses(self.description, self.joint_names)

    @property
    def solver(self) -> ik.Solver:
        """The inverse kinematics of the chain from base to tip, built when first read.

        Raises NoClosedFormError for mimic joints, a floating base, no joint or more than sixteen; InputError
        for a tree without a tip.
        """
        if self._solver is None:
            with postpone_interrupts():
                from cspace.ik import solver_of_robot

            self._solver = solver_of_robot(self)
        return cast("ik.Solver", self._solver)

    def with_tool(self, T_tip_tool: PoseLike) -> Robot:
        """The same robot with a tool on its tip. The new tip is the frame "tool", and it applies in every
        function.

        T_tip_tool (4, 4): the pose of the tool in the tip frame, after any tools that are already attached.
        Raises InputError for a value that is not a pose, and for a tree without a tip.
        """
        tool = one_pose(T_tip_tool, "T_tip_tool")
        return self._constructor(T_tip_tool=tool if self._T_tip_tool is None else self._T_tip_tool @ tool)()

    def with_base(self, T_world_base: PoseLike) -> Robot:
        """The same robot mounted in the world: its poses are world poses in every function.

        T_world_base (4, 4): the pose of the present base frame in the world; for a mounted robot the mount
        itself is moved. Raises InputError for a value that is not a pose, and for a floating base, whose
        pose is an argument of each call instead.
        """
        mount = one_pose(T_world_base, "T_world_base")
        return self._constructor(
            T_world_base=mount if self._T_world_base is None else mount @ self._T_world_base
        )()

    def with_payload(
        self,
        mass: float,
        com: ArrayLike = (0.0, 0.0, 0.0),
        inertia: ArrayLike | None = None,
        *,
        frame: str | None = None,
    ) -> Robot:
        """The same robot with one more body, fixed to a frame; its masses count in every function.

        mass [kg]. com (3,): its centre of mass in the frame [m]. inertia (3, 3): about its centre of mass, in
        the axes of the frame [kg·m²]; None for a point. frame: what carries it, by default the tip with its
        tool. Loads add up: the robot without them is this one. Collision checks do not know of the body; see
        Scene.attach.

        Raises InputError for a mass that is negative or not finite, wrong shapes, a tensor that is not
        symmetric, and for a tree without a tip if no frame is given; UnknownNameError for an unknown frame.
        """
        carrier = self.tip if frame is None else frame
        if carrier is None:
            choice = ", ".join(self.leaves)
            raise InputError(f"{self.name} branches, so it has no tip for a payload; give frame=: {choice}")
        link, T_link_frame = self._place_of(carrier)
        tensor = np.zeros((3, 3)) if inertia is None else one_array(inertia, "inertia", (3, 3))
        body = model.Inertial(mass, one_array(com, "com", (3,)), tensor)
        heavier = model.with_body(self.description, link, body, T_link_frame)
        return self._constructor(description=heavier)()

    @name_new_keywords
    def random_configuration(
        self, n: int | None = None, *, rng: Seed = None, reach: float | None = None
    ) -> Array:
        """Configurations drawn uniformly between the limits; see kinematics.random_configurations.

        n: how many; None gives one. rng: seed or generator. A revolute joint without limits is drawn from
        (−π, π]; a prismatic one needs reach [m]. Returns q (n, n_joints) or (n_joints,) [rad or m].
        """
        return kinematics.random_configurations(self.limits, self.joint_types, n, rng=rng, reach=reach)

    def _constructor(self, **changes: Any) -> partial[Robot]:
        """The call that makes this robot, or one with other arguments."""
        kept = {**self._made_with, "geometry": self._geometry, "cover": self._cover}
        kept["described"] = self._described
        kept |= {"T_world_base": self._T_world_base, "T_tip_tool": self._T_tip_tool}
        description = changes.pop("description", self.description)
        return partial(type(self), description, *self._ends, **(kept | changes))

    def __reduce__(self) -> tuple[Any, ...]:
        return self._constructor(), ()

    def __repr__(self) -> str:
        ends = f"{self.base} → {self.tip or '(' + ', '.join(self.leaves) + ')'}"
        freedom = f"{self.joint_types}, {self.dof} dof" + (" with a floating base" if self.floating else "")
        mounted = ", mounted in the world" if self._T_world_base is not None else ""
        return f"<Robot {self.name}: {freedom}, {ends}{mounted}>"

    def _repr_html_(self) -> str:
        columns = self.limits.lower, self.limits.upper, self.limits.velocity
        rows = [
            (name, kind, *map(shown, numbers))
            for name, kind, *numbers in zip(self.joint_names, self.joint_types, *columns, strict=True)
        ]
        return html_table(repr(self)[1:-1], ("joint", "type", "lower", "upper", "velocity"), rows)
