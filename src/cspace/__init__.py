"""cspace: from a robot's description to its motion."""

import logging

from cspace._core import __version__
from cspace.errors import CspaceError

logging.getLogger("cspace").addHandler(logging.NullHandler())

__all__ = ["CspaceError", "__version__"]
