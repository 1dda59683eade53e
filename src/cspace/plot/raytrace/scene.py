"""A 3-D axes' solids and floor, drawn pixel by pixel as one image.

Each group of solids (a robot, a ghost, a frame) is an image of its own with a depth per pixel; the groups are
laid over each other by depth, ghosts with the transparency of the whole silhouette and a rim. The image is
made anew whenever the axes are drawn, so it follows the view and the resolution.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np

from cspace.plot.raytrace.canvas import Canvas, Floor
from cspace.plot.raytrace.layer import see_solids
from cspace.plot.raytrace.shadow import shadow_of
from cspace.plot.raytrace.solids import Body
from cspace.plot.raytrace.view import View


@dataclass
class Group:
    """Solids that belong together. opacity: below 1 for a ghost. shadow: whether they cast one.

    backdrop: of opaque solids, whether no ghost coincides with them, so that ghosts before them are as strong
    as over nothing.
    """

    solids: Sequence[Body]
    opacity: float = 1.0
    shadow: bool = True
    backdrop: bool = False


@dataclass
class Scene:
    """All solids of one 3-D axes, and its floor."""

    floor: Floor | None = None
    groups: list[Group] = field(default_factory=list)

    def image(self, axes: Any, magnification: float) -> Any:
        """The image (h, w, 4) of bytes of the whole figure, bottom row first."""
        view = View(axes, magnification)
        canvas = Canvas(view)
        if self.floor is not None:
            cast = [solid for group in self.groups if group.shadow for solid in group.solids]
            canvas.lay_floor(view, self.floor, shadow_of(cast, float(self.floor.center[2]), view.size))
        opaque = [group for group in self.groups if group.opacity >= 1.0]
        front = see_solids(view, [solid for group in opaque for solid in group.solids])
        faint = [group for group in self.groups if group.opacity < 1.0]
        seen = [(see_solids(view, group.solids), group.opacity) for group in faint]
        ghosts = [(layer, opacity) for layer, opacity in seen if layer is not None]
        ghosts.sort(key=lambda ghost: -float(ghost[0].depth.mean()))
        for layer, opacity in ghosts:
            canvas.lay_ghost(layer, opacity, before=None)
        if front is not None:
            canvas.over(front.color, front.coverage, front.pixels)
            alike = np.array([not group.backdrop for group in opaque for _ in group.solids])[front.owner]
            for layer, opacity in ghosts:
                canvas.lay_ghost(layer, opacity, front, alike)
        return canvas.finished()


@cache
def artist_type() -> type[Any]:
    """The matplotlib artist that draws a Scene; the class is made when matplotlib is first needed."""
    from matplotlib.artist import Artist

    class Solids(Artist):
        """The solids of a 3-D axes; `scene` contains them."""

        def __init__(self, scene: Scene) -> None:
            super().__init__()
            self.scene = scene
            self.set_zorder(5)

        def draw(self, renderer: Any) -> None:
            """Make the image for the present view and resolution and hand it to the renderer."""
            if self.get_visible():
                gc = renderer.new_gc()
                image = self.scene.image(self.axes, renderer.get_image_magnification())
                renderer.draw_image(gc, 0, 0, image)
                gc.restore()

    return Solids


def scene_of(axes: Any, floor: Floor | None = None) -> Any:
    """The artist of an axes that draws its solids, made on first use; all pictures drawn there share it."""
    for artist in axes.get_children():
        if isinstance(artist, artist_type()):
            return artist
    artist = artist_type()(Scene(floor))
    axes.add_artist(artist)
    return artist


def draw_groups(ax: Any, groups: list[Group]) -> list[Any]:
    """Add groups of solids to the picture of the axes."""
    artist = scene_of(ax)
    artist.scene.groups += groups
    return [artist]
