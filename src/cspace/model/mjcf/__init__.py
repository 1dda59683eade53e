"""Robots from MJCF, the format of MuJoCo."""

from cspace.model.mjcf.reader import from_mjcf, mjcf_description

__all__ = ["from_mjcf", "mjcf_description"]
