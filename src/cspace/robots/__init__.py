"""Robots by name or from a file: the catalogue and the loader."""

from cspace.robots.loading import load_description, load_robot
from cspace.robots.lookup import CatalogueRow, catalogue_description, find, names, rows, search

__all__ = [
    "CatalogueRow",
    "catalogue_description",
    "find",
    "load_description",
    "load_robot",
    "names",
    "rows",
    "search",
]
