"""A UR arm as its maker measured it: the joint frames of the calibration in place of the nominal ones."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from cspace.errors import DescriptionError, InputError
from cspace.model.calibration_file import PARTS, Calibration, read_calibration
from cspace.model.chain import chain
from cspace.model.description import Description, Source
from cspace.model.joint import Joint
from cspace.tolerances import CALIBRATION_ANGLE, CALIBRATION_DISTANCE

JOINTS: Final = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
"""The joints of a UR arm, in order, without "_joint"; each is placed by the entry of PARTS at its place."""


def calibrated(description: Description, path: str | os.PathLike[str]) -> Description:
    """A UR arm with the joint frames of a calibration file.

    The file is what ur_calibration of ROS extracts from the arm, or a default_kinematics.yaml of
    ur_description. Its frames stand as in ur_description, and so do those of the description, a UR arm of the
    catalogue or a URDF: each joint turns about its own z. All else is kept.
    Raises DescriptionError with file and line for a bad file, and for a calibration that is further off than
    tolerances.CALIBRATION_DISTANCE or CALIBRATION_ANGLE, which is that of another arm; InputError for a robot
    that is no UR arm, and for one with other link frames.
    """
    calibration = read_calibration(path)
    joints = joints_of(description)
    if any(joint.axis.tolist() != [0.0, 0.0, 1.0] for joint in joints):
        raise InputError(
            f"the link frames of robot {description.name!r} do not fit a calibration, in which each joint"
            " rotates about its own z axis; use a URDF of ur_description, or the name of the arm"
        )
    result = replace_joints(description, joints, calibration)
    check_calibration(description, result, joints, calibration)
    known = description.provenance
    named = f"calibration {calibration.hash}".rstrip() + f" ({os.path.basename(calibration.path)})"
    sources = {**known.sources, "joints": Source(named)}
    return replace(result, provenance=replace(known, sources=sources))


def joints_of(description: Description) -> list[Joint]:
    """The six joints of the arm, with any prefix of their names."""
    found = []
    for name in JOINTS:
        fitting = [joint for joint in description.moving_joints if joint.name.endswith(f"{name}_joint")]
        if len(fitting) != 1:
            some = "several joints" if fitting else "no joint"
            raise InputError(
                f"robot {description.name!r} has {some} named …{name}_joint; a calibration fits one arm of"
                " Universal Robots with the joint names of ROS"
            )
        found.append(fitting[0])
    for before, after in pairwise(found):
        if before.child != after.parent:
            raise InputError(
                f"joint {after.name!r} of robot {description.name!r} does not follow {before.name!r}"
                " directly, as it does in a UR arm"
            )
    return found


def replace_joints(
    description: Description, joints: Sequence[Joint], calibration: Calibration
) -> Description:
    """The same links with other joint frames."""
    names = {joint.name: part for joint, part in zip(joints, PARTS, strict=True)}
    changed = tuple(
        replace(joint, origin=calibration.origins[names[joint.name]]) if joint.name in names else joint
        for joint in description.joints
    )
    return replace(description, joints=changed)


def check_calibration(
    nominal: Description, measured: Description, joints: Sequence[Joint], calibration: Calibration
) -> None:
    """Raise if the calibration is that of another arm: its axes at zero are far from the nominal ones."""
    first = chain(nominal, joints[0].parent, joints[-1].child)
    second = chain(measured, joints[0].parent, measured.joint(joints[-1].name).child)
    for i, joint in enumerate(joints):
        angle = math.acos(min(1.0, float(abs(first.axes[i] @ second.axes[i]))))
        away = float(np.linalg.norm(np.cross(first.points[i] - second.points[i], second.axes[i])))
        if angle > CALIBRATION_ANGLE or away > CALIBRATION_DISTANCE:
            raise DescriptionError(
                f"this calibration is not that of {nominal.name!r}: the axis of"
                f" {joint.name!r} deviates by {away:.3g} m and {angle:.3g} rad (allowed:"
                f" {CALIBRATION_DISTANCE:g} m, {CALIBRATION_ANGLE:g} rad)",
                path=calibration.path,
            )
