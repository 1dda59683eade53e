"""Solids of links of any size: flat, long, tiny and huge ones are covered, and checks agree with them."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.collision.exact_solids import cover_solid
from cspace.collision.link_shapes import solid_of
from cspace.errors import InputError

RNG = np.random.default_rng(7)
SIZES = (1e-30, 1e-12, 1e-6, 1e-3, 0.3, 2.0, 1e3, 1e6)
KINDS = ("box", "cylinder", "capsule")
ROUNDING = 1e-5
"""What checks keep beyond contacts, and rounding, as a share of the largest number."""


def make_solid(kind: str, a: float, b: float) -> cs.Box | cs.Cylinder | cs.Capsule:
    if kind == "box":
        return cs.Box([a, b, b])
    return cs.Cylinder(a, b) if kind == "cylinder" else cs.Capsule(a, b)


def robot_with(kind: str, a: float, b: float) -> cs.Robot:
    """An arm of one joint whose link is a solid."""
    text = f'<box size="{a} {b} {b}"/>' if kind == "box" else f'<{kind} radius="{a}" length="{b}"/>'
    return cs.Robot.from_urdf(
        f'<robot name="one"><link name="base"/><link name="arm"><collision><origin xyz="0.1 0.2 0"'
        f' rpy="0.3 0.2 0.1"/><geometry>{text}</geometry></collision></link><joint name="j" type="revolute">'
        '<parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1"'
        ' velocity="1"/></joint></robot>'
    )


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_covers_of_all_sizes_contain_the_solid(kind):
    for _ in range(12):
        a, b = RNG.choice(SIZES, 2)
        solid = make_solid(kind, a, b)
        spheres = cover_solid(solid, 0.01)
        assert len(spheres) < 5000
        low, high = solid.bounds
        points = np.clip(RNG.normal(size=(400, 3)) * (high - low), low, high)
        points = points[solid.distance(points) <= 0.0]
        gaps = np.linalg.norm(points[:, None] - spheres[:, :3], axis=2) - spheres[:, 3]
        assert (gaps.min(axis=1) <= 1e-9 * (high - low).max()).all()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("a", SIZES)
def test_checks_agree_with_the_distance(kind, a):
    b = RNG.choice(SIZES[:-2])
    robot = robot_with(kind, a, b)
    arm = next(link for link in robot.description.links if link.collision)
    for q in RNG.uniform(-3.0, 3.0, (4, 1)):
        solid = solid_of(arm.collision[0]).moved(robot.fk(q, "arm"))
        span = float(max(a, b, 1.0))
        center = solid.pose[:3, 3] + RNG.normal(size=3) * span
        distance = float(solid.distance(center))
        for share in (0.5, 0.99, 1.01, 2.0):
            radius = share * max(distance, ROUNDING * span)
            gap = distance - radius
            scene = cs.Scene([cs.Sphere(radius, center)])
            if abs(gap) > ROUNDING * (span + radius):
                assert robot.collides(q, scene) == (gap < 0.0)


def test_a_solid_that_cannot_be_covered_is_named():
    with pytest.raises(InputError, match=r"link 'arm'.*largest allowed value"):
        robot_with("cylinder", 1e12, 1.0).collision  # noqa: B018
