"""The robots of example-robot-data, and Pinocchio models moved by our coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cspace.model import chain, tree
from cspace.robot import Robot

FAULTY = {
    "alex_psyonic_hands": "joint 'Left_index_q2' mimics: no joint 'index_q1'",
    "ur3": "robot 'ur3' has no links",
}
"""Files that are refused, and why."""


def urdf_files() -> dict[str, Path]:
    """The URDF files of the package by name; the folder goes in front where a name comes twice."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return {}
    paths = [Path(str(file.locate())) for file in files if str(file).endswith(".urdf")]
    names = [path.stem for path in paths]
    return {p.stem if names.count(p.stem) == 1 else f"{p.parents[1].name}/{p.stem}": p for p in paths}


def place_joints(
    pin: Any, model: Any, values: Mapping[str, float], T_world_base: np.ndarray | None = None
) -> np.ndarray:
    """Pinocchio's q of a model: joints by name [rad or m], the others as they are; the place of its base."""
    from scipy.spatial.transform import Rotation

    result = pin.neutral(model)
    if T_world_base is not None and "root_joint" in list(model.names):
        result[:3] = T_world_base[:3, 3]
        result[3:7] = Rotation.from_matrix(T_world_base[:3, :3]).as_quat()
    for name, joint in zip(model.names, model.joints, strict=True):
        if name in values:
            value = values[name]
            result[joint.idx_q : joint.idx_q + joint.nq] = (
                [np.cos(value), np.sin(value)] if joint.nq == 2 else [value]
            )
    return result


class PinocchioRobot:
    """A Pinocchio model moved by the coordinates of a robot of ours: v = S(q) qd, mimics included."""

    def __init__(self, path: Path, robot: Robot) -> None:
        self.pin = pytest.importorskip("pinocchio")
        self.robot = robot
        root = [self.pin.JointModelFreeFlyer()] if robot.floating else []
        self.model = self.pin.buildModelFromUrdf(str(path), *root)
        self.data = self.model.createData()
        self.first = 6 if robot.floating else 0
        description = robot.description
        parts = tree(description) if robot.tip is None else chain(description, robot.base, robot.tip)
        law = parts.coordinates
        columns = zip(law.index.tolist(), law.multiplier.tolist(), law.offset.tolist(), strict=True)
        self.law = dict(zip(parts.joint_names, columns, strict=True))

    def move_to(self, q: np.ndarray, qd: np.ndarray, T_world_base: np.ndarray) -> None:
        self.pin_q, self.S = self.configuration(q, T_world_base), self.velocity_map(T_world_base)
        self.S_rate = self.velocity_map_rate(T_world_base, qd)
        self.pin.computeJointJacobiansTimeVariation(self.model, self.data, self.pin_q, self.S @ qd)
        self.pin.computeJointJacobians(self.model, self.data, self.pin_q)
        self.pin.updateFramePlacements(self.model, self.data)

    def has(self, frame: str) -> bool:
        return self.model.existFrame(frame, self.pin.FrameType.BODY)

    def pose(self, frame: str) -> np.ndarray:
        return self.data.oMf[self.model.getFrameId(frame, self.pin.FrameType.BODY)].homogeneous

    def jacobians(self, frame: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """J in the base, J in the tip, J̇ in the base."""
        pin, i = self.pin, self.model.getFrameId(frame, self.pin.FrameType.BODY)
        in_base, local = pin.LOCAL_WORLD_ALIGNED, pin.LOCAL
        J = pin.getFrameJacobian(self.model, self.data, i, in_base)
        J_rate = pin.getFrameJacobianTimeVariation(self.model, self.data, i, in_base)
        J_in_tip = pin.getFrameJacobian(self.model, self.data, i, local) @ self.S
        return J @ self.S, J_in_tip, J_rate @ self.S + J @ self.S_rate

    def center_of_mass(self) -> tuple[np.ndarray, np.ndarray]:
        J = self.pin.jacobianCenterOfMass(self.model, self.data, self.pin_q) @ self.S
        return J, self.data.com[0]

    def configuration(self, q: np.ndarray, T_world_base: np.ndarray) -> np.ndarray:
        values = {name: ratio * q[i] + offset for name, (i, ratio, offset) in self.law.items()}
        return place_joints(self.pin, self.model, values, T_world_base)

    def velocity_map(self, T_world_base: np.ndarray) -> np.ndarray:
        S = np.zeros((self.model.nv, self.robot.dof))
        if self.first:  # Pinocchio takes the twist of the base in its own axes
            S[:6, :6] = np.kron(np.eye(2), T_world_base[:3, :3].T)
        for name, joint in zip(self.model.names, self.model.joints, strict=True):
            if name in self.law:
                coordinate, ratio, _ = self.law[name]
                S[joint.idx_v, self.first + coordinate] = ratio
        return S

    def velocity_map_rate(self, T_world_base: np.ndarray, qd: np.ndarray) -> np.ndarray:
        rate = np.zeros((self.model.nv, self.robot.dof))
        if self.first:
            x, y, z = qd[3:6]
            turn = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            rate[:6, :6] = np.kron(np.eye(2), -T_world_base[:3, :3].T @ turn)
        return rate
