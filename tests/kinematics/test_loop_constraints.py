"""Equations of closed loops against differences, and what they refuse."""

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.kinematics import LoopConstraints, loop_freedom
from cspace.model import Loop
from cspace.robot import Robot
from kinematics.loops import ROWS, TYPES, bennett, random_loop, random_tree

STEP = 1e-6


def constrained(seed, **options):
    rng = np.random.default_rng(seed)
    robot = Robot(random_tree(rng, **options))
    ends = [(f"link_{rng.integers(0, 3)}", f"link_{rng.integers(3, 8)}") for _ in TYPES]
    loops = [random_loop(rng, kind, *pair) for kind, pair in zip(TYPES, ends, strict=True)]
    return LoopConstraints(robot, loops), rng


@pytest.mark.parametrize("planar", [False, True], ids=["joints", "planar joint"])
@pytest.mark.parametrize("seed", range(6))
def test_the_jacobian_and_the_bias_are_derivatives_of_the_residual(seed, planar):
    constraints, rng = constrained(seed, planar=planar)
    robot = constraints.robot
    q, qd = rng.normal(size=(3, len(robot.joint_names))), rng.normal(size=(3, robot.dof))
    K = constraints.jacobian(q)
    steps = STEP * np.eye(robot.dof)
    columns = [(constraints.residual(q + e) - constraints.residual(q - e)) / (2 * STEP) for e in steps]
    np.testing.assert_allclose(K, np.stack(columns, axis=-1), atol=1e-7)
    rate = (constraints.jacobian(q + STEP * qd) - constraints.jacobian(q - STEP * qd)) / (2 * STEP)
    np.testing.assert_allclose(constraints.bias(q, qd), np.einsum("kij,kj->ki", rate, qd), atol=1e-6)
    assert K.shape == (3, sum(ROWS.values()), robot.dof)
    for row in range(3):  # one configuration and many
        np.testing.assert_allclose(constraints.jacobian(q[row]), K[row], atol=1e-12)


@pytest.mark.parametrize("kind", TYPES)
def test_what_a_type_allows_leaves_it_closed(kind):
    """A loop is closed after the motions that its type allows, and open after the others."""
    rng = np.random.default_rng(3)
    free = {
        "spherical": "abc", "revolute": "c", "continuous": "c", "prismatic": "z", "universal": "u",
        "cylindrical": "cz", "planar": "cxy", "fixed": "", "distance": "",
    }[kind]  # fmt: skip
    from cspace.model import Description, Joint, Link

    names = "xyzabc"
    links = [Link("base"), *(Link(name) for name in names)]
    joints = [
        Joint(name, "prismatic" if i < 3 else "continuous", links[i].name, name, axis=np.eye(3)[i % 3])
        for i, name in enumerate(names)
    ]
    robot = Robot(Description("free body", tuple(links), tuple(joints)))
    second = (1, 0, 0) if kind == "universal" else None
    length = 0.3 if kind == "distance" else None
    loop = Loop("it", kind, "base", "c", axis=(0, 0, 1), second_axis=second, length=length)
    constraints = LoopConstraints(robot, [loop])
    for name in names:
        q = np.zeros(6)
        q[names.index(name)] = 0.4
        size = np.abs(constraints.residual(q)).max()
        if kind == "distance":
            q[names.index(name)] = 0.3
            assert (np.abs(constraints.residual(q)).max() < 1e-15) == (name in "xyz")
        elif kind == "universal":  # about z in the base and x in the body
            assert (size < 1e-15) == (name in "ac")
        else:
            assert (size < 1e-15) == (name in free)
    freedoms = {"distance": 5, "universal": 2}.get(kind, len(free))
    regular = [0.3, 0, 0, 0, 0, 0] if kind == "distance" else rng.normal(size=6) * 0
    assert loop_freedom(constraints, regular).dof == freedoms


def test_a_loop_that_is_closed_upside_down_is_not_closed():
    robot = bennett()
    flat = Loop("flat", "planar", "ground", "bar_2")
    constraints = LoopConstraints(robot, [flat])
    rng = np.random.default_rng(0)
    q = rng.uniform(-3, 3, (200, 3))
    up = np.array([robot.fk(each, "bar_2")[0, 0] for each in q])
    assert np.isinf(constraints.miss(q[up <= 0])).all()
    assert np.isfinite(constraints.miss(q[up > 0])).all()


def test_a_floating_base_moves_no_loop():
    rng = np.random.default_rng(1)
    description = random_tree(rng, mimic=False)
    fixed, floating = Robot(description), Robot(description, floating=True)
    loops = [random_loop(rng, kind, "link_0", "link_7") for kind in TYPES]
    q, qd = rng.normal(size=(2, fixed.dof))
    ours, other = (LoopConstraints(robot, loops) for robot in (fixed, floating))
    np.testing.assert_array_equal(other.residual(q), ours.residual(q))
    np.testing.assert_array_equal(other.jacobian(q)[:, :6], 0)
    np.testing.assert_array_equal(other.jacobian(q)[:, 6:], ours.jacobian(q))
    base = rng.normal(size=6)
    np.testing.assert_allclose(other.bias(q, np.concatenate([base, qd])), ours.bias(q, qd), atol=1e-12)


def test_wrenches_of_multipliers_do_the_work_of_the_rows():
    """Kᵀ λ are the torques of the wrenches at the ends of the loops."""
    constraints, rng = constrained(2, mimic=False)
    robot = constraints.robot
    q, multipliers = rng.normal(size=robot.dof), rng.normal(size=len(constraints.rows))
    torques = np.zeros(robot.dof)
    for loop, wrench in zip(constraints.loops, constraints.wrenches(q, multipliers), strict=True):
        point = robot.fk(q, loop.child) @ loop.child_origin[:, 3]
        for end, sign in ((loop.child, 1), (loop.parent, -1)):
            local = np.linalg.solve(robot.fk(q, end), point)[:3]
            torques += sign * robot.jacobian(q, end, point=local).T @ wrench
    np.testing.assert_allclose(constraints.jacobian(q).T @ multipliers, torques, atol=1e-12)


@pytest.mark.parametrize(
    ("loop", "message"),
    [
        (Loop("a", "helical", "base", "link_7"), "loop 'a' is helical; it has no pitch"),
        (Loop("a", "universal", "base", "link_7"), "give second_axis="),
        (Loop("a", "spherical", "base", "base"), "do not move against each other"),
    ],
)
def test_loops_that_cannot_be(loop, message):
    robot = Robot(random_tree(np.random.default_rng(0)))
    with pytest.raises(InputError, match=message):
        LoopConstraints(robot, [loop])


def test_other_bad_input():
    robot = Robot(random_tree(np.random.default_rng(0)))
    with pytest.raises(InputError, match="has no closed loops; give loops="):
        LoopConstraints(robot, [])
    with pytest.raises(InputTypeError, match=r"loops are model\.Loop objects, got a str"):
        LoopConstraints(robot, ["pin"])
    with pytest.raises(UnknownNameError, match="no link 'link_70' in tree, which loop 'a' ties"):
        LoopConstraints(robot, [Loop("a", "spherical", "base", "link_70")])
    pair = [Loop("a", "spherical", "base", "link_7")] * 2
    with pytest.raises(InputError, match="two loops of tree are named 'a'"):
        LoopConstraints(robot, pair)
    constraints = LoopConstraints(robot, pair[:1])
    with pytest.raises(InputError, match="expected"):
        constraints.residual([0.0])
    with pytest.raises(InputError, match="nan"):
        constraints.jacobian(np.full(len(robot.joint_names), np.nan))
    with pytest.raises(InputTypeError, match="first argument must be a Robot"):
        LoopConstraints("robot", pair[:1])
