"""Collision: scenes of obstacles, and the collision geometry of robots."""

from cspace.collision.pack_scene import PackedScene, pack_scene
from cspace.collision.scene import Attachment, Scene

__all__ = ["Attachment", "PackedScene", "Scene", "pack_scene"]
