"""cspace: from a robot's description to its motion."""

import logging
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

from cspace import spatial
from cspace._core import __version__
from cspace.errors import CspaceError
from cspace.spatial import *  # noqa: F403

if TYPE_CHECKING:
    from cspace import ik, kinematics, model, plot, robots
    from cspace.ik import subproblems
    from cspace.robot import Robot
    from cspace.robots import load_robot

logging.getLogger("cspace").addHandler(logging.NullHandler())

__all__ = ["CspaceError", "Robot", "__version__", "ik", "kinematics", "load_robot", "model", "plot"]
__all__ += ["robots", "spatial", "subproblems"]
__all__ += spatial.__all__

# Where the names are that are imported when they are first used: their rooms take time to load.
_LATER = {
    "Robot": "cspace.robot",
    "ik": "",
    "kinematics": "",
    "load_robot": "cspace.robots",
    "model": "",
    "plot": "",
    "robots": "",
    "subproblems": "cspace.ik",
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        # With name and obj Python itself adds the nearest name to the message that a person sees.
        raise AttributeError(
            f"module 'cspace' has no attribute {name!r}", name=name, obj=sys.modules[__name__]
        )
    room = _LATER[name]
    value = getattr(import_module(room), name) if room else import_module(f"cspace.{name}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, "errors", "tolerances", *(name for name in globals() if name.startswith("__"))})
