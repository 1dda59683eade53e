"""The Stewart platform: six legs of variable length carry a platform with six degrees of freedom."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_generator, one_array
from cspace.errors import InputError
from cspace.kinematics import AssemblyModes, LoopConstraints, find_assembly_modes
from cspace.mechanisms.bodies import check_lengths, make_disc, make_rod
from cspace.mechanisms.mechanism import Driven, Mechanism, Seed
from cspace.mechanisms.platform import PLATFORM, find_platform_angles, make_platform
from cspace.model import Description, Inertial, Joint, Link, Loop
from cspace.model.values import translation_by
from cspace.robot import Robot
from cspace.spatial.checks import PoseLike, one_pose
from cspace.spatial.vectors import frame_along
from cspace.tolerances import SAME_MODE

LEGS = 6
LENGTHS = tuple(f"length_{i + 1}" for i in range(LEGS))


class Stewart(Mechanism):
    """A Stewart platform (Gough 1956, Stewart 1965): six legs with a universal joint below and a ball above.

    Coordinates: of leg i the two angles u_i, v_i of its universal joint and length_i [m], the distance
    between its joints; and of the platform x, y, z and its rotations rx, ry, rz about its own axes, one after
    the other. The driven joints are the lengths.

    base_points, platform_points (6, 3) [m]: the joints of the legs in the frames of base and platform. height
    [m]: of the platform at home, where the legs have u = v = 0. leg_density [kg/m]: of the lower half of each
    leg at home and of the upper one, thin uniform rods. platform_mass [kg]: a disc.

    Raises InputError for a wrong shape, NaN, lengths and masses that are not positive.
    """

    def __init__(
        self,
        base_points: ArrayLike,
        platform_points: ArrayLike,
        height: float,
        *,
        leg_density: float = 1.0,
        platform_mass: float = 2.0,
    ) -> None:
        self.base_points = one_array(base_points, "base_points", (LEGS, 3), "the joint of each leg")
        self.platform_points = one_array(
            platform_points, "platform_points", (LEGS, 3), "the joint of each leg"
        )
        sizes = check_lengths({"height": height, "leg_density": leg_density, "platform_mass": platform_mass})
        self.home = np.array([0.0, 0.0, sizes["height"], 0.0, 0.0, 0.0])
        home_legs = self.platform_points + self.home[:3] - self.base_points
        self._home_lengths = np.linalg.norm(home_legs, axis=1)
        if not self._home_lengths.all():
            raise InputError("a leg has length 0 at home; base_points and platform_points coincide there")
        self._T_base_leg = np.tile(np.eye(4), (LEGS, 1, 1))
        self._T_base_leg[:, :3, 3] = self.base_points
        self._T_base_leg[:, :3, :3] = [frame_along(leg) for leg in home_legs / self._home_lengths[:, None]]
        radius = float(np.linalg.norm(self.platform_points, axis=1).max())
        links, joints = make_platform(make_disc(sizes["platform_mass"], radius))
        leg_links: list[Link] = [Link("base")]
        leg_joints: list[Joint] = []
        for i, half in enumerate(0.5 * self._home_lengths):
            rod = make_rod(sizes["leg_density"] * half, half, axis=2)
            upper = Inertial(rod.mass, -rod.com, rod.inertia)  # it ends at the ball
            name = f"leg_{i + 1}"
            leg_links += [Link(f"{name}_cross"), Link(f"{name}_lower", rod), Link(f"{name}_upper", upper)]
            leg_joints += [
                Joint(f"u_{i + 1}", "continuous", "base", f"{name}_cross", self._T_base_leg[i], np.eye(3)[0]),
                Joint(f"v_{i + 1}", "continuous", f"{name}_cross", f"{name}_lower", axis=np.eye(3)[1]),
                Joint(LENGTHS[i], "prismatic", f"{name}_lower", f"{name}_upper", axis=np.eye(3)[2]),
            ]
        balls = [
            Loop(
                f"ball_{i + 1}",
                "spherical",
                f"leg_{i + 1}_upper",
                "platform",
                child_origin=translation_by(point),
            )
            for i, point in enumerate(self.platform_points)
        ]
        description = Description("stewart", (*leg_links, *links), (*leg_joints, *joints), tuple(balls))
        super().__init__(Robot(description))

    @classmethod
    def of_radii(cls, base_radius: float, platform_radius: float, height: float, **masses: float) -> Stewart:
        """The usual form: joints in pairs on two circles, legs from pair to pair crosswise.

        base_radius, platform_radius, height [m]. Pairs are 20° apart on both circles. masses: leg_density,
        platform_mass.
        """
        radii = check_lengths({"base_radius": base_radius, "platform_radius": platform_radius})
        base = np.radians([-10, 10, 110, 130, 230, 250])
        platform = np.radians([-50, 50, 70, 170, 190, 290])
        return cls(
            _on_circle(radii["base_radius"], base),
            _on_circle(radii["platform_radius"], platform),
            height,
            **masses,
        )

    def pose_coordinates(self, T_base_platform: PoseLike) -> dict[str, float]:
        """The coordinates x, y, z, rx, ry, rz of a pose (4, 4) of the platform, as driven coordinates."""
        T = one_pose(T_base_platform, "T_base_platform")
        return dict(
            zip(PLATFORM, [*T[:3, 3].tolist(), *find_platform_angles(T[:3, :3]).tolist()], strict=True)
        )

    def assembly_modes(self, driven: Driven, *, starts: int = 200, rng: Seed = 0) -> AssemblyModes:
        """The configurations for a pose of the platform, or for lengths of the legs.

        driven: x, y, z, rx, ry, rz for inverse kinematics, which is one configuration, with legs of positive
        lengths that are not turned around; or length_1 to length_6 for forward kinematics, of which there are
        up to 40: those that are found from so many starts, never called complete. Returns AssemblyModes with
        q (k, 24). Other sets of driven coordinates: as of Mechanism.assembly_modes.
        """
        q = self._one_position(driven)
        if set(driven) == set(PLATFORM):
            q = self._complete(q[-6:])
            return AssemblyModes(q[None], True, 0.0, "found")
        if set(driven) == set(LENGTHS):
            return self._find_platforms(driven, starts, rng)
        return super().assembly_modes(driven, starts=starts, rng=rng)

    def _complete(self, platform: Array) -> Array:
        """The configuration (24,) of the coordinates (6,) of the platform."""
        legs = np.zeros(3 * LEGS)
        T = self.robot.fk(np.concatenate([legs, platform]), "platform")
        tips = self.platform_points @ T[:3, :3].T + T[:3, 3] - self.base_points
        w = np.einsum("lij,li->lj", self._T_base_leg[:, :3, :3], tips)
        length = np.linalg.norm(w, axis=1)
        legs[0::3] = np.arctan2(-w[:, 1], w[:, 2])
        legs[1::3] = np.arctan2(w[:, 0], np.hypot(w[:, 1], w[:, 2]))
        legs[2::3] = length
        return np.concatenate([legs, platform])

    def _find_platforms(self, driven: Driven, starts: int, rng: Seed) -> AssemblyModes:
        """The configurations (k, 24) that are found for given lengths, with the platform alone on six
        rods."""
        n = len(self.joint_names)
        values = self.configuration(driven)[2 : 3 * LEGS : 3]
        lengths = check_lengths(dict(zip(LENGTHS, values.tolist(), strict=True)))
        constraints = self._platform_on_rods(np.array(list(lengths.values())))
        found = find_assembly_modes(constraints, {}, starts=starts, rng=as_generator(rng))
        if not found:
            reason = found.reason.replace("rod_", "ball_")
            return AssemblyModes(np.empty((0, n)), False, found.gap, reason)
        kept: list[Array] = []
        poses: list[Array] = []
        for row in found.q:  # angles that mean the same pose are one
            T = constraints.robot.fk(row, "platform")
            if all(np.abs(T - other).max() > SAME_MODE * max(1.0, constraints.length) for other in poses):
                poses.append(T)
                angles = find_platform_angles(T[:3, :3])
                kept.append(self._complete(np.concatenate([T[:3, 3], angles])))
        return AssemblyModes(np.array(kept), False, 0.0, "found")

    def _platform_on_rods(self, lengths: Array) -> LoopConstraints:
        """The same platform on rods of given lengths (6,): six coordinates instead of 24."""
        links, joints = make_platform(make_disc(1.0, 1.0))
        rods = [
            Loop(
                f"rod_{i + 1}",
                "distance",
                "base",
                "platform",
                translation_by(self.base_points[i]),
                translation_by(self.platform_points[i]),
                length=length,
            )
            for i, length in enumerate(lengths)
        ]
        robot = Robot(Description("stewart", (Link("base"), *links), tuple(joints)))
        return LoopConstraints(robot, rods)


def _on_circle(radius: float, angles: Array) -> Array:
    return radius * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])
