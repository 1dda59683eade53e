"""The delta robot: three arms move a platform that keeps its orientation, through pairs of parallel rods."""

from __future__ import annotations

from itertools import product

import numpy as np

from cspace.arrays import Array
from cspace.kinematics import AssemblyModes
from cspace.kinematics.loop_closure import list_modes
from cspace.math.wrapping import wrap_angle
from cspace.mechanisms.bodies import check_lengths, make_disc, make_rod
from cspace.mechanisms.circles import intersect_spheres
from cspace.mechanisms.mechanism import Driven, Mechanism, Seed
from cspace.mechanisms.platform import PLATFORM, make_platform
from cspace.model import Description, Inertial, Joint, Link, Loop
from cspace.model.tree import lump_bodies
from cspace.model.values import rotation_about, translation_by
from cspace.robot import Robot
from cspace.tables import shown
from cspace.tolerances import LOOP_CLOSED

ARMS = ("arm_1", "arm_2", "arm_3")
LEGS = 3


class Delta(Mechanism):
    """A delta robot (Clavel 1988) with six rods, which hangs below its base.

    Arm i turns about a horizontal axis at the angle i · 120° on a circle of base_radius, positive downwards.
    Two parallel rods lead from its end to the platform, whose joints lie on a circle of platform_radius.
    Coordinates: arm_1, arm_2, arm_3; the platform's x, y, z and its rotations rx, ry, rz, which the rods keep
    at zero.

    base_radius, platform_radius, arm, rod [m]. width [m]: between the rods of a pair. arm_density,
    rod_density [kg/m]: of arms and rods; half of the mass of a rod counts at each of its ends. platform_mass
    [kg]: a disc.

    Raises InputError for lengths and masses that are not positive.
    """

    def __init__(
        self,
        base_radius: float,
        platform_radius: float,
        arm: float,
        rod: float,
        *,
        width: float = 0.1,
        arm_density: float = 1.0,
        rod_density: float = 0.1,
        platform_mass: float = 0.5,
    ) -> None:
        sizes = check_lengths(
            {
                "base_radius": base_radius,
                "platform_radius": platform_radius,
                "arm": arm,
                "rod": rod,
                "width": width,
            }
        )
        loads = check_lengths(
            {"arm_density": arm_density, "rod_density": rod_density, "platform_mass": platform_mass}
        )
        self.lengths = sizes
        arm, rod, half = sizes["arm"], sizes["rod"], 0.5 * loads["rod_density"] * sizes["rod"]
        points = [_place(sizes["platform_radius"], side * 0.5 * sizes["width"]) for side in (1.0, -1.0)]
        ends = [_place(arm, side * 0.5 * sizes["width"]) for side in (1.0, -1.0)]
        turns = [rotation_about(np.array([0.0, 0.0, 1.0]), 2.0 * np.pi * i / LEGS) for i in range(LEGS)]
        disc = make_disc(loads["platform_mass"], sizes["platform_radius"])
        weights = [(_point(half), turn @ point) for turn in turns for point in points]
        links, joints = make_platform(Inertial(*lump_bodies([(disc, np.eye(4)), *weights])))
        beam = make_rod(loads["arm_density"] * arm, arm)
        upper = Inertial(*lump_bodies([(beam, np.eye(4)), *((_point(half), end) for end in ends)]))
        arms = [
            Joint(
                name,
                "continuous",
                "base",
                name,
                turn @ _place(sizes["base_radius"], 0.0),
                np.array([0.0, 1.0, 0.0]),
            )
            for name, turn in zip(ARMS, turns, strict=True)
        ]
        loops = [
            Loop(
                f"rod_{i + 1}{'ab'[j]}",
                "distance",
                ARMS[i],
                "platform",
                ends[j],
                turns[i] @ points[j],
                length=rod,
            )
            for i, j in product(range(LEGS), range(2))
        ]
        all_links = (Link("base"), *(Link(name, upper) for name in ARMS), *links)
        super().__init__(
            Robot(Description("delta", all_links, (*arms, *joints), tuple(loops)), floating=False)
        )

    def assembly_modes(self, driven: Driven, *, starts: int = 200, rng: Seed = 0) -> AssemblyModes:
        """All configurations with parallel rods, in closed form.

        driven: {"x": …, "y": …, "z": …} [m] for inverse kinematics, up to eight configurations, that with all
        elbows outwards first; or {"arm_1": …, "arm_2": …, "arm_3": …} [rad] for forward kinematics, up to
        two, the lower one first. Returns AssemblyModes with q (k, 9). Rods that cross each other, which other
        orientations of the platform would need, are left out. starts, rng: for other sets of driven
        coordinates, as of Mechanism.assembly_modes.
        """
        q = self._one_position(driven)
        if set(driven) == set(PLATFORM[:3]):
            return self._find_arms(q)
        if set(driven) == set(ARMS):
            return self._find_platforms(q)
        return super().assembly_modes(driven, starts=starts, rng=rng)

    def _find_arms(self, q: Array) -> AssemblyModes:
        """The configurations (k, 9) with the platform at its place in q (9,)."""
        base, platform, arm, rod, _ = self.lengths.values()
        choices: list[list[float]] = []
        for i in range(LEGS):
            out, across = _directions(i)
            v = np.array([q[LEGS : 2 * LEGS] @ out + platform - base, q[LEGS : 2 * LEGS] @ across, q[5]])
            angles, gap = find_arm_angles(v, arm, rod)
            if gap:
                reason = f"impossible: loop 'rod_{i + 1}a' stays open, {shown(gap)} m are missing"
                return AssemblyModes(np.empty((0, q.size)), True, gap, reason)
            choices.append(angles)
        found = np.array([[*arms, *q[LEGS:]] for arms in product(*choices)])
        return list_modes(self.constraints, PLATFORM, found)

    def _find_platforms(self, q: Array) -> AssemblyModes:
        """The configurations (k, 9) with the arms at their angles in q (9,)."""
        base, platform, arm, rod, _ = self.lengths.values()
        reach = base - platform + arm * np.cos(q[:LEGS])
        centers = np.array([reach[i] * _directions(i)[0] for i in range(LEGS)])
        centers[:, 2] = -arm * np.sin(q[:LEGS])
        points, gap = intersect_spheres(centers, rod)
        if gap:
            reason = f"impossible: the rods do not meet, {shown(gap)} m are missing"
            return AssemblyModes(np.empty((0, q.size)), True, gap, reason)
        points = points[np.argsort(points[:, 2], kind="stable")]
        found = np.array([[*q[:LEGS], *p, 0.0, 0.0, 0.0] for p in points])
        return list_modes(self.constraints, (*ARMS, *PLATFORM[LEGS:]), found)


def find_arm_angles(v: Array, arm: float, rod: float) -> tuple[list[float], float]:
    """The angles of an arm whose end is at the distance `rod` from a point, outwards first; what is missing
    [m].

    v (3,): the point seen from the axis of the arm: outwards, along the axis, up.
    """
    size = max(float(np.linalg.norm(v)), arm, rod)
    A = float(np.hypot(v[0], v[2]))
    nearest, farthest = float(np.hypot(A - arm, v[1])), float(np.hypot(A + arm, v[1]))
    gap = max(nearest - rod, rod - farthest)
    if gap > LOOP_CLOSED * size:
        return [], gap
    middle = float(np.arctan2(-v[2], v[0]))
    if LOOP_CLOSED * size >= A:  # every angle: one stands for all
        return [0.0], 0.0
    spread = float(np.arccos(np.clip((v @ v + arm**2 - rod**2) / (2.0 * arm * A), -1.0, 1.0)))
    if gap >= -LOOP_CLOSED * size:
        return [float(wrap_angle(np.array(middle + spread)))], 0.0
    both = wrap_angle(np.array([middle - spread, middle + spread]))
    return sorted(both.tolist(), key=np.cos, reverse=True), 0.0


def _directions(i: int) -> tuple[Array, Array]:
    """Outwards and along the axis of arm i, (3,) both."""
    angle = 2.0 * np.pi * i / LEGS
    return np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([-np.sin(angle), np.cos(angle), 0.0])


def _place(x: float, y: float) -> Array:
    return translation_by(np.array([x, y, 0.0]))


def _point(mass: float) -> Inertial:
    return Inertial(mass, np.zeros(3), np.zeros((3, 3)))
