"""Poses as people read them."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.cli.output import Output, tidy_number


def pose_document(T: Array) -> dict[str, list[Any]]:
    """A pose (4, 4) in every form, [m] and [rad]."""
    from cspace.spatial import to_rpy, to_wxyz, to_xyzw

    forms = {"matrix": T, "xyz": T[:3, 3], "rpy": to_rpy(T), "wxyz": to_wxyz(T), "xyzw": to_xyzw(T)}
    return {name: np.asarray(value).tolist() for name, value in forms.items()}


def show_pose(out: Output, T: Array, name: str, *, degrees: bool) -> None:
    """A pose (4, 4) as a matrix and in every other form."""
    forms = pose_document(T)
    rpy = np.degrees(forms["rpy"]) if degrees else np.array(forms["rpy"])
    out.matrix(T, name)
    out.facts(
        {
            "xyz [m]": join_numbers(forms["xyz"]),
            f"rpy [{'deg' if degrees else 'rad'}]": join_numbers(rpy) + "  (about fixed x, y, z)",
            "wxyz": join_numbers(forms["wxyz"]) + "  (quaternion, real part first)",
            "xyzw": join_numbers(forms["xyzw"]) + "  (quaternion, real part last)",
        }
    )


def join_numbers(values: Any) -> str:
    """Numbers in a line, rounding noise shown as zero."""
    return "  ".join(f"{tidy_number(x):.6f}" for x in values)
