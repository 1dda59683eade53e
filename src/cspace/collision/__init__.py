"""Collision: scenes of obstacles, the collision geometry of robots, and checks of one in the other."""

from cspace.collision.checks import Clearance, Edge, clearance, collides, contact, edge
from cspace.collision.escape import Escape, escape
from cspace.collision.mesh_judge import MeshJudge, MeshVerdict
from cspace.collision.pack_scene import PackedScene, pack_scene
from cspace.collision.robot_geometry import RobotGeometry, robot_geometry
from cspace.collision.scene import Attachment, Scene
from cspace.collision.sphere_files import replace_spheres

__all__ = [
    "Attachment",
    "Clearance",
    "Edge",
    "Escape",
    "MeshJudge",
    "MeshVerdict",
    "PackedScene",
    "RobotGeometry",
    "Scene",
    "clearance",
    "collides",
    "contact",
    "edge",
    "escape",
    "pack_scene",
    "replace_spheres",
    "robot_geometry",
]
