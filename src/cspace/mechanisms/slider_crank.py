"""The slider-crank: a crank that moves a slider through a rod, or is moved by it."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array, one_number
from cspace.kinematics import AssemblyModes
from cspace.kinematics.loop_closure import list_modes
from cspace.math.wrapping import wrap_angle
from cspace.mechanisms.bodies import check_lengths, make_rod, rotate_vector
from cspace.mechanisms.circles import intersect_circles
from cspace.mechanisms.four_bar import OUT_OF_PLANE
from cspace.mechanisms.mechanism import Driven, Mechanism, Seed
from cspace.model import Description, Inertial, Joint, Link, Loop
from cspace.model.values import translation_by
from cspace.robot import Robot
from cspace.tables import shown
from cspace.tolerances import LOOP_CLOSED


class SliderCrank(Mechanism):
    """A slider-crank in the vertical plane of x and z.

    The crank turns about the origin, the slider moves along x at the height z = offset, and the rod is pinned
    to both. Coordinates: crank, counterclockwise from x; rod, its angle from the crank; slider [m]. crank,
    rod [m]: the distances between pins. offset [m]: of the line of the slider. density [kg/m]: of crank and
    rod, thin uniform rods. slider_mass [kg].

    Raises InputError for lengths and masses that are not positive.
    """

    def __init__(
        self, crank: float, rod: float, *, offset: float = 0.0, density: float = 1.0, slider_mass: float = 1.0
    ) -> None:
        sizes = check_lengths({"crank": crank, "rod": rod})
        loads = check_lengths({"density": density, "slider_mass": slider_mass})
        self.lengths = {**sizes, "offset": one_number(offset, "offset")}
        links = [Link(name, make_rod(loads["density"] * length, length)) for name, length in sizes.items()]
        block = Link("slider", Inertial(loads["slider_mass"], np.zeros(3), np.zeros((3, 3))))
        at_pin = translation_by(np.array([sizes["crank"], 0.0, 0.0]))
        line = translation_by(np.array([0.0, 0.0, self.lengths["offset"]]))
        joints = (
            Joint("crank", "continuous", "ground", "crank", axis=OUT_OF_PLANE),
            Joint("rod", "continuous", "crank", "rod", at_pin, OUT_OF_PLANE),
            Joint("slider", "prismatic", "ground", "slider", line, np.array([1.0, 0.0, 0.0])),
        )
        end = translation_by(np.array([sizes["rod"], 0.0, 0.0]))
        pin = Loop("pin", "revolute", "rod", "slider", end, axis=OUT_OF_PLANE)
        super().__init__(Robot(Description("slider_crank", (Link("ground"), *links, block), joints, (pin,))))

    def assembly_modes(self, driven: Driven, *, starts: int = 200, rng: Seed = 0) -> AssemblyModes:
        """Both configurations for one driven coordinate, in closed form.

        driven: "crank" or "rod" → angle [rad], or "slider" → position [m]. Returns AssemblyModes with q (2,
        3), one at a dead point. starts, rng: for other sets of driven coordinates, as of
        Mechanism.assembly_modes.
        """
        q = self._one_position(driven)
        if len(driven) != 1:
            return super().assembly_modes(driven, starts=starts, rng=rng)
        name, (crank, rod, offset) = next(iter(driven)), self.lengths.values()
        origin, gap = np.zeros(2), 0.0
        if name == "slider":
            pins, gap = intersect_circles(origin, crank, np.array([q[2], offset]), rod)
            turns = np.arctan2(pins[:, 1], pins[:, 0])
        else:
            reach, lead = rod, 0.0
            if name == "rod":  # crank and rod are one body
                arm = np.array([crank, 0.0]) + rotate_vector(q[1], rod)
                reach, lead = float(np.hypot(*arm)), float(np.arctan2(arm[1], arm[0]))
            height = offset - (crank * np.sin(q[0]) if name == "crank" else 0.0)
            angles, gap = find_angles_at_height(reach, height)
            turns = angles - lead if name == "rod" else np.full(len(angles), q[0])
        if gap:
            reason = f"impossible: loop 'pin' stays open, {shown(gap)} m are missing"
            return AssemblyModes(np.empty((0, 3)), True, gap, reason)
        if name == "slider":
            slides = np.full(len(turns), q[2])
        elif name == "crank":
            slides = crank * np.cos(turns) + rod * np.cos(angles)
        else:
            slides = reach * np.cos(angles)
        found = np.array([self._complete(t, x) for t, x in zip(turns, slides, strict=True)])
        found[:, self.joint_names.index(name)] = q[self.joint_names.index(name)]
        return list_modes(self.constraints, driven, found)

    def _complete(self, turn: float, slide: float) -> Array:
        """The configuration (3,) of a crank angle and a slider position that belong together."""
        crank, _, offset = self.lengths.values()
        pin = rotate_vector(turn, crank)
        rod = np.arctan2(offset - pin[1], slide - pin[0])
        return np.array([*wrap_angle(np.array([turn, rod - turn])), slide])


def find_angles_at_height(reach: float, height: float) -> tuple[Array, float]:
    """The angles (k,) at which an arm of a length [m] has its tip at a height, and the distance that is
    missing."""
    gap = abs(height) - reach
    if gap > LOOP_CLOSED * max(reach, abs(height)):
        return np.empty(0), gap
    angle = float(np.arcsin(np.clip(height / reach, -1.0, 1.0))) if reach > 0.0 else 0.0
    if gap >= -LOOP_CLOSED * reach:
        return np.array([angle]), 0.0
    return np.array([angle, np.pi - angle]), 0.0
