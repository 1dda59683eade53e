"""The report on inertias: sound robots pass, every kind of fault is named, singular means singular."""

from dataclasses import replace

import numpy as np
import pytest

from cspace.dynamics import InertiaReport, inertia_report
from cspace.dynamics.massless_motions import energy_factor
from cspace.errors import InputError, UnknownNameError
from cspace.kinematics import require_limits
from cspace.model import Description, Inertial, Joint, Link, Mimic
from cspace.robot import Robot
from cspace.robots import load_robot
from cspace.spatial import pose
from dynamics.bodies import hand_arm, random_body
from kinematics import robots
from model.random_robots import random_pose


def arm_with(inertial, **options):
    """An arm whose second of three links has these mass properties."""
    rng = np.random.default_rng(0)
    bodies = [random_body(rng), inertial, random_body(rng)]
    links = [Link("base"), *(Link(f"link_{i}", body) for i, body in enumerate(bodies))]
    joints = [
        Joint(
            f"joint_{i}",
            "revolute",
            links[i].name,
            links[i + 1].name,
            pose((0.3, 0, 0.1 * i)),
            rng.normal(size=3),
        )
        for i in range(3)
    ]
    return Robot(Description("arm", tuple(links), tuple(joints)), **options)


def found(report):
    return {(fault.part, fault.fault) for fault in report.faults}


@pytest.mark.parametrize("seed", range(20))
def test_bodies_of_mass_points_have_no_fault(seed):
    rng = np.random.default_rng(seed)
    description = hand_arm(rng)
    for robot in (Robot(description), Robot(description, tip="tcp"), Robot(description, floating=True)):
        report = robot.inertia_report()
        assert report, report
        assert (report.faults, report.singular) == ((), ())
        assert report.mass == robot.mass
    assert Robot(description, tip="tcp").with_payload(1.0, inertia=random_body(rng).inertia).inertia_report()


BROKEN = {
    "triangle inequality": (2.0, np.diag([0.1, 0.2, 0.31])),
    "not positive": (2.0, np.diag([0.1, -0.05, 0.2])),
    "inertia without mass": (0.0, np.diag([0.1, 0.2, 0.25])),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_what_no_body_can_have_is_named(fault):
    mass, inertia = BROKEN[fault]
    for seed in range(5):
        R = random_pose(np.random.default_rng(seed))[:3, :3]
        report = arm_with(Inertial(mass, (0, 0, 0), R @ inertia @ R.T)).inertia_report()
        assert not report
        (only,) = [each for each in report.faults if not each.hint]
        assert (only.part, only.fault, only.mass) == ("link_1", fault, mass)
        np.testing.assert_allclose(only.moments, np.sort(np.diag(inertia)), atol=1e-15)
        assert {"link_1", *fault.split()} <= set(str(report).split())
        assert f"<td>{fault}</td>" in report._repr_html_()
        assert repr(report) == f"<InertiaReport of arm: {report.mass:.6g} kg, 1 fault>"


@pytest.mark.parametrize("moments", [(1.0, 1.0, 2.0), (0.0, 0.5, 0.5), (1.0, 2.0, 3.0)])
def test_plates_and_rods_lie_on_the_border_and_pass(moments):
    R = random_pose(np.random.default_rng(1))[:3, :3]
    inertia = np.round(R @ np.diag(moments) @ R.T, 6)
    assert arm_with(Inertial(3.0, (0, 0, 0), inertia)).inertia_report()


@pytest.mark.parametrize(
    ("inertial", "hint"),
    [
        (Inertial(1.0, (0.1, 0, 0), np.zeros((3, 3))), "point mass"),
        (Inertial(1.0, (0.1, 0, 0), 1e3 * np.eye(3)), "size"),
        (None, "massless"),
    ],
)
def test_hints_are_no_faults(inertial, hint):
    report = arm_with(inertial).inertia_report()
    assert found(report) == {("link_1", hint)}
    assert report
    assert report.faults[0].hint
    assert f"{hint} (hint)" in str(report)
    assert "no faults, 1 hint" in repr(report)


def test_a_faulty_link_may_hide_in_the_body_that_it_is_fixed_to():
    """Two links as one: the tensor of the small one is impossible, that of both is not, or is as well."""
    rng = np.random.default_rng(2)
    arm = arm_with(random_body(rng))
    description = arm.description
    for moments, body_too in (((1e-6, 1e-6, 4e-6), False), ((1.0, 1.0, 4.0), True)):
        part = Link("part", Inertial(0.01, (0, 0, 0), np.diag(moments)))
        seam = Joint("seam", "fixed", "link_2", "part")
        whole = replace(description, links=(*description.links, part), joints=(*description.joints, seam))
        faults = {pair for pair in found(Robot(whole).inertia_report()) if pair[1] == "triangle inequality"}
        expected = {("part", "triangle inequality")}
        assert faults == expected | (
            {("link_2 with 1 more link", "triangle inequality")} if body_too else set()
        )


def test_a_robot_without_masses_says_so():
    report = load_robot("irb120").inertia_report()
    assert not report
    assert (
        repr(report)
        == "<InertiaReport of irb120: no link of irb120 has a mass; add inertial data to its description>"
    )
    assert set(report.singular) == set(load_robot("irb120").joint_names)
    assert load_robot("irb120").with_payload(1.0).inertia_report().singular


def chain_of(*bodies, axes=None, **options):
    links = [Link("base"), *(Link(f"link_{i}", body) for i, body in enumerate(bodies))]
    axes = axes or [(0, 0, 1)] * len(bodies)
    joints = [
        Joint(f"joint_{i}", "continuous", links[i].name, links[i + 1].name, pose((0.5, 0, 0)), axis)
        for i, axis in enumerate(axes)
    ]
    return Description("chain", tuple(links), tuple(joints))


POINT = Inertial(1.0, (0.5, 0, 0), np.zeros((3, 3)))
ON_AXIS = Inertial(1.0, (0, 0, 0), np.zeros((3, 3)))


def test_joints_that_move_without_inertia_are_named():
    assert Robot(chain_of(POINT, POINT)).inertia_report().singular == ()
    assert Robot(chain_of(POINT, POINT, None)).inertia_report().singular == ("joint_2",)
    assert Robot(chain_of(POINT, ON_AXIS)).inertia_report().singular == ("joint_1",)
    assert Robot(chain_of(None, POINT)).inertia_report().singular == ()  # two joints before one mass
    four = Robot(chain_of(None, None, None, POINT))  # four joints move the point in a plane: two freedoms
    assert set(four.inertia_report().singular) == {f"joint_{i}" for i in range(4)}
    spin = Robot(chain_of(POINT, POINT, axes=[(0, 0, 1), (1, 0, 0)]))  # about a line through the point
    assert spin.inertia_report().singular == ("joint_1",)
    floating = Robot(chain_of(POINT), floating=True)  # one point: only its three translations have energy
    assert "the base" in floating.inertia_report().singular
    assert "joint_1 moves without inertia" in repr(Robot(chain_of(POINT, None)).inertia_report())


def test_an_armature_is_an_inertia():
    description = chain_of(POINT, None)
    geared = [replace(joint, armature=1e-4) for joint in description.joints]
    assert Robot(replace(description, joints=tuple(geared))).inertia_report()
    follower = replace(description.joints[1], mimic=Mimic("joint_0", 2.0))
    assert Robot(replace(description, joints=(description.joints[0], follower))).inertia_report()


def dense_mass_matrix(robot, q, T):
    """Σ Jᵀ diag(m, I) J over the links, from the compiled Jacobians."""
    M = np.zeros((robot.dof, robot.dof))
    for name in robot.frames:
        one = robot.description.link(name).inertial
        if one is not None:
            J = robot.jacobian(q, name, point=one.com, **T)
            R = robot.fk(q, name, **T)[:3, :3]
            M += one.mass * J[:3].T @ J[:3] + J[3:].T @ R @ one.inertia @ R.T @ J[3:]
    return M


@pytest.mark.parametrize("floating", [False, True])
@pytest.mark.parametrize("seed", range(10))
def test_the_energy_factor_is_a_root_of_the_mass_matrix(seed, floating):
    rng = np.random.default_rng(seed)
    robot = Robot(robots.tree(seed).description, floating=floating)
    q = robots.random_q(robot, rng)
    A = energy_factor(robot._assembly, q)
    M = dense_mass_matrix(robot, q, {"T_world_base": np.eye(4)} if floating else {})
    np.testing.assert_allclose(A.T @ A, M, rtol=0, atol=1e-11 * np.abs(M).max())


@pytest.mark.parametrize("seed", range(20))
def test_singular_means_that_the_mass_matrix_is(seed):
    """Random robots with many links without mass: the report agrees with the rank of a dense matrix."""
    rng = np.random.default_rng(seed)
    description = robots.tree(seed).description
    links = [
        replace(li, inertial=random_body(rng) if rng.random() < 0.35 else None) for li in description.links
    ]
    robot = Robot(replace(description, links=tuple(links)))
    M = dense_mass_matrix(robot, robots.random_q(robot, rng), {})
    scale = np.sqrt(np.where(np.diag(M) > 0, np.diag(M), 1.0))
    values = np.linalg.eigvalsh(M / np.outer(scale, scale))
    assert bool(inertia_report(robot).singular) == bool(values[0] < 1e-12)


def test_limits_that_are_needed_are_named_where_they_are_absent():
    ur5e = load_robot("ur5e")
    with pytest.raises(InputError, match=r"^ur5e has no acceleration limits; pass acceleration=$"):
        require_limits(ur5e, "acceleration")
    np.testing.assert_array_equal(require_limits(ur5e, "velocity"), ur5e.limits.velocity)
    np.testing.assert_array_equal(require_limits(ur5e, "acceleration", 3), np.full(6, 3.0))
    np.testing.assert_array_equal(require_limits(ur5e, "jerk", np.arange(1, 7)), np.arange(1, 7))
    joints = [
        Joint(n, "revolute", a, b, velocity=v) for n, a, b, v in (("i", "a", "b", 1), ("j", "b", "c", np.inf))
    ]
    robot = Robot(Description("two", tuple(Link(n) for n in "abc"), tuple(joints)))
    with pytest.raises(InputError, match=r"^two has no velocity limits of j; pass velocity=$"):
        require_limits(robot, "velocity")
    for bad, text in (
        ([1, 2], r"shape \(2,\)"),
        (0, "above zero"),
        (np.nan, "contains nan"),
        (-1, "above zero"),
    ):
        with pytest.raises(InputError, match=text):
            require_limits(ur5e, "acceleration", bad)
    with pytest.raises(UnknownNameError, match="did you mean 'velocity'"):
        require_limits(ur5e, "velocty")


def test_a_report_is_plain_data():
    report = arm_with(Inertial(2.0, (0, 0, 0), np.diag([0.1, 0.2, 0.4]))).inertia_report()
    assert isinstance(report, InertiaReport)
    with pytest.raises(AttributeError):
        report.mass = 1.0
    assert "\n" not in repr(report)
    assert report.summary == f"{report.mass:.6g} kg, 1 fault"
