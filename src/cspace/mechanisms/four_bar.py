"""The planar four-bar linkage: two links that turn about the ground, and one that couples them."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.kinematics import AssemblyModes
from cspace.kinematics.loop_closure import list_modes
from cspace.math.wrapping import wrap_angle
from cspace.mechanisms.bodies import check_lengths, make_rod, rotate_vector
from cspace.mechanisms.circles import intersect_circles
from cspace.mechanisms.mechanism import Driven, Mechanism, Seed
from cspace.model import Description, Joint, Link, Loop
from cspace.model.values import translation_by
from cspace.robot import Robot
from cspace.tables import shown
from cspace.tolerances import LOOP_CLOSED

OUT_OF_PLANE: Final = np.array([0.0, -1.0, 0.0])
"""The axis about which angles are counterclockwise where x is to the right and z is up."""


class FourBar(Mechanism):
    """A planar four-bar linkage in the vertical plane of x and z.

    The crank turns about the origin, the rocker about (ground, 0, 0), and the coupler is pinned to both.
    Coordinates: crank and rocker, counterclockwise from x, and coupler, its angle from the crank. ground,
    crank, coupler, rocker [m]: the distances between pins. density [kg/m]: of the links, thin uniform rods.

    Raises InputError for lengths that are not positive.
    """

    def __init__(
        self, ground: float, crank: float, coupler: float, rocker: float, *, density: float = 1.0
    ) -> None:
        sizes = check_lengths({"ground": ground, "crank": crank, "coupler": coupler, "rocker": rocker})
        self.lengths = sizes
        rho = check_lengths({"density": density})["density"]
        links = [
            Link(name, make_rod(rho * sizes[name], sizes[name])) for name in ("crank", "coupler", "rocker")
        ]
        joints = (
            Joint("crank", "continuous", "ground", "crank", axis=OUT_OF_PLANE),
            Joint("coupler", "continuous", "crank", "coupler", _along_x(sizes["crank"]), OUT_OF_PLANE),
            Joint("rocker", "continuous", "ground", "rocker", _along_x(sizes["ground"]), OUT_OF_PLANE),
        )
        ends = _along_x(sizes["coupler"]), _along_x(sizes["rocker"])
        pin = Loop("pin", "revolute", "coupler", "rocker", *ends, OUT_OF_PLANE)
        super().__init__(Robot(Description("four_bar", (Link("ground"), *links), joints, (pin,))))

    @property
    def kind(self) -> str:
        """What turns around, by Grashof's law: "crank-rocker" (the crank), "rocker-crank" (the rocker),
        "double-crank" (both), "double-rocker" (the coupler), "triple-rocker" (none), or "change-point".
        "impossible" if the longest link is longer than the others together."""
        sizes = self.lengths
        ordered = sorted(sizes.values())
        if ordered[3] > ordered[0] + ordered[1] + ordered[2]:
            return "impossible"
        excess = ordered[0] + ordered[3] - ordered[1] - ordered[2]
        if abs(excess) <= LOOP_CLOSED * ordered[3]:
            return "change-point"
        if excess > 0.0:
            return "triple-rocker"
        kinds = {"crank": "crank-rocker", "rocker": "rocker-crank", "ground": "double-crank"}
        return kinds.get(min(sizes, key=lambda name: sizes[name]), "double-rocker")

    def assembly_modes(self, driven: Driven, *, starts: int = 200, rng: Seed = 0) -> AssemblyModes:
        """Both configurations for one driven coordinate, in closed form: where two circles meet.

        driven: "crank", "coupler" or "rocker" → angle [rad]. Returns AssemblyModes with q (2, 3), one at a
        dead point. starts, rng: for other sets of driven coordinates, as of Mechanism.assembly_modes.
        """
        q = self._one_position(driven)
        if len(driven) != 1:
            return super().assembly_modes(driven, starts=starts, rng=rng)
        name = next(iter(driven))
        ground, crank, coupler, rocker = self.lengths.values()
        A0, B0 = np.zeros(2), np.array([ground, 0.0])
        if name == "crank":
            A = rotate_vector(q[0], crank)
            B, gap = intersect_circles(A, coupler, B0, rocker)
            A = np.broadcast_to(A, B.shape)
        elif name == "rocker":
            B = B0 + rotate_vector(q[2], rocker)
            A, gap = intersect_circles(A0, crank, B, coupler)
            B = np.broadcast_to(B, A.shape)
        else:  # crank and coupler are one body
            arm = np.array([crank, 0.0]) + rotate_vector(q[1], coupler)
            B, gap = intersect_circles(A0, float(np.hypot(*arm)), B0, rocker)
            A = np.array([rotate_vector(np.arctan2(*b[::-1]) - np.arctan2(*arm[::-1]), crank) for b in B])
            A = A.reshape(-1, 2)
        if gap:
            reason = f"impossible: loop 'pin' stays open, {shown(gap)} m are missing"
            return AssemblyModes(np.empty((0, 3)), True, gap, reason)
        found = np.array([self._find_angles(a, b) for a, b in zip(A, B, strict=True)])
        found[:, self.joint_names.index(name)] = q[self.joint_names.index(name)]
        return list_modes(self.constraints, driven, found)

    def _find_angles(self, A: Array, B: Array) -> Array:
        """The configuration (3,) with pins at A (2,) and B (2,)."""
        crank = np.arctan2(A[1], A[0])
        coupler = np.arctan2(B[1] - A[1], B[0] - A[0])
        rocker = np.arctan2(B[1], B[0] - self.lengths["ground"])
        return wrap_angle(np.array([crank, coupler - crank, rocker]))

    def dead_points(self, driven: str = "rocker") -> Array:
        """The configurations (k, 3) in which a driven link cannot move the linkage, in closed form.

        driven: "rocker", which is dead where crank and coupler are in line, or "crank", which is dead where
        coupler and rocker are. A crank that turns around has none.
        Raises UnknownNameError for another name.
        """
        if driven not in ("crank", "rocker"):
            raise suggest("driven link", driven, ("crank", "rocker"), owner=self.name)
        ground, crank, coupler, rocker = self.lengths.values()
        origin, far = np.zeros(2), np.array([ground, 0.0])
        own, other, first, second = (
            (crank, rocker, origin, far) if driven == "rocker" else (rocker, crank, far, origin)
        )
        rows = []
        for reach in (own + coupler, own - coupler):
            ends, _ = intersect_circles(first, abs(reach), second, other)
            for end in ends if abs(reach) > LOOP_CLOSED * coupler else ():
                tip = first + (end - first) * (own / reach)
                rows.append(self._find_angles(*((tip, end) if driven == "rocker" else (end, tip))))
        return np.array(rows).reshape(-1, 3)


def _along_x(distance: float) -> Array:
    return translation_by(np.array([distance, 0.0, 0.0]))
