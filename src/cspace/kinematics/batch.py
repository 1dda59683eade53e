"""What the functions of this room are given, checked once and laid out as rows for the compiled loops."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.arrays import Array, as_floats, leading_axes, whole_number
from cspace.buffer_pool import pooled_array
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.model import Limits
from cspace.spatial import as_pose
from cspace.tolerances import FARTHEST

MOST_THREADS = 1024


@dataclass(frozen=True)
class Batch:
    """Configurations as rows: q (rows, n), the leading axes they came with, and for how many threads.

    T_world_base (rows or 1, 4, 4), point (rows or 1, 3), qd, qdd and tau (rows, dof): None where not given.
    """

    q: Array
    shape: tuple[int, ...]
    threads: int
    T_world_base: Array | None = None
    point: Array | None = None
    qd: Array | None = None
    qdd: Array | None = None
    tau: Array | None = None


def rows_of(
    robot: KinematicModel,
    q: Any,
    *,
    T_world_base: Any = None,
    point: Any = None,
    qd: Any = None,
    qdd: Any = None,
    tau: Any = None,
    threads: int | None = None,
) -> Batch:
    """The arguments of a call as a Batch, their leading axes broadcast against each other.

    Raises InputError for a wrong shape, NaN or inf in anything but q (the loops look at q themselves; see
    refuse_infinite), an invalid pose, or leading axes that do not broadcast; InputTypeError for what is not a
    number.
    """
    check_robot(robot)
    q = _row_vectors(q, "q", len(robot.joint_names), "one value per joint", robot, finite=False)
    given: dict[str, tuple[Array, int]] = {"q": (q, 1)}
    if T_world_base is not None:
        given["T_world_base"] = (as_pose(T_world_base, "T_world_base"), 2)
    if point is not None:
        given["point"] = (as_floats(point, "point", last=(3,)), 1)
    for name, value, base, what in (
        ("qd", qd, "[v; ω]", "one velocity"),
        ("qdd", qdd, "[v̇; ω̇]", "one acceleration"),
        ("tau", tau, "[f; n]", "one torque or force"),
    ):
        if value is not None:
            what = (f"{base} of the base, then " if robot.floating else "") + what + " per joint"
            given[name] = (_row_vectors(value, name, robot.dof, what, robot), 1)
    shape, rows = broadcast_rows(given, shared=("T_world_base", "point"))
    return Batch(shape=shape, threads=thread_count(threads, shape), **rows)


def broadcast_rows(
    given: Mapping[str, tuple[Array, int]], shared: tuple[str, ...] = ()
) -> tuple[tuple[int, ...], dict[str, Array]]:
    """The leading axes of arrays together, and the arrays as contiguous rows.

    given: by name, each with the number of its trailing axes. shared: of these, one may serve all rows.
    """
    leads = {name: array.shape[: array.ndim - own] for name, (array, own) in given.items()}
    shape = leading_axes(**leads)
    rows = {}
    for name, (array, own) in given.items():
        lead = () if name in shared and not leads[name] else shape
        last = array.shape[array.ndim - own :]
        if array.shape != lead + last:
            array = np.broadcast_to(array, lead + last)
        rows[name] = np.ascontiguousarray(array.reshape((math.prod(lead), *last)))
    return shape, rows


def refuse_infinite(batch: Batch) -> None:
    """Raise the InputError that names the value of q which is not finite, or too large."""
    as_floats(batch.q.reshape((*batch.shape, batch.q.shape[1])), "q", largest=FARTHEST)


def find_pose(robot: object, q: Any) -> Any:
    """The configuration of a named pose of a robot; anything but a name as it is.

    Raises UnknownNameError for another name, InputTypeError for a model without named poses.
    """
    if not isinstance(q, str):
        return q
    poses: Mapping[str, Array] | None = getattr(robot, "named_poses", None)
    if poses is None:
        raise InputTypeError(f"{name_type(robot)} has no named poses; give a configuration")
    return poses[q]


def check_robot(robot: object) -> None:
    """Raise InputTypeError for an object that is not a robot, such as its name."""
    if not isinstance(robot, KinematicModel):
        raise InputTypeError(
            f"the first argument must be a Robot, got {type(robot).__name__};"
            " cspace.load_robot(name) returns one"
        )


def limits_of(own: Limits, limits: Any, name: str) -> Limits:
    """The limits that an argument means: its own for None or True, none for False, or those given.

    Raises InputTypeError for anything else, InputError for another number of joints than `own` has.
    """
    if limits is None or limits is True:
        return own
    n = len(own)
    if limits is False:
        return Limits(np.full(n, -np.inf), np.full(n, np.inf))
    if not isinstance(limits, Limits):
        raise InputTypeError(
            f"limits is {name_type(limits)}, expected cspace.model.Limits, or False for none"
        )
    if len(limits) != n:
        raise InputError(f"limits are for {len(limits)} joints, {name} has {n}")
    return limits


def frame_number(robot: KinematicModel, frame: str | None) -> int:
    """The number of a frame among `robot.frames`, of the tip if None.

    Raises UnknownNameError for an unknown name, InputError for a tree without a tip.
    """
    check_robot(robot)
    if frame is None:
        frame = robot.tip
    if frame is None:
        raise InputError(
            f"{robot.name} branches, so name a frame: frame= in this call, or tip= when the robot is made;"
            f" its branches end at {', '.join(robot.leaves)}"
        )
    if not isinstance(frame, str):
        raise InputTypeError(f"frame must be a name, got {type(frame).__name__}; see robot.frames")
    try:
        return robot.frames.index(frame)
    except ValueError:
        raise suggest("frame", frame, robot.frames, owner=robot.name) from None


def check_output(out: Any, shape: tuple[int, ...], subject: str = "out") -> Array:
    """The array to write into: a new one, or the caller's if it fits.

    Raises InputTypeError unless out is a contiguous float64 array, InputError for another shape.
    """
    if out is None:
        return pooled_array(shape)
    if not isinstance(out, np.ndarray) or out.dtype != np.float64:
        kind = f"an array of {out.dtype}" if isinstance(out, np.ndarray) else type(out).__name__
        raise InputTypeError(f"{subject} must be a float64 array to write into, got {kind}")
    if out.shape != shape:
        raise InputError(f"{subject} has shape {out.shape}, expected {shape}")
    if not (out.flags.c_contiguous and out.flags.writeable and out.flags.aligned):
        raise InputError(f"{subject} must be C-contiguous and writeable, such as np.empty({shape})")
    return out


def check_choice(value: Any, subject: str, known: tuple[str, ...]) -> str:
    """The value of the argument `subject` if it is one of the known words.

    Raises UnknownNameError, with the nearest word, if not.
    """
    if isinstance(value, str) and value in known:
        return value
    raise suggest(f"{subject} choice", value, known)


def check_flag(value: Any, subject: str) -> bool:
    """The value of the argument `subject`; InputTypeError for what is neither True nor False."""
    if not isinstance(value, bool | np.bool_):
        raise InputTypeError(f"{subject} must be True or False, got {value!r}")
    return bool(value)


def _row_vectors(
    value: Any, subject: str, n: int, what: str, robot: KinematicModel, *, finite: bool = True
) -> Array:
    array = as_floats(value, subject, finite=finite)
    if array.ndim == 0 or array.shape[-1] != n:
        names = ", ".join(robot.joint_names)
        raise InputError(
            f"{subject} has shape {array.shape}, expected (..., {n}): {what} of {robot.name}"
            + (f" ({names})" if len(robot.joint_names) <= 12 else "")
        )
    return array


def thread_count(threads: Any, shape: tuple[int, ...]) -> int:
    """1 for a single call; 0, which means every processor, for a batch without a wish."""
    if threads is None:
        return 0 if shape else 1
    return whole_number(threads, "threads", 0, MOST_THREADS, "0 or None for every processor")
