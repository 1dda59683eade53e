"""From a description to the arrays of the compiled robot: moving joints alone, their axes turned to z."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.model import Chain, Description, Limits, Tree, chain, default_tip, tree
from cspace.model.joint import RESISTANCES
from cspace.model.tree import lump_links
from cspace.spatial.poses import invert_pose
from cspace.spatial.vectors import frame_along
from cspace.tables import show_fields

Numbers = npt.NDArray[np.intp]


@show_fields
@dataclass
class Assembly:
    """The numbers of a robot, every fixed link folded into the joint that carries it.

    Joint k sits at T_parent_joint[k] (n_joints, 4, 4) on joint parent[k] (-1: the base), turns about or
    slides along its z, and stands at ratio[k] · q[coordinate[k]] + offset[k]. Frame f sits at
    T_joint_frame[f] (n_frames, 4, 4) on joint frame_joint[f]. mass (n_joints + 1,) [kg], center
    (n_joints + 1, 3) [m] and inertia (n_joints + 1, 3, 3) [kg·m²], about the centre, are those of the base
    and of all that is fixed to each joint. armature, damping and friction (n_joints,) are those of the joints
    themselves, zero where the description gives none.

    coordinates: the names behind q, coordinate_types their "R" or "P", limits theirs. frame_index: name →
    number. base, tip (None: the robot branches), leaves: links. floating: the base moves freely. chain: the
    path to the tip.
    """

    base: str
    tip: str | None
    leaves: tuple[str, ...]
    floating: bool
    coordinates: tuple[str, ...]
    coordinate_types: str
    limits: Limits
    T_parent_joint: Array
    parent: Numbers
    coordinate: Numbers
    ratio: Array
    offset: Array
    prismatic: Array
    T_joint_frame: Array
    frame_joint: Numbers
    frame_index: dict[str, int]
    mass: Array
    center: Array
    inertia: Array
    armature: Array
    damping: Array
    friction: Array
    chain: Chain | None

    @property
    def n_joints(self) -> int:
        """How many joints move, mimicking ones included."""
        return len(self.T_parent_joint)

    @property
    def n_frames(self) -> int:
        """How many frames have a name."""
        return len(self.T_joint_frame)

    @property
    def n_coordinates(self) -> int:
        """How many numbers a configuration has."""
        return len(self.coordinates)

    @property
    def tip_index(self) -> int:
        """The number of the tip among the frames, -1 where the tree leaves the choice."""
        return -1 if self.tip is None else self.frame_index[self.tip]


def assemble(
    description: Description,
    base: str | None = None,
    tip: str | None = None,
    *,
    floating: bool | None = None,
    locked: Mapping[str, float] | None = None,
) -> Assembly:
    """The chain from `base` to `tip`, or, where the robot branches and nothing is chosen, the whole tree.

    base: a link, the root if None (below a floating joint that carries everything). tip: a link; if None,
    the end of the only chain there is. Joints off the chain are locked, and the links that they carry keep
    their masses, as frames of the chain. floating: the base moves freely; None: if the description says so.
    locked: joint name → value [rad or m] of joints off the chain, zero unless given. Raises UnknownNameError
    for a link or joint that is not there, InputError for a base below which the robot branches, and for
    locked joints of a tree or of the chain.
    """
    loose = any(joint.type == "floating" for joint in description.joints)
    start = tree(description).root if base is None and loose else base
    free = loose and base is None if floating is None else floating
    end = tip
    if end is None:
        try:
            end = default_tip(description, start)
        except InputError:
            if base is not None:
                raise
            if locked:
                raise InputError(
                    f"every joint of {description.name!r} moves, since it branches and no tip= is chosen;"
                    " locked= is for joints off the chain to a tip"
                ) from None
            return _from_tree(tree(description), description, free)
    return _from_chain(chain(description, start, end, locked=locked), description, free)


def assemble_chain(source: Chain) -> Assembly:
    """The assembly of a chain alone, whose links have no mass."""
    return _from_chain(source, None, False)


def _from_tree(source: Tree, description: Description, floating: bool) -> Assembly:
    turned = _turned(source.axes)
    carriers = source.parent
    # From a joint turned to z back to the joint as given; the base first.
    back = np.array([np.eye(4), *np.swapaxes(turned, -1, -2)])
    turns = back[:, :3, :3]
    return Assembly(
        base=source.root,
        tip=None,
        leaves=description.leaves,
        floating=floating,
        T_parent_joint=back[carriers + 1] @ source.placement @ turned,
        parent=carriers,
        mass=np.array(source.mass),
        center=np.einsum("kij,kj->ki", turns, source.com),
        inertia=turns @ source.inertia @ np.swapaxes(turns, -1, -2),
        chain=None,
        **_shared(source, description, back, -1),
    )


def _from_chain(source: Chain, description: Description | None, floating: bool) -> Assembly:
    n = len(source.axes)
    T_base_joint = np.array([np.eye(4), *_turned(source.axes)])
    T_base_joint[1:, :3, 3] = source.points
    back = invert_pose(T_base_joint)
    shared = _shared(source, description, back, 0)
    mass, center, inertia = np.zeros(n + 1), np.zeros((n + 1, 3)), np.zeros((n + 1, 3, 3))
    if description is not None:
        carried = zip(shared["frame_joint"].tolist(), shared["T_joint_frame"], strict=True)
        mass, center, inertia, _ = lump_links(description, dict(zip(source.frames, carried, strict=True)), n)
    return Assembly(
        base=source.base,
        tip=source.tip,
        leaves=(source.tip,),
        floating=floating,
        T_parent_joint=back[:-1] @ T_base_joint[1:],
        parent=np.arange(-1, n - 1),
        mass=mass,
        center=center.copy(),
        inertia=inertia.copy(),
        chain=source,
        **shared,
    )


def _shared(source: Tree | Chain, description: Description | None, back: Array, base: int) -> dict[str, Any]:
    """What trees and chains have in common: coordinates and frames.

    back (n + 1, 4, 4): where the frames of the base and of each joint, as given, stand in those turned to z.
    base: the number of the base among what carries frames.
    """
    law = source.coordinates
    kinds = dict(zip(source.joint_names, source.joint_types, strict=True))
    for name in law.names:  # a joint may follow one that is not in the chain
        if name not in kinds and description is not None:
            kinds[name] = "P" if description.joint(name).type == "prismatic" else "R"
    carrier = np.array([number - base for number, _ in source.frames.values()])
    return {
        "T_joint_frame": back[carrier] @ np.array([pose for _, pose in source.frames.values()]),
        "frame_joint": carrier - 1,
        "frame_index": {name: i for i, name in enumerate(source.frames)},
        "coordinates": law.names,
        "coordinate_types": "".join(kinds[name] for name in law.names),
        "limits": law.limits,
        "coordinate": law.index,
        "ratio": law.multiplier,
        "offset": law.offset,
        "prismatic": np.array([kind == "P" for kind in source.joint_types], dtype=np.float64),
        **_resistances(source.joint_names, description),
    }


def _resistances(names: tuple[str, ...], description: Description | None) -> dict[str, Array]:
    """What the joints themselves oppose to motion, (n,) each: armature, damping, friction."""
    rows = dict.fromkeys(RESISTANCES, np.zeros(len(names)))
    if description is None:
        return rows
    known = description.joint_by_name  # the parts of a planar joint are name/x, name/y and name/turn
    joints = [known.get(name) or known[name.rpartition("/")[0]] for name in names]
    return {field: np.array([getattr(joint, field) or 0.0 for joint in joints]) for field in rows}


def _turned(axes: Array) -> Array:
    """Rotations (n, 4, 4) whose third columns are the unit axes (n, 3)."""
    result = np.tile(np.eye(4), (len(axes), 1, 1))
    for T, axis in zip(result, axes, strict=True):
        T[:3, :3] = frame_along(axis)
    return result


def mount(assembly: Assembly, name: str, T_world_base: Array) -> None:
    """Put the base at a place in the world, T_world_base (4, 4): all that the base carries moves there.

    Raises InputError for a floating base.
    """
    if assembly.floating:
        raise InputError(
            f"the base of {name} is floating; give T_world_base= in each call instead of with_base"
        )
    on_base = assembly.parent < 0
    assembly.T_parent_joint[on_base] = T_world_base @ assembly.T_parent_joint[on_base]
    fixed = assembly.frame_joint < 0
    assembly.T_joint_frame[fixed] = T_world_base @ assembly.T_joint_frame[fixed]
    R, p = T_world_base[:3, :3], T_world_base[:3, 3]
    assembly.center[0] = R @ assembly.center[0] + p
    assembly.inertia[0] = R @ assembly.inertia[0] @ R.T
    if assembly.chain is not None:
        old = assembly.chain
        assembly.chain = replace(
            old,
            axes=old.axes @ R.T,
            points=old.points @ R.T + p,
            T_zero=T_world_base @ old.T_zero,
            frames={link: (before, T_world_base @ T) for link, (before, T) in old.frames.items()},
        )


def add_tool(assembly: Assembly, name: str, T_tip_tool: Array) -> None:
    """Put a tool on the tip at T_tip_tool (4, 4); it becomes the tip, "tool" ("tool_" if that is taken).

    Raises InputError for a tree without tip.
    """
    if assembly.tip is None or assembly.chain is None:
        raise InputError(
            f"{name} branches, so there is no unique tip for a tool; choose a tip=: "
            f"{tip_choices(assembly.leaves)}"
        )
    tool = "tool"
    while tool in assembly.frame_index:
        tool += "_"
    f = assembly.tip_index
    carrier, T_joint_tool = int(assembly.frame_joint[f]), assembly.T_joint_frame[f] @ T_tip_tool
    assembly.frame_index[tool] = assembly.n_frames
    assembly.T_joint_frame = np.concatenate([assembly.T_joint_frame, T_joint_tool[None]])
    assembly.frame_joint = np.append(assembly.frame_joint, carrier)
    assembly.tip = tool
    old, T_zero = assembly.chain, assembly.chain.T_zero @ T_tip_tool
    frames = {**old.frames, tool: (carrier + 1, T_zero)}
    assembly.chain = replace(old, tip=tool, T_zero=T_zero, frames=frames)


def screws(assembly: Assembly, name: str) -> Chain:
    """The path from base to tip as screws at zero, tool and mounting included.

    Raises InputError for a tree without tip.
    """
    if assembly.chain is None:
        raise InputError(f"{name} branches; a chain needs a tip=: {tip_choices(assembly.leaves)}")
    return assembly.chain


def tip_choices(leaves: tuple[str, ...]) -> str:
    """The possible tips of a branching robot, as text."""
    return f"{', '.join(leaves)}, or any other link, such as the one that carries a gripper"
