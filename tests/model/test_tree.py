import numpy as np
import pytest

from cspace.errors import DescriptionError
from cspace.model import Description, Inertial, Joint, Link, tree
from model.random_robots import random_tree, random_values
from oracles.forward import joint_values, link_poses, motion


def tree_poses(robot, q):
    """The pose of every link from the arrays alone."""
    c = robot.coordinates
    values = c.multiplier * np.array([q[name] for name in c.names])[c.index] + c.offset
    moved = []
    for k, kind in enumerate(robot.joint_types):
        before = np.eye(4) if robot.parent[k] < 0 else moved[robot.parent[k]]
        moved.append(before @ robot.placement[k] @ motion(kind, robot.axes[k], values[k]))
    return {name: (np.eye(4) if k < 0 else moved[k]) @ T for name, (k, T) in robot.frames.items()}


@pytest.mark.parametrize("seed", range(10))
def test_the_arrays_of_a_tree_move_every_link_as_the_joints_do(seed):
    rng = np.random.default_rng(seed)
    description = random_tree(rng, n=15)
    q = random_values(rng, description)
    robot = tree(description)
    assert (robot.parent < np.arange(len(robot.parent))).all()
    expected = link_poses(description, q)
    poses = tree_poses(robot, q)
    assert poses.keys() == expected.keys()
    for name, pose in poses.items():
        np.testing.assert_allclose(pose, expected[name], atol=1e-13)


@pytest.mark.parametrize("seed", range(5))
def test_folding_keeps_mass_first_moment_and_inertia_about_the_root(seed):
    rng = np.random.default_rng(seed)
    description = random_tree(rng)
    q = random_values(rng, description)
    robot = tree(description)
    poses = link_poses(description, q)

    def total(bodies):
        mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
        for m, c, inertia, T in bodies:
            R, p = T[:3, :3], T[:3, :3] @ c + T[:3, 3]
            mass, first = mass + m, first + m * p
            second = second + R @ inertia @ R.T + m * (p @ p * np.eye(3) - np.outer(p, p))
        return mass, first, second

    links = [(li.inertial, poses[li.name]) for li in description.links if li.inertial]
    by_link = total([(i.mass, i.com, i.inertia, T) for i, T in links])
    carrier = {k: poses[name] for name, (k, T) in robot.frames.items() if (np.eye(4) == T).all()}
    by_body = total(
        [(robot.mass[k + 1], robot.com[k + 1], robot.inertia[k + 1], T) for k, T in carrier.items()]
    )
    assert len(carrier) == len(robot.joint_types) + 1
    for mine, theirs in zip(by_body, by_link, strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-12)
    assert set(robot.massless) == {li.name for li in description.links if li.inertial is None}


def test_a_world_link_with_a_floating_joint_gives_a_floating_tree():
    links = tuple(Link(name, Inertial(1, (0, 0, 0), np.eye(3))) for name in ("world", "mount", "body", "arm"))
    joints = (
        Joint("m", "fixed", "world", "mount"),
        Joint("f", "floating", "mount", "body"),
        Joint("j", "revolute", "body", "arm"),
    )
    robot = tree(Description("h", links, joints))
    assert (robot.root, robot.floating, robot.joint_names) == ("body", True, ("j",))
    assert set(robot.frames) == {"body", "arm"}
    deep = Description("h", links, (joints[0], Joint("k", "revolute", "mount", "body"), joints[2]))
    assert not tree(deep).floating
    with pytest.raises(DescriptionError, match="floating"):
        tree(Description("h", links, (joints[2], joints[0], Joint("f", "floating", "arm", "world"))))


def test_the_oracle_resolves_mimics():
    description = random_tree(np.random.default_rng(0), n=30)
    q = random_values(np.random.default_rng(1), description)
    followers = [j for j in description.joints if j.mimic]
    assert followers
    values = joint_values(description, q)
    for joint in followers:
        lead = values[joint.mimic.joint]
        assert values[joint.name] == joint.mimic.multiplier * lead + joint.mimic.offset
