"""Angles in degrees, where radians are expected, cause a warning that names the line of the caller."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import cspace as cs
from cspace.spatial import rotation

DEGREES = (180.0, 0.0, 90.0)
TYPED = {
    "rpy": lambda make: make(rpy=DEGREES),
    "rpy of many": lambda make: make(rpy=np.array([DEGREES, DEGREES])),
    "euler": lambda make: make(euler=("ZYX", DEGREES)),
    "fixed": lambda make: make(fixed=("XYZ", DEGREES)),
    "axis_angle": lambda make: make(axis_angle=((0, 0, 1), 90)),
}


@pytest.mark.parametrize("make", [cs.pose, rotation])
@pytest.mark.parametrize("form", TYPED)
def test_degrees_in_every_form_of_a_rotation_cause_a_warning(form, make):
    with pytest.warns(UserWarning, match="angles are in radians, are these degrees?") as caught:
        TYPED[form](make)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make(rpy=(np.pi, -np.pi / 2, 2.0 * np.pi))
        make(axis_angle=((0, 0, 1), 6.28))


def test_limits_in_degrees_cause_a_warning():
    with pytest.warns(UserWarning, match="Limits holds 170: angles are in radians") as caught:
        cs.Limits([-170.0, -90.0], [170.0, 90.0])
    assert caught[0].filename == __file__


def test_no_robot_of_the_catalogue_warns():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in cs.robots.names():
            limits = cs.load_robot(name).limits
            cs.Limits(limits.lower, limits.upper, limits.velocity)
