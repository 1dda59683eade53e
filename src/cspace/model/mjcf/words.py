"""The elements and attributes of MJCF that say how a robot is made, to tell slips of the pen."""

from __future__ import annotations

from typing import Final

from cspace.model.attributes import fault_at, slip_in
from cspace.model.xml import Element


def list_words(text: str) -> frozenset[str]:
    return frozenset(text.split())


TURNS: Final = "quat axisangle euler xyaxes zaxis"
INSIDE: Final = list_words(
    "body frame joint freejoint geom site inertial camera light plugin replicate attach composite flexcomp"
)
CHILDREN: Final[dict[str, frozenset[str]]] = {
    "mujoco": list_words(
        "compiler option size statistic visual default extension asset worldbody deformable contact tendon"
        " equality actuator sensor custom keyframe"
    ),
    "worldbody": INSIDE,
    "body": INSIDE,
    "frame": INSIDE,
    "equality": list_words("connect weld joint tendon flex flexvert flexstrain distance"),
    "keyframe": list_words("key"),
    "contact": list_words("pair exclude"),
}
"""What may stand in the elements that are read."""

ELEMENTS: Final = frozenset().union(*CHILDREN.values())
"""All of them."""

SOLIDS: Final = "class name type group size material mesh fromto pos user rgba " + TURNS
ATTRIBUTES: Final[dict[str, frozenset[str]]] = {
    "compiler": list_words(
        "alignfree angle assetdir autolimits balanceinertia boundinertia boundmass conflict convexhull"
        " coordinate discardvisual eulerseq exactmeshinertia fitaabb fusestatic inertiafromgeom"
        " inertiagrouprange meshdir passthrough savecanonical savecompiled saveinertial settotalmass"
        " strippath texturedir usethread"
    ),
    "body": list_words("childclass fuse gravcomp mocap name pos simple sleep user " + TURNS),
    "frame": list_words("childclass name pos " + TURNS),
    "inertial": list_words("mass pos diaginertia fullinertia " + TURNS),
    "joint": list_words(
        "actuatorfrclimited actuatorfrcrange actuatorgravcomp armature axis class damping frictionloss group"
        " limited margin name pos range ref solimpfriction solimplimit solreffriction solreflimit"
        " springdamper springref springyield stiffness type user"
    ),
    "freejoint": list_words("align group name"),
    "geom": list_words(
        "adhesion castshadow conaffinity condim contype density fitscale fluidcoef fluidshape friction gap"
        " hfield margin mass priority shellinertia solimp solmix solref surfacevel " + SOLIDS
    ),
    "site": list_words(SOLIDS),
}
"""The attributes of those elements."""

READ: Final = ("mujoco", "worldbody", "body", "frame")
"""Elements in which attributes are looked at."""


def check_words(root: Element) -> None:
    """Complain about what looks like a slip of the pen: an element left out in silence is worse.

    A word that is not known here is of a newer MuJoCo, unless it is close to a known one that is not there.
    """
    stack = [root]
    while stack:
        element = stack.pop()
        known = CHILDREN.get(element.tag, frozenset())
        for child in element.children:
            if known and child.tag in ELEMENTS - known:
                raise fault_at(child, f"<{element.tag}> has no <{child.tag}>; it stands elsewhere in MJCF")
        read = element.tag in READ
        if slip := slip_in(element, known, known, ATTRIBUTES if read else {}):
            raise fault_at(slip[1], slip[0])
        stack += [child for child in element.children if read and child.tag in CHILDREN]
