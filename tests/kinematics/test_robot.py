"""The facade: what a robot says of itself, copies, bad input, and memory."""

import copy
import gc
import pickle
import sys
import tracemalloc
import weakref

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.errors import DescriptionError, InputError, InputTypeError, UnknownNameError
from cspace.model import Description, Joint, Link
from cspace.robot import Robot
from kinematics import robots
from model.random_robots import random_pose


def test_a_robot_says_what_it_is():
    assert cs.Robot is Robot
    assert repr(robots.arm(1, "RPR")) == "<Robot arm 1: RPR, 3 dof, link_0 → link_4>"
    floating = Robot(robots.tree(3).description, floating=True)
    assert "with a floating base" in repr(floating)
    assert "mounted in the world" in repr(robots.arm(1).with_base(np.eye(4)))
    for name in ("fk", "jacobian", "fk_jacobian"):
        method = getattr(Robot, name)
        assert "q (..., n)" in method.__doc__ or "as in jacobian" in method.__doc__
        assert method.__text_signature__.startswith("($self, q, frame=None, *, ")


def test_limits_are_those_of_the_joints_in_order():
    robot = robots.arm(2)
    assert len(robot.limits) == robot.dof == 6
    np.testing.assert_array_equal(robot.limits.lower, np.full(6, -2.5))
    assert robot.joint_names == tuple(f"joint_{i}" for i in range(6))


@pytest.mark.parametrize("again", [lambda r: pickle.loads(pickle.dumps(r)), copy.copy, copy.deepcopy])
def test_a_robot_survives_pickling_and_copying(again):
    rng = np.random.default_rng(0)
    for robot in (
        robots.arm(1).with_tool(random_pose(rng)).with_base(random_pose(rng)),
        robots.tree(2),
        Robot(robots.arm(3).description, tip="link_4", floating=True),
    ):
        same = again(robot)
        q = robots.random_q(robot, rng)
        np.testing.assert_array_equal(same.fk_all(q), robot.fk_all(q))
        assert (same.tip, same.frames, same.floating) == (robot.tip, robot.frames, robot.floating)


def test_a_floating_joint_in_the_description_floats_the_base():
    links = [Link("world"), Link("body"), Link("arm")]
    joints = [
        Joint("free", "floating", "world", "body"),
        Joint("shoulder", "revolute", "body", "arm", axis=[0, 1, 0]),
    ]
    robot = Robot(Description("drone", tuple(links), tuple(joints)))
    assert robot.floating
    assert robot.base == "body"
    assert robot.dof == 7
    assert robot.jacobian([0.3]).shape == (6, 7)
    locked = Robot(robot.description, base="body")
    assert (locked.floating, locked.dof) == (False, 1)
    with pytest.raises(DescriptionError, match="floating"):
        Robot(robot.description, base="world", tip="arm")


BAD_CALLS = [
    (
        lambda r: r.fk(np.zeros(5)),
        InputError,
        r"q has shape \(5,\), expected \(\.\.\., 6\): one value per joint of",
    ),
    (lambda r: r.fk(np.zeros((6, 2))), InputError, r"q has shape \(6, 2\)"),
    (lambda r: r.fk(0.0), InputError, r"q has shape \(\)"),
    (lambda r: r.fk("home"), InputTypeError, "q must be numbers"),
    (lambda r: r.fk(None), InputError, r"q has shape \(\)"),
    (lambda r: r.fk(np.zeros(6, complex)), InputTypeError, "q must be numbers"),
    (lambda r: r.fk(np.array([0, 0, np.nan, 0, 0, 0])), InputError, r"q holds nan at index \(2,\)"),
    (lambda r: r.jacobian(np.array([0, 0, 0, 0, -np.inf, 0])), InputError, r"q holds -inf at index \(4,\)"),
    (lambda r: r.fk_jacobian(np.full(6, np.nan)), InputError, r"q holds nan at index \(0,\)"),
    (lambda r: r.fk_jacobian([[0, np.nan, 0, 0, 0, 0]] * 2), InputError, r"q holds nan at index \(0, 1\)"),
    (lambda r: r.singular_values(np.full((2, 6), np.nan)), InputError, r"q holds nan at index \(0, 0\)"),
    (lambda r: r.fk_all(np.full((9, 6), np.inf)), InputError, r"q holds inf at index \(0, 0\)"),
    (lambda r: r.center_of_mass(np.full(6, np.inf)), InputError, "q holds inf"),
    (
        lambda r: r.jacobian_dot(np.zeros(6), np.zeros(7)),
        InputError,
        r"qd has shape \(7,\), expected",
    ),
    (lambda r: r.jacobian_dot(np.zeros(6), np.full(6, np.nan)), InputError, "qd holds nan"),
    (
        lambda r: r.fk(np.zeros(6), "link_9"),
        UnknownNameError,
        "no frame 'link_9' in arm 1; did you",
    ),
    (lambda r: r.fk(np.zeros(6), frame=3), InputTypeError, "frame must be a name, got int"),
    (
        lambda r: r.jacobian(np.zeros(6), point=[1, 2]),
        InputError,
        r"point has shape \(2,\), expected",
    ),
    (lambda r: r.jacobian(np.zeros(6), point=[1, 2, np.nan]), InputError, "point holds nan"),
    (
        lambda r: r.jacobian(np.zeros(6), expressed_in="tool"),
        UnknownNameError,
        "expressed_in.*base, tip",
    ),
    (lambda r: r.fk(np.zeros(6), T_world_base=np.diag([1, 1, 2, 1])), InputError, "T_world_base"),
    (lambda r: r.fk(np.zeros(6), T_world_base=np.zeros(3)), InputError, r"T_world_base has shape \(3,\)"),
    (
        lambda r: r.fk(np.zeros((2, 6)), T_world_base=np.tile(np.eye(4), (3, 1, 1))),
        InputError,
        "do not broadcast",
    ),
    (lambda r: r.with_tool(np.full((4, 4), np.nan)), InputError, "T_tip_tool"),
    (lambda r: r.with_base(np.tile(np.eye(4), (2, 1, 1))), InputError, r"T_world_base has shape \(2, 4, 4\)"),
    (
        lambda r: r.fk(np.zeros(6), out=np.empty((4, 3))),
        InputError,
        r"out has shape \(4, 3\), expected",
    ),
    (lambda r: r.fk(np.zeros(6), out=np.empty((4, 4), "f4")), InputTypeError, "out must be a float64 array"),
    (lambda r: r.fk(np.zeros(6), out=np.empty((4, 8))[:, ::2]), InputError, "C-contiguous"),
    (lambda r: r.fk_jacobian(np.zeros(6), out=np.empty((4, 4))), InputTypeError, "pair of arrays"),
    (lambda r: r.fk(np.zeros(6), threads=-1), InputError, "threads is -1"),
    (
        lambda r: r.fk(np.zeros(6), threads=1.5),
        InputTypeError,
        "threads is a float; it must be a whole number",
    ),
    (lambda r: r.fk(np.zeros(6), fram="link_1"), TypeError, "fram"),
    (lambda r: r.fk(), TypeError, "q"),
]


@pytest.mark.parametrize(("call", "error", "words"), BAD_CALLS)
def test_bad_input_is_refused_with_the_subject_the_value_and_the_rule(call, error, words):
    with pytest.raises(error, match=words):
        call(robots.arm(1))


def test_a_tree_asks_for_a_frame_and_names_its_leaves():
    tree = robots.tree(2)
    with pytest.raises(InputError, match=r"branches, so name a frame.*link_"):
        tree.fk(np.zeros(len(tree.joint_names)))
    with pytest.raises(InputError, match="branches"):
        tree.with_tool(np.eye(4))
    with pytest.raises(InputError, match="branches"):
        _ = tree.chain
    with pytest.raises(UnknownNameError, match="no link 'hand'"):
        Robot(tree.description, tip="hand")
    with pytest.raises(InputError, match="floating"):
        Robot(tree.description, floating=True).with_base(np.eye(4))


def test_without_masses_there_is_no_centre_of_mass():
    with pytest.raises(InputError, match="no link of planar 2R has a mass"):
        robots.planar(1, 1).center_of_mass([0, 0])


def test_the_compiled_half_defends_itself():
    """What Python never passes must not crash either."""
    bare = _core.KinematicsBase.__new__(_core.KinematicsBase)
    assert bare.dof == 0
    with pytest.raises((AttributeError, TypeError)):
        bare.fk(np.zeros(6))
    q = np.zeros((2, 6))
    with pytest.raises(TypeError, match="must be a robot"):
        _core._tree_rows(bare, q, None, None, None, None, 1)
    robot = robots.arm(1)
    with pytest.raises(TypeError, match="is immutable"):
        robot.__init__(robot.description)
    for arguments in [
        (99, q, None, None, None, np.empty((2, 4, 4)), None, None, None, 63, False, 1),
        (0, q, None, None, None, np.empty((1, 4, 4)), None, None, None, 63, False, 1),
        (0, q, None, None, None, None, np.empty((2, 6, 5)), None, None, 63, False, 1),
        (0, q[:, ::2], None, None, None, None, None, None, None, 63, False, 1),
        (0, q, None, None, None, None, None, np.empty((2, 6, 6)), None, 63, False, 1),
    ]:
        with pytest.raises((TypeError, ValueError), match=r"frame number|wrong size|incompatible|needs qd"):
            _core._chain_rows(robot, *arguments)
    assembly = copy.copy(robot._assembly)
    assembly.parent = np.array([-1, 0, 1, 5, 3, 4])
    with pytest.raises(ValueError, match="do not fit together"):
        _core.KinematicsBase(assembly)


def test_many_calls_leave_no_memory_and_no_references_behind():
    robot = robots.arm(1)
    q, name = np.zeros(6), "link_3"
    bad = np.full(6, np.nan)

    def use(times):
        for _ in range(times):
            robot.fk(q)
            robot.jacobian(q)
            robot.fk_jacobian(q)
            robot.fk(q, name)
            robot.fk(q, frame=name)

    def misuse(times):
        for _ in range(times):
            with pytest.raises(InputError):
                robot.fk(bad)
            with pytest.raises(UnknownNameError):
                robot.fk_jacobian(q, "nowhere")

    use(1000), misuse(20)
    gc.collect()
    locked = [sys.getrefcount(thing) for thing in (robot, q, name, bad, Robot)]
    tracemalloc.start()
    use(20_000), misuse(100)
    gc.collect()
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert [sys.getrefcount(thing) for thing in (robot, q, name, bad, Robot)] == locked
    assert size < 100_000


def test_robots_are_freed():
    description = robots.arm(1).description

    def make(times):
        for _ in range(times):
            robot = Robot(description)
            robot.fk(np.zeros(6))
        return weakref.ref(robot)

    make(5)
    gc.collect()
    before = sys.getrefcount(Robot), sys.getrefcount(_core.KinematicsBase)
    last = make(50)
    gc.collect()
    assert last() is None
    assert (sys.getrefcount(Robot), sys.getrefcount(_core.KinematicsBase)) == before


@pytest.mark.parametrize(
    "name", ["name", "limits", "base", "tip", "joint_names", "joint_types", "frames", "mass"]
)
@pytest.mark.parametrize("kind", ["robot", "solver"])
def test_what_describes_a_model_is_not_replaced(name, kind):
    robot = cs.load_robot("ur5e")
    model = robot if kind == "robot" else robot.solver
    before = getattr(model, name)
    with pytest.raises(AttributeError, match=f"{name} of .* cannot be set; build another one"):
        setattr(model, name, before)
    assert getattr(model, name) is before


@pytest.mark.parametrize("name", ["ur5e", "panda", "planar_3r", "scara_arm"])
def test_rows_without_a_configuration_pass_through_as_nan(name):
    """What robot.ik gives for many goals can be given back: its rows of NaN are poses of NaN."""
    robot = cs.load_robot(name)
    q = robot.random_configuration(3, rng=7, reach=0.1)
    batch = np.stack([q, np.full_like(q, np.nan), q])
    for made, count in ((robot.fk, 1), (robot.jacobian, 1), (robot.fk_jacobian, 2), (robot.fk_all, 1)):
        whole, rows = made(batch), made(q)
        for all_rows, some in zip(*((x,) if count == 1 else x for x in (whole, rows)), strict=True):
            assert np.isnan(all_rows[1]).all()
            assert np.array_equal(all_rows[0], some)
            assert np.array_equal(all_rows[2], some)
    batch[1, 0, 0] = 0.0
    for made in (robot.fk, robot.jacobian, robot.fk_jacobian, robot.fk_all):
        with pytest.raises(InputError, match="q holds nan"):
            made(batch)
        with pytest.raises(InputError, match="q holds nan"):
            made(np.full(len(robot.joint_names), np.nan))
