"""A serial chain from base to tip, as screws at zero: the product of exponentials."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.model.description import Description
from cspace.model.elementary import (
    Coordinates,
    Elementary,
    coordinates_of,
    elementary_joints,
    leading_joint,
)
from cspace.model.joint import LIMIT_FIELDS, Joint, Limits
from cspace.model.screws import twists
from cspace.model.values import finite_number, freeze_array
from cspace.spatial import exp_se3
from cspace.spatial.poses import invert_pose
from cspace.tables import one_line, tabulate


@tabulate()
@dataclass(frozen=True, eq=False)
class Chain:
    """The joints between two links, as screws in the base frame at zero.

    T_base_tip(q) = exp(ξ₁ q₁) … exp(ξₙ qₙ) · T_zero, where ξ turns about (or slides along) axes[i] through
    points[i] (Murray, Li, Sastry 1994, section 3.2).

    joint_names, joint_types: n names and a string of "R" and "P". axes (n, 3): unit directions; points (n, 3)
    [m]. T_zero (4, 4): tip in base with every joint at zero. coordinates: the independent q behind the joints
    (fewer than n where joints mimic). frames: each link carried rigidly along the chain, name →
    (number of joints before it, its pose in base at zero).
    """

    name: str
    base: str
    tip: str
    joint_names: tuple[str, ...]
    joint_types: str
    axes: Array
    points: Array
    T_zero: Array
    coordinates: Coordinates
    frames: Mapping[str, tuple[int, Array]]

    def __repr__(self) -> str:
        return one_line("Chain", f"{self.name}: {self.joint_types}, {self.base} → {self.tip}")

    @property
    def dof(self) -> int:
        """The number of independent coordinates."""
        return len(self.coordinates.names)

    @property
    def limits(self) -> Limits:
        """The limits of the coordinates."""
        return self.coordinates.limits

    def with_limits(self, limits: Limits) -> Chain:
        """The chain with other limits of its coordinates. Raises InputError for another number of them."""
        if len(limits) != self.dof:
            raise InputError(f"limits are for {len(limits)} joints, {self.name} has {self.dof}")
        return replace(self, coordinates=replace(self.coordinates, limits=limits))

    def lock(self, values: Mapping[int, float]) -> Chain:
        """The chain of the other joints, with these joints (by number) at fixed values [rad or m].

        Raises InputError for a chain with mimic joints.
        """
        T, axes, points = np.eye(4), self.axes.copy(), self.points.copy()
        for k, (h, p) in enumerate(zip(self.axes, self.points, strict=True)):
            axes[k], points[k] = T[:3, :3] @ h, T[:3, :3] @ p + T[:3, 3]
            if k in values:
                T = T @ exp_se3(values[k] * twists(h[None], p[None], self.joint_types[k])[0])
        moving = [k for k in range(len(axes)) if k not in values]
        names, kinds = self.joint_names, self.joint_types
        return self._changed(
            tuple(names[k] for k in moving),
            "".join(kinds[k] for k in moving),
            axes[moving],
            points[moving],
            T @ self.T_zero,
            [row[moving] for row in self._limit_rows],
        )

    def prepend(
        self, name: str, joint_type: str, axis: Array, lower: float = -np.inf, upper: float = np.inf
    ) -> Chain:
        """The chain with one more joint before its base, about or along axis (3,) through the base's origin.

        joint_type: "R" or "P". Raises InputError for a chain with mimic joints.
        """
        return self._changed(
            (name, *self.joint_names),
            joint_type + self.joint_types,
            np.vstack([axis, self.axes]),
            np.vstack([np.zeros(3), self.points]),
            self.T_zero,
            [np.append(e, row) for e, row in zip(_ends(lower, upper), self._limit_rows, strict=True)],
        )

    def append(
        self, name: str, joint_type: str, axis: Array, lower: float = -np.inf, upper: float = np.inf
    ) -> Chain:
        """The chain with one more joint behind its tip, about or along axis (3,), in the tip, through its
        origin; the tip frame moves with it.

        joint_type: "R" or "P". Raises InputError for a chain with mimic joints.
        """
        T = self.T_zero
        return self._changed(
            (*self.joint_names, name),
            self.joint_types + joint_type,
            np.vstack([self.axes, T[:3, :3] @ axis]),
            np.vstack([self.points, T[:3, 3]]),
            T,
            [np.append(row, e) for e, row in zip(_ends(lower, upper), self._limit_rows, strict=True)],
        )

    def turn_tip(self, R: Array) -> Chain:
        """The chain with its tip turned by R (3, 3), seen in the tip."""
        T = self.T_zero.copy()
        T[:3, :3] = T[:3, :3] @ R
        return replace(self, T_zero=T, frames={**self.frames, self.tip: (len(self.axes), T)})

    def reversed(self) -> Chain:
        """The chain from tip to base: its joints in the opposite order, its pose the inverse.

        Raises InputError for a chain with mimic joints.
        """
        T, order = invert_pose(self.T_zero), slice(None, None, -1)
        turned = self._changed(
            self.joint_names[order],
            self.joint_types[order],
            -self.axes[order] @ T[:3, :3].T,
            self.points[order] @ T[:3, :3].T + T[:3, 3],
            T,
            [row[order] for row in self._limit_rows],
        )
        frames = {self.tip: (0, np.eye(4)), self.base: (len(self.axes), T)}
        return replace(turned, base=self.tip, tip=self.base, frames=frames)

    def __post_init__(self) -> None:
        """Make the arrays and the mapping read-only."""
        for array in (self.axes, self.points, self.T_zero, *(pose for _, pose in self.frames.values())):
            freeze_array(array)
        object.__setattr__(self, "frames", MappingProxyType(dict(self.frames)))

    def __reduce__(self) -> tuple[Any, ...]:
        """Read-only mappings cannot be pickled; what they were made from can."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return type(self), tuple((values | {"frames": dict(self.frames)}).values())

    @property
    def _limit_rows(self) -> list[Array]:
        return [getattr(self.limits, field) for field in LIMIT_FIELDS]

    def _changed(
        self,
        names: tuple[str, ...],
        kinds: str,
        axes: Array,
        points: Array,
        T_zero: Array,
        limits: list[Array],
    ) -> Chain:
        """A chain of other joints between the same links, each with a coordinate of its own."""
        if self.dof != len(self.joint_names):
            raise InputError(f"chain {self.name!r} has mimic joints; only a chain without them can change")
        n = len(names)
        rows = np.arange(n, dtype=np.intp), np.ones(n), np.zeros(n)
        return Chain(
            name=self.name,
            base=self.base,
            tip=self.tip,
            joint_names=names,
            joint_types=kinds,
            axes=np.ascontiguousarray(axes),
            points=np.ascontiguousarray(points),
            T_zero=np.ascontiguousarray(T_zero),
            coordinates=Coordinates(names, *rows, Limits(*limits)),
            frames={self.base: (0, np.eye(4)), self.tip: (n, T_zero)},
        )


def _ends(lower: float, upper: float) -> list[float]:
    """The limits of one joint in the order of LIMIT_FIELDS."""
    return [lower, upper] + [np.inf] * (len(LIMIT_FIELDS) - 2)


def zero_poses(
    description: Description, base: str | None = None, locked: Mapping[str, float] | None = None
) -> dict[str, Array]:
    """The pose (4, 4) of every link in the link `base` (default: the root) with all joints at zero.

    locked: joint name → value [rad or m] of joints that are not at zero.
    """
    poses = {description.root: np.eye(4)}
    for link in description.ordered_links[1:]:
        joint = description.parent_joint[link]
        poses[link] = poses[joint.parent] @ joint.origin
        if locked and locked.get(joint.name):
            poses[link] = poses[link] @ joint_motion(joint, locked[joint.name])
    if base is not None and base != description.root:
        T_base_root = invert_pose(poses[description.link(base).name])
        poses = {link: T_base_root @ pose for link, pose in poses.items()}
    return poses


def joint_motion(joint: Joint, value: float) -> Array:
    """The pose (4, 4) of a joint's child at a value [rad or m] in its child at zero."""
    (step,) = elementary_joints(joint)
    return exp_se3(value * twists(step.axis[None], np.zeros((1, 3)), step.kind)[0])


def rigid_group(description: Description, link: str, locked: Container[str] = ()) -> tuple[str, ...]:
    """The links tied to `link` by fixed joints, and by those whose names are in `locked`, itself first."""

    def is_rigid(joint: Joint) -> bool:
        return not joint.moving or joint.name in locked

    group = {link: None}
    open_links = [link]
    for here in open_links:
        near = [joint.child for joint in description.child_joints[here] if is_rigid(joint)]
        carrier = description.parent_joint.get(here)
        if carrier is not None and is_rigid(carrier):
            near.append(carrier.parent)
        open_links += [other for other in near if other not in group]
        group.update(dict.fromkeys(near))
    return tuple(group)


def locked_values(
    description: Description, path: Sequence[Joint], values: Mapping[str, float] | None = None
) -> dict[str, float]:
    """The moving joints that are not on the path, name → value [rad or m], zero unless given.

    A joint that mimics another follows it; one that follows a joint of the path stays where that is zero.
    Floating joints are left out. Raises UnknownNameError for a joint that does not exist, InputError for
    one that is on the path, fixed, floating, planar or mimics another, and for a value that is not finite.
    """
    on_path = {joint.name for joint in path}
    given = {name: finite_number(v, f"locked joint {name!r}") for name, v in dict(values or {}).items()}
    for name in given:
        joint = description.joint(name)
        if name in on_path:
            raise InputError(
                f"joint {name!r} moves the tip of {description.name!r}, so it cannot be locked here;"
                " lock it in calls, such as robot.ik(T, locked=…)"
            )
        if joint.mimic is not None:
            raise InputError(f"joint {name!r} mimics {joint.mimic.joint!r}; lock that one")
        if joint.type not in ("revolute", "continuous", "prismatic"):
            raise InputError(
                f"joint {name!r} is {joint.type}; only revolute and prismatic ones can be locked"
            )
    off = [
        joint for joint in description.moving_joints if joint.name not in on_path and joint.type != "floating"
    ]
    found = {}
    for joint in off:
        leader, factor, shift = leading_joint(joint, description.joint_by_name)
        found[joint.name] = factor * given.get(leader.name, 0.0) + shift
    return found


def default_tip(description: Description, base: str | None = None) -> str:
    """The end of the only chain of moving joints that `base` (default: the root) carries.

    Fixed side frames do not count as branches. Behind the last moving joint the tip is the only leaf; where
    there are several, it is "tool0" (the flange frame of ROS-Industrial) or the only leaf attached to tool0.
    Raises InputError naming the leaves where there is a choice.
    """
    here = description.root if base is None else description.link(base).name
    while True:
        carried = _carried(description, here)
        onward = [joint for link in carried for joint in description.child_joints[link] if joint.moving]
        if len(onward) != 1:
            break
        here = onward[0].child
    choice = [link for link in carried if not description.child_joints[link]]
    if onward:
        choice = [link for link in description.leaves if link not in carried]
    else:
        if len(choice) > 1 and "tool0" in carried:
            on_flange = _carried(description, "tool0")
            choice = [link for link in choice if link in on_flange]
        if len(choice) == 1:
            return choice[0]
    shown = ", ".join(repr(leaf) for leaf in choice[:12])
    more = f" and {len(choice) - 12} more" if len(choice) > 12 else ""
    raise InputError(
        f"robot {description.name!r} branches after link {here!r};"
        f" select the link that is the tip (tip=…): {shown}{more}"
    )


def _carried(description: Description, link: str) -> list[str]:
    """`link` and the links that fixed joints alone attach to it, from it outward."""
    group = [link]
    for here in group:
        group.extend(joint.child for joint in description.child_joints[here] if not joint.moving)
    return group


def find_path(description: Description, base: str, tip: str) -> list[tuple[Joint, bool]]:
    """The joints from link `base` to link `tip` in order, each with whether it is passed backward."""
    ancestors = {link: i for i, link in enumerate(_ancestors(description, base))}
    down: list[Joint] = []
    here = tip
    while here not in ancestors:
        joint = description.parent_joint[here]
        down.append(joint)
        here = joint.parent
    climbed = list(ancestors)[: ancestors[here]]
    return [(description.parent_joint[link], True) for link in climbed] + [(j, False) for j in reversed(down)]


def _ancestors(description: Description, link: str) -> list[str]:
    """`link`, its parent, its parent's parent … up to the root."""
    line = [link]
    while line[-1] in description.parent_joint:
        line.append(description.parent_joint[line[-1]].parent)
    return line


def chain(
    description: Description,
    base: str | None = None,
    tip: str | None = None,
    *,
    locked: Mapping[str, float] | None = None,
) -> Chain:
    """The chain from `base` to `tip`, any two links of the tree.

    base: a link, default the root. tip: a link, default as in default_tip. Joints passed from child to parent
    act the other way round: their axes are negated. Joints off the chain are locked, and what they carry is
    kept as frames. locked: joint name → value [rad or m] of such joints, zero unless given.
    Raises UnknownNameError for unknown links and joints, InputError where the tip is a choice and for a
    locked joint that the chain moves, DescriptionError where a floating joint lies between.
    """
    base = description.root if base is None else description.link(base).name
    tip = default_tip(description, base) if tip is None else description.link(tip).name
    path = find_path(description, base, tip)
    fixed_at = locked_values(description, [joint for joint, _ in path], locked)
    poses = zero_poses(description, base, fixed_at)
    parts: list[Elementary] = []
    axes: list[Array] = []
    points: list[Array] = []
    frames = {link: (0, poses[link]) for link in rigid_group(description, base, fixed_at)}
    for joint, backward in path:
        steps = elementary_joints(joint)
        frame = poses[joint.child]  # at zero the joint frame is the child frame
        for step in reversed(steps) if backward else steps:
            parts.append(step)
            axes.append(frame[:3, :3] @ (-step.axis if backward else step.axis))
            points.append(frame[:3, 3])
        for link in (
            rigid_group(description, joint.parent if backward else joint.child, fixed_at) if steps else ()
        ):
            frames[link] = (len(parts), poses[link])
    n = len(parts)
    return Chain(
        name=description.name,
        base=base,
        tip=tip,
        joint_names=tuple(part.name for part in parts),
        joint_types="".join(part.kind for part in parts),
        axes=np.array(axes).reshape(n, 3),
        points=np.array(points).reshape(n, 3),
        T_zero=frames[tip][1],
        coordinates=coordinates_of(tuple(parts), description.joint_by_name),
        frames=frames,
    )
