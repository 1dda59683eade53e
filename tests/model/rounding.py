"""Robots as files print them that round right angles."""

import math
import re

from cspace.model import from_urdf, to_urdf

QUARTER = math.pi / 2


def print_right_angles(description, digits):
    """The description as a URDF file of it is read that prints multiples of π/2 with so many decimals."""

    def printed(match):
        angles = [float(word) for word in match[1].split()]
        return f'rpy="{" ".join(round_right_angle(angle, digits) for angle in angles)}"'

    return from_urdf(re.sub(r'rpy="([^"]*)"', printed, to_urdf(description)))


def round_right_angle(angle, digits):
    """The text of an angle, with so many decimals where it is a multiple of π/2."""
    is_right = abs(angle - round(angle / QUARTER) * QUARTER) < 1e-12
    return f"{angle:.{digits}f}" if is_right else repr(angle)
