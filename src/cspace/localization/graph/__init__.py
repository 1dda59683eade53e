"""Pose graphs: poses and landmarks, and the measurements between them."""

from cspace.localization.graph.answer import Certificate, GraphAnswer, RejectedLoop
from cspace.localization.graph.incremental import IncrementalGraph
from cspace.localization.graph.pose_graph import PoseGraph

__all__ = ["Certificate", "GraphAnswer", "IncrementalGraph", "PoseGraph", "RejectedLoop"]
