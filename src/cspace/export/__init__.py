"""Export of the inverse kinematics of an arm as source code that does not depend on cspace."""

from cspace.export.languages import LANGUAGES, Export, export

__all__ = ["LANGUAGES", "Export", "export"]
