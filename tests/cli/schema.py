"""The JSON that every verb promises, as docs/cli.md documents it: keys and what stands behind them."""

from __future__ import annotations

from typing import Any

NUMBER = (int, float)
TEXT = str
TEXT_OR_NULL = (str, type(None))
NUMBER_OR_NULL = (int, float, type(None))
LIST_OR_NULL = (list, type(None))
VECTOR = [NUMBER]
MATRIX = [[NUMBER]]

POSE_ERRORS: dict[str, Any] = {
    "count": int,
    "rmse": NUMBER,
    "mean": NUMBER,
    "median": NUMBER,
    "max": NUMBER,
    "turn_rmse": NUMBER,
    "turn_max": NUMBER,
}

SCHEMAS: dict[str, dict[str, Any]] = {
    "cspace.robots/1": {
        "robots": [
            {
                "name": TEXT,
                "dof": int,
                "joints": TEXT,
                "title": TEXT,
                "vendor": TEXT,
                "source": TEXT,
                "licence": TEXT,
                "aliases": [TEXT],
                "missing": [TEXT],
            }
        ]
    },
    "cspace.info/1": {
        "robot": TEXT,
        "title": TEXT,
        "maker": TEXT,
        "aliases": [TEXT],
        "sources": dict,
        "missing": [TEXT],
        "base": TEXT,
        "tip": TEXT_OR_NULL,
        "leaves": [TEXT],
        "joints": [
            {
                "name": TEXT,
                "type": TEXT,
                "lower": NUMBER_OR_NULL,
                "upper": NUMBER_OR_NULL,
                "velocity": NUMBER_OR_NULL,
                "effort": NUMBER_OR_NULL,
            }
        ],
        "frames": [TEXT],
        "loops": [TEXT],
        "poses": dict,
        "geometry": (dict, type(None)),
        "freedoms": {
            "dof": int,
            "description": int,
            "mobility": int,
            "rank": (int, type(None)),
            "task": TEXT,
            "task_numbers": int,
            "verdict": TEXT,
        },
    },
    "cspace.fk/1": {
        "robot": TEXT,
        "base": TEXT,
        "frame": TEXT,
        "q": VECTOR,
        "matrix": MATRIX,
        "xyz": VECTOR,
        "rpy": VECTOR,
        "wxyz": VECTOR,
        "xyzw": VECTOR,
    },
    "cspace.jacobian/1": {
        "robot": TEXT,
        "base": TEXT,
        "frame": TEXT,
        "expressed_in": TEXT,
        "q": VECTOR,
        "joints": [TEXT],
        "jacobian": MATRIX,
        "rows": TEXT,
        "singular_values": VECTOR,
        "manipulability": NUMBER,
        "distance_to_singularity": NUMBER,
        "singular": bool,
        "lost_direction": VECTOR,
        "lost_by": [TEXT],
    },
    "cspace.dynamics/1": {
        "robot": TEXT,
        "base": TEXT,
        "joints": [TEXT],
        "mass": NUMBER,
        "q": VECTOR,
        "qd": VECTOR,
        "qdd": VECTOR,
        "tau": VECTOR,
        "gravity_torques": VECTOR,
        "mass_matrix": MATRIX,
        "coriolis_matrix": MATRIX,
        "momentum": VECTOR,
        "momentum_matrix": MATRIX,
        "center_of_mass": VECTOR,
        "kinetic_energy": NUMBER,
        "potential_energy": NUMBER,
        "T_world_base": LIST_OR_NULL,
        "frame": TEXT_OR_NULL,
        "operational_inertia": LIST_OR_NULL,
        "loops": [TEXT],
        "warnings": [TEXT],
        "written": [TEXT],
    },
    "cspace.localize/1": {
        "log": TEXT,
        "filter": TEXT,
        "status": TEXT,
        "reason": TEXT,
        "times": VECTOR,
        "poses": MATRIX,
        "deviations": MATRIX,
        "rmse": NUMBER_OR_NULL,
        "written": [TEXT],
    },
    "cspace.slam/1": {
        "file": TEXT,
        "method": TEXT,
        "status": TEXT,
        "reason": TEXT,
        "times": LIST_OR_NULL,
        "poses": list,
        "deviations": LIST_OR_NULL,
        "landmarks": MATRIX,
        "chi2": NUMBER_OR_NULL,
        "dof": (int, type(None)),
        "rejected": [{"edge": int, "first": int, "second": int, "chi2": NUMBER, "limit": NUMBER}],
        "rmse": NUMBER_OR_NULL,
        "written": [TEXT],
    },
    "cspace.evaluate/1": {
        "estimate": TEXT,
        "truth": TEXT,
        "align": TEXT_OR_NULL,
        "ate": {**POSE_ERRORS},
        "rpe": [{"delta": NUMBER, "unit": TEXT, **POSE_ERRORS}],
        "alignment": MATRIX,
    },
    "cspace.simulate/1": {
        "robot": TEXT,
        "joints": [TEXT],
        "method": TEXT,
        "times": VECTOR,
        "q": MATRIX,
        "qd": MATRIX,
        "tau": MATRIX,
        "T_world_base": LIST_OR_NULL,
        "energy": VECTOR,
        "momentum": MATRIX,
        "stopped": NUMBER,
        "ended": bool,
        "reason": TEXT,
        "loops": [TEXT],
        "written": [TEXT],
    },
    "cspace.traj/1": {
        "robot": TEXT,
        "joints": [TEXT],
        "kind": TEXT,
        "duration": NUMBER,
        "reason": TEXT,
        "exceeded": [TEXT],
        "times": VECTOR,
        "q": MATRIX,
        "qd": MATRIX,
        "qdd": MATRIX,
        "written": [TEXT],
    },
    "cspace.nav/1": {
        "map": TEXT,
        "start": VECTOR,
        "goal": VECTOR,
        "radius": NUMBER,
        "routes": [
            {
                "planner": TEXT,
                "status": TEXT,
                "reason": TEXT,
                "length": NUMBER_OR_NULL,
                "ratio_to_shortest": NUMBER_OR_NULL,
                "clearance": NUMBER_OR_NULL,
                "nodes": int,
                "edges": int,
                "seconds": NUMBER,
                "seconds_first": NUMBER,
                "seconds_again": NUMBER_OR_NULL,
                "options": dict,
                "path": MATRIX,
            }
        ],
        "refused": dict,
        "written": [TEXT],
    },
    "cspace.plan/1": {
        "robot": TEXT,
        "base": TEXT,
        "tip": TEXT,
        "joints": [TEXT],
        "start": VECTOR,
        "goal": {
            "configurations": LIST_OR_NULL,
            "matrix": LIST_OR_NULL,
            "position": LIST_OR_NULL,
            "rotation": LIST_OR_NULL,
            "angle": NUMBER_OR_NULL,
            "direction": LIST_OR_NULL,
            "look_at": LIST_OR_NULL,
            "ray": LIST_OR_NULL,
            "angle_to": LIST_OR_NULL,
            "tool_axis": (list, str, type(None)),
            "box": LIST_OR_NULL,
            "within": NUMBER_OR_NULL,
        },
        "scene": TEXT_OR_NULL,
        "margin": NUMBER,
        "planner": TEXT,
        "options": dict,
        "seed": int,
        "status": TEXT,
        "reason": TEXT,
        "path": MATRIX,
        "cost": NUMBER_OR_NULL,
        "goal_index": (int, type(None)),
        "certified": bool,
        "clearance": NUMBER_OR_NULL,
        "seconds": NUMBER,
        "stats": dict,
        "duration": NUMBER_OR_NULL,
        "written": [TEXT],
    },
    "cspace.planners/1": {
        "planners": [
            {
                "name": TEXT,
                "summary": TEXT,
                "world": TEXT,
                "sensing": TEXT,
                "options": [
                    {
                        "name": TEXT,
                        "type": TEXT,
                        "default": (str, int, float, bool, type(None)),
                        "unit": TEXT,
                        "meaning": TEXT,
                    }
                ],
            }
        ]
    },
    "cspace.space/1": {
        "robot": TEXT,
        "scene": TEXT,
        "link_radius": NUMBER,
        "obstacles": [TEXT],
        "lower": VECTOR,
        "upper": VECTOR,
        "wraps": [bool],
        "components": [
            {"area": NUMBER, "area_bounds": VECTOR, "point": VECTOR, "region": int, "proved": bool}
        ],
        "boundaries": [{"kind": TEXT, "obstacle": TEXT, "points": MATRIX}],
        "start": LIST_OR_NULL,
        "goals": MATRIX,
        "status": TEXT_OR_NULL,
        "reason": TEXT_OR_NULL,
        "path": MATRIX,
        "length": NUMBER_OR_NULL,
        "written": [TEXT],
    },
    "cspace.joint_space/1": {
        "robot": TEXT,
        "scene": TEXT_OR_NULL,
        "margin": NUMBER,
        "joints": [TEXT],
        "lower": VECTOR,
        "upper": VECTOR,
        "wraps": [bool],
        "obstacles": [TEXT],
        "seed": int,
        "volume": (dict, type(None)),
        "slice": (dict, type(None)),
        "projection": (dict, type(None)),
        "written": [TEXT],
    },
    "cspace.export/1": {
        "language": TEXT,
        "name": TEXT,
        "method": TEXT,
        "written": [TEXT],
        "files": dict,
    },
    "cspace.dh/1": {
        "robot": TEXT,
        "convention": TEXT,
        "rows": [{"joint": TEXT, "type": TEXT, "alpha": NUMBER, "a": NUMBER, "d": NUMBER, "theta": NUMBER}],
        "base": MATRIX,
        "tool": MATRIX,
        "deviation": NUMBER,
        "matrices": [MATRIX],
        "symbols": [[[TEXT]]],
    },
    "cspace.ik/1": {
        "robot": TEXT,
        "base": TEXT,
        "tip": TEXT,
        "joints": [TEXT],
        "goal": {
            "matrix": LIST_OR_NULL,
            "position": LIST_OR_NULL,
            "rotation": LIST_OR_NULL,
            "angle": NUMBER_OR_NULL,
            "direction": LIST_OR_NULL,
            "look_at": LIST_OR_NULL,
            "ray": LIST_OR_NULL,
            "angle_to": LIST_OR_NULL,
            "tool_axis": (list, str, type(None)),
        },
        "locked": dict,
        "swivel": NUMBER_OR_NULL,
        "status": TEXT,
        "complete": bool,
        "reason": TEXT,
        "out_of_reach": NUMBER,
        "freedom": [TEXT],
        "solutions": [
            {
                "q": VECTOR,
                "branch": TEXT,
                "within_limits": (bool, type(None)),
                "out_of_limits": dict,
                "singularity": NUMBER_OR_NULL,
                "residual": NUMBER,
                "distance": NUMBER_OR_NULL,
            }
        ],
    },
    "cspace.ik_plan/1": {
        "robot": TEXT,
        "joints": [TEXT],
        "family": TEXT,
        "summary": TEXT,
        "reason": TEXT,
        "branches": int,
        "relations": [{"axes": [int], "angle": NUMBER, "distance": NUMBER_OR_NULL, "words": TEXT}],
        "points": [{"place": VECTOR, "joints": [int], "miss": NUMBER}],
        "directions": [{"direction": VECTOR, "joints": [int], "miss": NUMBER}],
        "notes": [TEXT],
        "constants": dict,
        "matrices": dict,
        "locked": [TEXT],
        "counted": TEXT,
        "calls": [TEXT],
        "other_ways": dict,
        "steps": [
            {
                "finds": TEXT,
                "ways": int,
                "method": TEXT,
                "words": TEXT,
                "equations": [{"text": TEXT, "latex": TEXT, "numbers": TEXT}],
            }
        ],
    },
    "cspace.doctor/1": {
        "versions": dict,
        "extras": dict,
        "checks": [{"robot": TEXT, "poses": int, "solutions": int, "worst": NUMBER, "passed": bool}],
        "healthy": bool,
    },
}


def check(document: Any, schema: str | None = None) -> None:
    """The document is what its schema says: the same keys, the right kinds of values."""
    assert schema is None or document["schema"] == schema
    body = {key: value for key, value in document.items() if key != "schema"}
    check_value(body, SCHEMAS[document["schema"]], document["schema"])


def check_value(value: Any, kind: Any, where: str) -> None:
    if isinstance(kind, dict):
        assert isinstance(value, dict), where
        assert set(value) == set(kind), f"{where}: {set(value) ^ set(kind)}"
        for key, inner in kind.items():
            check_value(value[key], inner, f"{where}.{key}")
    elif isinstance(kind, list):
        assert isinstance(value, list), where
        for i, item in enumerate(value):
            check_value(item, kind[0], f"{where}[{i}]")
    else:
        assert isinstance(value, kind), f"{where} is {value!r}"
        assert (
            kind is bool or not isinstance(value, bool) or bool in (kind if isinstance(kind, tuple) else ())
        )
