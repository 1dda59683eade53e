"""cspace: from a robot's description to its motion."""

import logging
import sys
from typing import TYPE_CHECKING, Any

from cspace.errors import CspaceError

if TYPE_CHECKING:
    from cspace import (
        cartesian,
        collision,
        dynamics,
        export,
        ik,
        kinematics,
        localization,
        maps,
        mechanisms,
        mobile,
        model,
        navigation,
        planning,
        plot,
        robots,
        shapes,
        spatial,
        trajectory,
    )
    from cspace._core import __version__
    from cspace.collision import Scene
    from cspace.ik import (
        CenterOfMassTask,
        DirectionTask,
        PoseTask,
        PositionTask,
        PostureTask,
        subproblems,
    )
    from cspace.localization import (
        IncrementalGraph,
        LaserScanner,
        ParticleFilter,
        PoseGraph,
        ate,
        localize,
        match_scan,
        read_log,
        rpe,
        slam,
    )
    from cspace.maps import OccupancyGrid, PolygonWorld
    from cspace.mechanisms import Mechanism
    from cspace.mobile import Car, DifferentialDrive, Mecanum, Omni, Tracked, Unicycle
    from cspace.model import Limits
    from cspace.navigation.navigate import navigate
    from cspace.plan_motion import move, plan, plan_many
    from cspace.planning import configuration_space
    from cspace.robot import Robot
    from cspace.robots import load_robot
    from cspace.shapes import (
        Box,
        Capsule,
        Cylinder,
        HalfSpace,
        HeightField,
        Hull,
        Mesh,
        PointCloud,
        Sphere,
    )
    from cspace.spatial import *  # noqa: F403
    from cspace.trajectory import blend, spline, time_parametrize

logging.getLogger("cspace").addHandler(logging.NullHandler())

__all__ = [
    "CspaceError",
    "IncrementalGraph",
    "LaserScanner",
    "Limits",
    "Mechanism",
    "OccupancyGrid",
    "ParticleFilter",
    "PolygonWorld",
    "PoseGraph",
    "Robot",
    "Scene",
    "__version__",
    "ate",
    "cartesian",
    "collision",
    "configuration_space",
    "dynamics",
    "export",
    "ik",
    "kinematics",
    "load_robot",
    "localization",
    "localize",
    "maps",
    "match_scan",
    "mechanisms",
    "mobile",
    "model",
    "move",
    "navigate",
    "navigation",
    "plan",
    "plan_many",
    "planning",
    "read_log",
    "rpe",
    "slam",
]
__all__ += ["plot", "robots", "shapes", "spatial", "subproblems", "trajectory"]
__all__ += ["Box", "Capsule", "Cylinder", "HalfSpace", "HeightField", "Hull", "Mesh", "PointCloud", "Sphere"]
__all__ += ["blend", "spline", "time_parametrize"]
__all__ += ["Car", "DifferentialDrive", "Mecanum", "Omni", "Tracked", "Unicycle"]
__all__ += ["CenterOfMassTask", "DirectionTask", "PoseTask", "PositionTask", "PostureTask"]
if TYPE_CHECKING:
    __all__ += spatial.__all__
# __getattr__ makes the whole list: it holds the names of spatial, and spatial needs numpy.
_OWN: list[str] = globals().pop("__all__")

# Where the names are that are imported when they are first used: numpy and the rooms take time to load. The
# names that are not here are those of spatial.
_LATER = {
    "Box": "cspace.shapes",
    "Capsule": "cspace.shapes",
    "Car": "cspace.mobile",
    "CenterOfMassTask": "cspace.ik",
    "Cylinder": "cspace.shapes",
    "DifferentialDrive": "cspace.mobile",
    "DirectionTask": "cspace.ik",
    "HalfSpace": "cspace.shapes",
    "HeightField": "cspace.shapes",
    "Hull": "cspace.shapes",
    "IncrementalGraph": "cspace.localization",
    "LaserScanner": "cspace.localization",
    "Limits": "cspace.model",
    "Mechanism": "cspace.mechanisms",
    "Mecanum": "cspace.mobile",
    "Mesh": "cspace.shapes",
    "OccupancyGrid": "cspace.maps",
    "Omni": "cspace.mobile",
    "ParticleFilter": "cspace.localization",
    "PointCloud": "cspace.shapes",
    "PolygonWorld": "cspace.maps",
    "PoseGraph": "cspace.localization",
    "PoseTask": "cspace.ik",
    "PositionTask": "cspace.ik",
    "PostureTask": "cspace.ik",
    "Robot": "cspace.robot",
    "Scene": "cspace.collision",
    "Sphere": "cspace.shapes",
    "Tracked": "cspace.mobile",
    "Unicycle": "cspace.mobile",
    "__version__": "cspace._core",
    "ate": "cspace.localization",
    "blend": "cspace.trajectory",
    "cartesian": "",
    "collision": "",
    "configuration_space": "cspace.planning",
    "dynamics": "",
    "export": "",
    "ik": "",
    "kinematics": "",
    "load_robot": "cspace.robots",
    "localization": "",
    "localize": "cspace.localization",
    "maps": "",
    "match_scan": "cspace.localization",
    "mechanisms": "",
    "mobile": "",
    "model": "",
    "move": "cspace.plan_motion",
    "navigate": "cspace.navigation",
    "navigation": "",
    "plan": "cspace.plan_motion",
    "plan_many": "cspace.plan_motion",
    "planning": "",
    "plot": "",
    "read_log": "cspace.localization",
    "robots": "",
    "rpe": "cspace.localization",
    "shapes": "",
    "slam": "cspace.localization",
    "spatial": "",
    "spline": "cspace.trajectory",
    "subproblems": "cspace.ik",
    "time_parametrize": "cspace.trajectory",
    "tolerances": "",
    "trajectory": "",
}


def __getattr__(name: str) -> Any:
    from cspace.late_imports import import_room  # which `import cspace` does not need

    if name in _LATER:
        room = _LATER[name]
        value = getattr(import_room(room), name) if room else import_room(f"cspace.{name}")
    elif name == "__all__":
        value = [*_OWN, *import_room("cspace.spatial").__all__]
    elif not name.startswith("_") and name in (spatial := import_room("cspace.spatial")).__all__:
        value = getattr(spatial, name)
    else:
        from cspace.errors import FOREIGN_NAMES

        # With name and obj Python itself adds the nearest name to the message that a person sees.
        ours = FOREIGN_NAMES.get(name)
        text = f"module 'cspace' has no attribute {name!r}" + (f": use {ours}" if ours else "")
        raise AttributeError(text, name=name, obj=sys.modules[__name__])
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    listed = {*__getattr__("__all__"), "__all__", "errors", "tolerances"}
    return sorted(listed | {name for name in globals() if name.startswith("__")})
