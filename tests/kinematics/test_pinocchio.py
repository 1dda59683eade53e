"""Every robot of example-robot-data against Pinocchio: poses, Jacobians, derivatives, centres of mass."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

from cspace.errors import DescriptionError
from cspace.model import chain, from_urdf, tree
from cspace.robot import Robot
from model.random_robots import random_pose

pytestmark = pytest.mark.oracle

TOLERANCE = 1e-10
FAULTY = {
    "alex_psyonic_hands": "joint 'Left_index_q2' mimics: no joint 'index_q1'",
    "ur3": "robot 'ur3' has no links",
}
HUMANOIDS = (
    "talos_full_v2",
    "romeo",
    "g1_29dof_rev_1_0",
    "icub",
    "simple_humanoid",
    "human",
    "alex_nub_hands",
)


def urdf_files() -> dict[str, Path]:
    """The URDF files of the package by name; the folder goes in front where a name comes twice."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return {}
    paths = [Path(str(file.locate())) for file in files if str(file).endswith(".urdf")]
    names = [path.stem for path in paths]
    return {p.stem if names.count(p.stem) == 1 else f"{p.parents[1].name}/{p.stem}": p for p in paths}


FILES = urdf_files()
if not FILES:
    pytest.skip("the robots of example-robot-data are not installed", allow_module_level=True)


class Oracle:
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
        from scipy.spatial.transform import Rotation

        result = self.pin.neutral(self.model)
        if self.first:
            result[:3] = T_world_base[:3, 3]
            result[3:7] = Rotation.from_matrix(T_world_base[:3, :3]).as_quat()
        for name, joint in zip(self.model.names, self.model.joints, strict=True):
            if name not in self.law:
                continue
            coordinate, ratio, offset = self.law[name]
            value = ratio * q[coordinate] + offset
            result[joint.idx_q : joint.idx_q + joint.nq] = (
                [np.cos(value), np.sin(value)] if joint.nq == 2 else [value]
            )
        return result

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


@pytest.mark.parametrize("floating", [False, True], ids=["fixed", "floating"])
@pytest.mark.parametrize("name", sorted(set(FILES) - set(FAULTY)))
def test_robot(name, floating):
    robot = Robot(from_urdf(FILES[name]), floating=floating)
    oracle = Oracle(FILES[name], robot)
    rng = np.random.default_rng(len(name))
    T_world_base = random_pose(rng) if floating else np.eye(4)
    placed = {"T_world_base": T_world_base} if floating else {}
    for _ in range(2):
        q, qd = rng.uniform(-2, 2, len(robot.joint_names)), rng.normal(size=robot.dof)
        oracle.move_to(q, qd, T_world_base)
        everything = robot.fk_all(q, **placed)
        compared = 0
        for number, frame in enumerate(robot.frames):
            if not oracle.has(frame):
                continue
            compared += 1
            T = oracle.pose(frame)
            np.testing.assert_allclose(everything[number], T, atol=TOLERANCE)
            np.testing.assert_allclose(robot.fk(q, frame, **placed), T, atol=TOLERANCE)
            if oracle.model.nv == 0:
                continue  # a rigid body; Pinocchio crashes on its empty Jacobian
            J, J_in_tip, J_rate = oracle.jacobians(frame)
            np.testing.assert_allclose(robot.jacobian(q, frame, **placed), J, atol=TOLERANCE)
            ours = robot.jacobian(q, frame, expressed_in="tip", **placed)
            np.testing.assert_allclose(ours, J_in_tip, atol=TOLERANCE)
            ours = robot.jacobian_dot(q, qd, frame, **placed)
            np.testing.assert_allclose(ours, J_rate, atol=TOLERANCE * (1 + np.abs(J_rate).max()))
        assert compared >= 1
        if robot.mass > 0.0 and oracle.model.nv > 0:
            check_center_of_mass(oracle, robot, q, placed)


def check_center_of_mass(oracle, robot, q, placed):
    """Pinocchio leaves out what is fixed to a base that does not move; it is put back here."""
    moving = sum(inertia.mass for inertia in list(oracle.model.inertias)[1:])
    if moving == 0.0:
        return
    assembly = robot._assembly
    base = 0.0 if robot.floating else assembly.mass[0]
    assert moving + base == pytest.approx(robot.mass, rel=1e-12)
    J_center, center = oracle.center_of_mass()
    expected = (moving * center + base * assembly.center[0]) / robot.mass
    np.testing.assert_allclose(robot.center_of_mass(q, **placed), expected, atol=TOLERANCE)
    ours = robot.center_of_mass_jacobian(q, **placed)
    np.testing.assert_allclose(ours, J_center * moving / robot.mass, atol=TOLERANCE)


@pytest.mark.parametrize("name", FAULTY)
def test_a_file_with_a_fault_is_refused_where_it_is(name):
    with pytest.raises(DescriptionError, match=FAULTY[name]):
        from_urdf(FILES[name])


def test_there_are_enough_robots_and_humanoids_among_them():
    assert len(FILES) >= 20
    assert set(HUMANOIDS) <= set(FILES)
