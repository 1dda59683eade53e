"""What is drawn is where the robot is."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.plot import colors
from cspace.plot.skeleton import make_skeleton, planar_basis
from plot import arms

ROBOTS = {"elbow": arms.elbow_arm, "planar": arms.planar_arm, "scara": arms.scara}


@pytest.mark.parametrize("name", ROBOTS)
def test_links_hang_together_and_end_at_the_tip(name):
    robot = ROBOTS[name]()
    for q in np.random.default_rng(1).uniform(-1, 1, size=(20, robot.dof)):
        drawn = make_skeleton(robot, q)
        np.testing.assert_allclose(drawn.T_tip, robot.fk(q), atol=1e-12)
        np.testing.assert_allclose(drawn.paths[-1][-1], robot.fk(q)[:3, 3], atol=1e-12)
        np.testing.assert_allclose(drawn.paths[0][0], 0.0, atol=1e-12)
        assert len(drawn.paths) == robot.dof + 1
        for i, (path, after) in enumerate(zip(drawn.paths, drawn.paths[1:], strict=False)):
            gap = after[0] - path[-1]
            travelled = gap @ drawn.axes[i] if drawn.types[i] == "P" else 0.0
            np.testing.assert_allclose(gap, travelled * drawn.axes[i], atol=1e-12)


@pytest.mark.parametrize("name", ROBOTS)
def test_joint_bodies_sit_on_their_axes(name):
    robot = ROBOTS[name]()
    q = np.random.default_rng(2).uniform(-1, 1, size=robot.dof)
    drawn = make_skeleton(robot, q)
    for i in range(robot.dof):
        off = drawn.joints[i] - drawn.paths[i][-1]
        assert np.linalg.norm(np.cross(off, drawn.axes[i])) < 1e-9


def test_planar_arms_are_told_from_others():
    np.testing.assert_allclose(planar_basis(arms.planar_arm().chain), np.eye(3)[:2], atol=1e-12)
    assert planar_basis(arms.elbow_arm().chain) is None
    assert planar_basis(arms.scara().chain) is None


@pytest.mark.parametrize("count", [1, 2, 8, 16])
def test_colours_differ_and_are_equally_light(count):
    tints = colors.make_palette(count)
    assert tints.shape == (count, 3)
    assert ((tints >= 0) & (tints <= 1)).all()
    if count > 1:
        apart = np.linalg.norm(tints[:, None] - tints[None], axis=2) + 10 * np.eye(count)
        assert apart.min() > 0.06
    luminance = tints @ [0.2126, 0.7152, 0.0722]
    groups = (luminance,) if count <= 8 else (luminance[::2], luminance[1::2])
    assert all(np.ptp(group) < 0.25 for group in groups)
