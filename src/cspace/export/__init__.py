"""An arm as source code: every inverse-kinematics solution without cspace, in a file of its own."""

from cspace.export.languages import LANGUAGES, Export, export

__all__ = ["LANGUAGES", "Export", "export"]
