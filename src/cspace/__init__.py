"""cspace: from a robot's description to its motion."""

import logging

from cspace import spatial
from cspace._core import __version__
from cspace.errors import CspaceError
from cspace.spatial import *  # noqa: F403

logging.getLogger("cspace").addHandler(logging.NullHandler())

__all__ = ["CspaceError", "__version__", "spatial"]
__all__ += spatial.__all__
