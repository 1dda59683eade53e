"""Trajectories as JSON, the same in every bit: polynomials, timed paths, and motions joined of them."""

from __future__ import annotations

import json
import os
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import DescriptionError, InputError, name_type
from cspace.files import path_of, read_text, write_text
from cspace.trajectory.jerk_timed_path import LANDING, QUADRATIC, JerkTimedPath
from cspace.trajectory.path import Path
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.timed_motion import TimedMotion
from cspace.trajectory.timed_path import Grid, TimedPath
from cspace.trajectory.trajectory import HIGHEST_ORDER, JoinedTrajectory, Trajectory, check_trajectory

SCHEMA: Final = "cspace.trajectory/1"
"""The layout of the files."""

LARGEST_FILE: Final = 2_000_000_000
"""Bytes of a file that is read."""


def to_json(trajectory: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write a trajectory with all digits: its polynomials, or its path with the speeds on its grid.

    Of a Cartesian motion and of a motion of cs.move, the timed path of the joints is written. The limits that
    a path was timed with are not. The file is complete or untouched.
    Raises InputError for a trajectory of another kind, and where the file cannot be written.
    """
    check_trajectory(trajectory)
    values = {"schema": SCHEMA, **_describe(trajectory)}
    write_text(path_of(path), json.dumps(values, ensure_ascii=False) + "\n")


def from_json(path: str | os.PathLike[str]) -> Trajectory:
    """The trajectory that to_json wrote, the same in every bit.

    Returns a PolynomialTrajectory, TimedPath, JerkTimedPath or JoinedTrajectory. `binding` of a timed path
    then needs limits. Raises DescriptionError, with the file, for other contents.
    """
    try:
        values: Any = json.loads(read_text(path_of(path), "JSON", LARGEST_FILE, DescriptionError))
    except (ValueError, RecursionError) as error:
        if isinstance(error, DescriptionError):
            raise
        raise DescriptionError(f"this is no JSON: {error}", path=str(path)) from None
    schema = values.get("schema") if isinstance(values, dict) else None
    if schema != SCHEMA:
        raise DescriptionError(f"the schema is {schema!r}, expected {SCHEMA!r}", path=str(path))
    try:
        return _read(values)
    except (KeyError, TypeError, ValueError, IndexError, OverflowError) as error:
        raise DescriptionError(f"the trajectory cannot be read: {error}", path=str(path)) from None


def _describe(trajectory: Trajectory) -> dict[str, Any]:
    """A trajectory as values of JSON."""
    shared = {"joint_names": trajectory.joint_names, "reason": trajectory.reason}
    if isinstance(trajectory, TimedMotion):
        return {**_describe(trajectory.timed), "reason": trajectory.reason}
    if isinstance(trajectory, JoinedTrajectory):
        return {"kind": "joined", "parts": [_describe(part) for part in trajectory.parts]}
    if isinstance(trajectory, PolynomialTrajectory):
        return {
            "kind": "polynomials",
            **shared,
            "knots": trajectory.joint_knots.tolist(),
            "origins": trajectory.origins.tolist(),
            "coefficients": trajectory.coefficients.tolist(),
        }
    if isinstance(trajectory, TimedPath):
        return {**_describe_timed(trajectory), **shared}
    raise InputError(f"trajectory is {name_type(trajectory)}, of which no file is made; use to_csv")


def _describe_timed(timed: TimedPath) -> dict[str, Any]:
    path, grid = timed.path, timed.intervals
    values: dict[str, Any] = {
        "path": {
            "breaks": path.breaks.tolist(),
            "control_points": path.control_points.tolist(),
            "remarks": list(path.remarks),
        },
        "grid": {"piece": grid.piece.tolist(), "begin": grid.begin.tolist(), "end": grid.end.tolist()},
        "proved": timed.proved,
    }
    if isinstance(timed, JerkTimedPath):
        laws: dict[str, Any] = {"squares": timed.squares, "law": timed.law, "launch_jerk": timed.launch_jerk}
        return {"kind": "jerk_timed_path", **values, **{name: row.tolist() for name, row in laws.items()}}
    return {
        "kind": "timed_path",
        **values,
        "squared_speed": timed.squared_speed.tolist(),
        "rises": timed.rises.tolist(),
        "converged": timed.converged,
        "place": timed.place if np.isfinite(timed.place) else None,
        "speed_range": timed.speed_range,
    }


def _read(values: Any) -> Trajectory:
    """The trajectory of values of JSON; an error for values that are none."""
    kind = values["kind"]
    if kind == "joined":
        parts = [_read(part) for part in values["parts"]]
        if not parts or len({part.dof for part in parts}) != 1:
            raise InputError("parts must be motions of the same joints")
        return JoinedTrajectory(parts)
    if kind == "polynomials":
        return PolynomialTrajectory(
            values["knots"],
            values["coefficients"],
            values["origins"],
            joint_names=values["joint_names"],
            reason=str(values["reason"]),
        )
    if kind not in ("timed_path", "jerk_timed_path"):
        raise InputError(f"the kind is {kind!r}")
    given = values["path"]
    path = Path(given["breaks"], given["control_points"], remarks=tuple(map(str, given["remarks"])))
    grid = _read_grid(values["grid"], path)
    read = _read_jerk_timed if kind == "jerk_timed_path" else _read_timed
    with np.errstate(all="ignore"):
        timed = read(values, path, grid)
        timed.reason = str(values["reason"])
        if not (np.isfinite(timed.knots).all() and (np.diff(timed.knots) > 0.0).all()):
            raise InputError("the times of the grid do not increase")
        times = np.concatenate([timed.knots, 0.5 * (timed.knots[1:] + timed.knots[:-1])])
        if not all(np.isfinite(timed._evaluate(times, order)).all() for order in range(HIGHEST_ORDER + 1)):
            raise InputError("the motion exceeds the range of numbers")
    return timed


def _read_grid(values: Any, path: Path) -> Grid:
    """Intervals that cover the pieces of a path one after the other; none where the motion stands."""
    piece = np.asarray(values["piece"], dtype=np.int32).reshape(-1)
    begin, end = (as_floats(values[name], name).reshape(-1) for name in ("begin", "end"))
    if not len(piece) == len(begin) == len(end):
        raise InputError("the columns of the grid differ in length")
    if len(piece):
        steps = np.diff(piece, prepend=-1)
        next_piece = steps == 1
        expected = np.where(next_piece, 0.0, np.append(0.0, end[:-1]))
        closed = np.append(next_piece[1:], True)
        whole = (begin == expected).all() and (end[closed] == 1.0).all() and (begin < end).all()
        if not (whole and np.isin(steps, (0, 1)).all() and piece[-1] == len(path) - 1):
            raise InputError("the intervals of the grid do not follow one another along the path")
    return Grid(piece, begin, end)


def _read_timed(values: Any, path: Path, grid: Grid) -> TimedPath:
    squared_speed = as_floats(values["squared_speed"], "squared_speed").reshape(-1)
    if len(squared_speed) != (len(grid.piece) + 1 if len(grid.piece) else 0) or (squared_speed < 0.0).any():
        raise InputError("squared_speed must be one number of 0 or more per place of the grid")
    if ((squared_speed[1:] == 0.0) & (squared_speed[:-1] == 0.0)).any():
        raise InputError("squared_speed is 0 at two places in a row")
    rises = as_floats(values.get("rises", np.zeros(len(grid.piece))), "rises").reshape(-1)
    if len(rises) != len(grid.piece) or (0.5 * (squared_speed[1:] + squared_speed[:-1]) + rises < 0.0).any():
        raise InputError("rises must be one number per interval, that leaves its squared speed 0 or more")
    place, speeds = values["place"], values["speed_range"]
    return TimedPath(
        path,
        grid,
        squared_speed,
        np.array(rises),
        proved=bool(values["proved"]),
        converged=bool(values["converged"]),
        place=np.nan if place is None else float(place),
        speed_range=None if speeds is None else (float(speeds[0]), float(speeds[1])),
        joint_names=values["joint_names"],
    )


def _read_jerk_timed(values: Any, path: Path, grid: Grid) -> JerkTimedPath:
    squares = as_floats(values["squares"], "squares", last=(3,))
    law = np.asarray(values["law"])
    launch_jerk: Array = as_floats(values["launch_jerk"], "launch_jerk")
    count = len(grid.piece)
    if count == 0 or squares.shape != (count, 3) or law.shape != (count,) or launch_jerk.shape != (count,):
        raise InputError("squares, law and launch_jerk must have a row per interval of the grid")
    if law.dtype.kind not in "iu" or (law < QUADRATIC).any() or (law > LANDING).any():
        raise InputError(f"law must be whole numbers from {QUADRATIC} to {LANDING}")
    if (launch_jerk[law != QUADRATIC] <= 0.0).any() or (squares[:, [0, 2]] < 0.0).any():
        raise InputError("squares at places and launch_jerk must not be negative")
    return JerkTimedPath(
        path,
        grid,
        squares,
        law.astype(np.int8),
        launch_jerk,
        joint_names=values["joint_names"],
        proved=bool(values["proved"]),
    )
