"""The reader against Pinocchio's on every robot of example-robot-data: joints, limits, frames, masses."""

from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

from cspace.errors import DescriptionError
from cspace.model import from_toml, from_urdf, to_toml, to_urdf
from oracles.forward import link_poses

pytestmark = pytest.mark.oracle

FAULTY = {"alex_psyonic_hands.urdf", "ur3.urdf"}  # one mimics a joint that is not there, one is empty


def urdf_files():
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return []
    return sorted(Path(str(file.locate())).resolve() for file in files if str(file).endswith(".urdf"))


FILES = [path for path in urdf_files() if path.name not in FAULTY]


def test_there_are_enough_robots_and_humanoids_among_them():
    pytest.importorskip("pinocchio")
    names = {path.stem for path in FILES}
    assert len(names) >= 20
    assert names >= {"talos_full_v2", "romeo", "icub", "g1_29dof_rev_1_0"}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_joints_limits_frames_and_masses_are_those_of_pinocchio(path):
    pin = pytest.importorskip("pinocchio")
    robot = from_urdf(path)
    model = pin.buildModelFromUrdf(str(path))
    moving = [joint for joint in robot.joints if joint.moving]
    assert {joint.name for joint in moving} == set(model.names) - {"universe"}
    for joint in moving:
        index = model.getJointId(joint.name)
        q, v = model.joints[index].idx_q, model.joints[index].idx_v
        if joint.type in ("revolute", "prismatic"):
            assert joint.lower == pytest.approx(model.lowerPositionLimit[q], abs=1e-12)
            assert joint.upper == pytest.approx(model.upperPositionLimit[q], abs=1e-12)
            assert joint.velocity == pytest.approx(model.velocityLimit[v], abs=1e-12)
            assert joint.effort == pytest.approx(model.effortLimit[v], abs=1e-12)
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    frames = [(i, frame.name) for i, frame in enumerate(model.frames) if frame.type == pin.BODY]
    bodies = {name: data.oMf[i].homogeneous for i, name in frames}
    poses = link_poses(robot, {}) if all(joint.mimic is None for joint in moving) else {}
    for name, pose in poses.items():
        if name in bodies:
            np.testing.assert_allclose(pose, bodies[name], atol=1e-10)
    tail = [link.inertial for link in robot.links if link.inertial and link.name != robot.root]
    fixed_to_root = model.inertias[0].mass  # what is carried by the ground counts there
    total = sum(inertia.mass for inertia in model.inertias)
    ours = sum(inertial.mass for inertial in tail) + (
        robot.link(robot.root).inertial.mass if robot.link(robot.root).inertial and fixed_to_root else 0.0
    )
    assert ours == pytest.approx(total, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_mesh_is_found_without_options(path):
    """package://example-robot-data is the share folder above the file; one file names its author's folder."""
    links = from_urdf(path).links
    meshes = [shape.mesh for link in links for shape in (*link.visual, *link.collision) if shape.mesh]
    for mesh in meshes:
        if mesh.uri.startswith("file:///usr/Romeo"):
            with pytest.raises(DescriptionError, match="not found; searched"):
                mesh.file()
        else:
            assert Path(mesh.file()).is_file()


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_robot_survives_urdf_and_toml(path):
    robot = from_urdf(path)
    rng = np.random.default_rng(0)
    q = {joint.name: rng.uniform(-1, 1) for joint in robot.moving_joints if joint.mimic is None}
    poses = link_poses(robot, q)
    for back in (from_urdf(to_urdf(robot)), from_toml(to_toml(robot))):
        again = link_poses(back, q)
        for name, pose in poses.items():
            np.testing.assert_allclose(again[name], pose, atol=1e-12)
