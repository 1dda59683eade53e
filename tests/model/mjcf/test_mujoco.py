"""The reader against MuJoCo itself: frames, limits, masses, forces, of handmade and of random models."""

import re

import numpy as np
import pytest

from cspace.model import from_mjcf, from_toml, from_urdf, to_toml, to_urdf
from cspace.robot import Robot
from model.mjcf.models import ARM, random_model
from oracles.forward import joint_values, link_poses

pytestmark = pytest.mark.oracle
mujoco = pytest.importorskip("mujoco")


@pytest.fixture(autouse=True)
def _away(tmp_path, monkeypatch):
    """MuJoCo writes its warnings into a file of the working folder."""
    monkeypatch.chdir(tmp_path)


def compiled(text):
    """MuJoCo's model; mesh files are what it need not see."""
    lines = [line for line in text.splitlines() if "mesh=" not in line and "<mesh" not in line]
    return mujoco.MjModel.from_xml_string("\n".join(lines))


def random_state(robot, model, rng):
    """A configuration for both: values by joint, and MuJoCo's data at the same place."""
    free = {joint.name: rng.uniform(-2, 2) for joint in robot.moving_joints if joint.mimic is None}
    values = joint_values(robot, free)
    data = mujoco.MjData(model)
    for k in range(model.njnt):
        data.qpos[model.jnt_qposadr[k]] = values[model.joint(k).name]
    mujoco.mj_kinematics(model, data)
    return free, data


def check_frames(robot, model, rng):
    free, data = random_state(robot, model, rng)
    poses = link_poses(robot, free)
    for k in range(model.nbody):
        pose = poses[model.body(k).name]
        np.testing.assert_allclose(pose[:3, 3], data.xpos[k], rtol=0, atol=1e-12)
        np.testing.assert_allclose(pose[:3, :3], data.xmat[k].reshape(3, 3), rtol=0, atol=1e-12)
    for k in range(model.nsite):
        name = model.site(k).name
        pose = poses[name if f"{name}_site" not in poses else f"{name}_site"]
        np.testing.assert_allclose(pose[:3, 3], data.site_xpos[k], rtol=0, atol=1e-12)
        np.testing.assert_allclose(pose[:3, :3], data.site_xmat[k].reshape(3, 3), rtol=0, atol=1e-12)


def check_limits(robot, model):
    for k in range(model.njnt):
        joint = robot.joint(model.joint(k).name)
        expected = model.jnt_range[k] if model.jnt_limited[k] else (-np.inf, np.inf)
        np.testing.assert_allclose([joint.lower, joint.upper], expected, rtol=1e-15)
        assert (
            joint.type
            == {2: "prismatic", 3: "revolute" if model.jnt_limited[k] else "continuous"}[model.jnt_type[k]]
        )


def check_masses(robot, model):
    for k in range(1, model.nbody):
        inertial = robot.link(model.body(k).name).inertial
        if inertial is None:
            assert model.body_mass[k] == 0.0
            continue
        R = np.zeros(9)
        mujoco.mju_quat2Mat(R, model.body_iquat[k])
        R = R.reshape(3, 3)
        expected = R @ np.diag(model.body_inertia[k]) @ R.T
        assert inertial.mass == pytest.approx(model.body_mass[k], rel=1e-12)
        if inertial.mass == 0.01 and not inertial.com.any():
            continue  # all of it is boundmass, for which MuJoCo names no place
        np.testing.assert_allclose(inertial.com, model.body_ipos[k], rtol=0, atol=1e-12)
        np.testing.assert_allclose(inertial.inertia, expected, rtol=0, atol=1e-12 * abs(expected).max())


@pytest.mark.parametrize("seed", range(60))
def test_random_models_are_those_of_mujoco(seed):
    rng = np.random.default_rng(seed)
    text = random_model(rng)
    robot, model = from_mjcf(text), compiled(text)
    for _ in range(3):
        check_frames(robot, model, rng)
    check_limits(robot, model)
    check_masses(robot, model)


def test_the_arm_is_that_of_mujoco():
    robot, model = from_mjcf(ARM), compiled(ARM)
    for seed in range(10):
        check_frames(robot, model, np.random.default_rng(seed))
    check_limits(robot, model)
    check_masses(robot, model)


def test_forward_kinematics_of_the_robot_is_that_of_mujoco():
    robot, model = Robot.from_mjcf(ARM, tip="hand_site"), compiled(ARM)
    rng = np.random.default_rng(0)
    data = mujoco.MjData(model)
    for _ in range(20):
        q = rng.uniform(-3, 3, 4)
        data.qpos[:4] = q
        mujoco.mj_kinematics(model, data)
        pose = np.eye(4)
        pose[:3, 3], pose[:3, :3] = data.site("hand").xpos, data.site("hand").xmat.reshape(3, 3)
        np.testing.assert_allclose(robot.fk(q), pose, rtol=0, atol=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_what_is_read_survives_urdf_and_toml(seed):
    rng = np.random.default_rng(seed)
    text = random_model(rng)
    robot, model = from_mjcf(text), compiled(text)
    for back in (from_urdf(to_urdf(robot)), from_toml(to_toml(robot))):
        check_frames(back, model, rng)


@pytest.mark.parametrize("seed", range(10))
def test_armature_damping_and_friction_are_those_that_mujoco_feels(seed):
    """The mass matrix with them less the one without, and the passive forces at unit velocity."""
    rng = np.random.default_rng(seed)
    names = ("armature", "damping", "frictionloss")

    def given(n, share=0.7):
        return "".join(f' {name}="{rng.uniform(0, 2)!r}"' for name in names[:n] if rng.random() < share)

    bodies = "".join(
        f'<body pos="0 0 1"><joint name="j{k}" type="{kind}" axis="0 1 0"{given(3)}/><geom size="0.1"/>'
        for k, kind in enumerate(("hinge", "slide", "hinge", "slide"))
    )
    kinds = ("motor", "position", "velocity", "general")
    actuators = ""
    for _ in range(5):
        kind, k, gear = kinds[int(rng.integers(4))], int(rng.integers(4)), float(rng.uniform(-9, 9))
        actuators += f'<{kind} joint="j{k}" gear="{gear!r}"{given(2)}/>'
    text = f"<mujoco><worldbody>{bodies}{'</body>' * 4}</worldbody><actuator>{actuators}</actuator></mujoco>"
    robot, model = from_mjcf(text), mujoco.MjModel.from_xml_string(text)
    bare = mujoco.MjModel.from_xml_string(re.sub(r' (armature|damping|frictionloss)="[^"]*"', "", text))
    matrices = []
    for each in (model, bare):
        data, M = mujoco.MjData(each), np.zeros((4, 4))
        data.qvel[:] = 1.0
        mujoco.mj_forward(each, data)
        mujoco.mj_fullM(each, data, M)
        matrices.append((M, data.qfrc_passive.copy()))
    (M, passive), (M_bare, passive_bare) = matrices
    joints = [robot.joint(f"j{k}") for k in range(4)]
    np.testing.assert_allclose(M - M_bare, np.diag([joint.armature or 0.0 for joint in joints]), atol=1e-12)
    np.testing.assert_allclose(passive_bare - passive, [joint.damping or 0.0 for joint in joints], atol=1e-12)
    np.testing.assert_allclose(model.dof_frictionloss, [joint.friction or 0.0 for joint in joints])


def test_masses_are_scaled_to_a_total_as_mujoco_does():
    rng = np.random.default_rng(3)
    text = random_model(rng).replace('balanceinertia="true"', 'balanceinertia="true" settotalmass="7"')
    robot, model = from_mjcf(text), compiled(text)
    check_masses(robot, model)
    assert sum(link.inertial.mass for link in robot.links if link.inertial) == pytest.approx(7.0)


def test_a_floating_base_is_where_mujoco_has_it():
    text = """<mujoco><worldbody><geom type="plane" size="1 1 1"/>
      <body name="torso" pos="0 0 1"><freejoint name="root"/><geom size="0.1"/>
        <body name="leg" pos="0 0.1 0"><joint name="hip" axis="1 0 0"/><geom size="0.1"/></body></body>
      </worldbody></mujoco>"""
    robot, model = Robot.from_mjcf(text), compiled(text)
    assert robot.floating
    assert robot.base == "torso"
    data = mujoco.MjData(model)
    data.qpos[:] = [1, 2, 3, 0.5, 0.5, -0.5, 0.5, 0.7]
    mujoco.mj_kinematics(model, data)
    T_world_base, expected = np.eye(4), np.eye(4)
    T_world_base[:3, 3], T_world_base[:3, :3] = data.xpos[1], data.xmat[1].reshape(3, 3)
    expected[:3, 3], expected[:3, :3] = data.xpos[2], data.xmat[2].reshape(3, 3)
    np.testing.assert_allclose(
        robot.fk([0.7], frame="leg", T_world_base=T_world_base), expected, rtol=0, atol=1e-12
    )
