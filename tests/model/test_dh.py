import warnings

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import Inertial, Limits, chain, dh_matrix, from_dh, from_screws, from_urdf, to_dh, to_urdf
from cspace.model.dh import DHTable
from cspace.robot import Robot
from cspace.spatial import pose
from model.random_robots import random_pose
from oracles.forward import motion, product_of_exponentials

CONVENTIONS = ("standard", "modified")


def rot_x(angle):
    return motion("R", (1, 0, 0), angle)


def rot_z(angle):
    return motion("R", (0, 0, 1), angle)


def move(x, z):
    return motion("P", (x, 0, z), 1.0)


def elementary(row, convention):
    """One row as the product of its four elementary motions."""
    alpha, a, d, theta = row
    if convention == "standard":
        return rot_z(theta) @ move(0, d) @ move(a, 0) @ rot_x(alpha)
    return rot_x(alpha) @ move(a, 0) @ rot_z(theta) @ move(0, d)


def chain_fk(c, q):
    return product_of_exponentials(c.axes, c.points, c.joint_types, c.T_zero, q)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_matrix_is_the_product_of_its_four_motions(convention):
    rows = np.random.default_rng(0).normal(size=(5, 7, 4))
    matrices = dh_matrix(*np.moveaxis(rows, -1, 0), convention=convention)
    assert matrices.shape == (5, 7, 4, 4)
    for i, j in np.ndindex(5, 7):
        np.testing.assert_allclose(matrices[i, j], elementary(rows[i, j], convention), atol=1e-14)


def test_the_modified_matrix_starts_its_last_column_with_a_of_the_link_before():
    alpha, a, d, theta = 0.4, 0.7, 0.2, 1.1
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    printed = [
        [ct, -st, 0, a],
        [st * ca, ct * ca, -sa, -sa * d],
        [st * sa, ct * sa, ca, ca * d],
        [0, 0, 0, 1],
    ]
    np.testing.assert_allclose(dh_matrix(alpha, a, d, theta, convention="modified"), printed, atol=1e-16)
    wrong = np.array(printed)
    wrong[0, 3] = alpha  # the slip that circulates: α where a belongs
    right = elementary((alpha, a, d, theta), "modified")
    assert np.abs(wrong - right).max() > 0.1
    np.testing.assert_allclose(printed, right, atol=1e-15)


def test_the_two_conventions_are_different_robots_with_the_same_numbers():
    table = [[np.pi / 2, 0.3, 0.1, 0], [0, 0.4, 0, 0], [0.5, 0.1, 0.2, 0]]
    robots = [chain(from_dh(table, convention=convention)) for convention in CONVENTIONS]
    poses = [chain_fk(c, [0.1, 0.2, 0.3]) for c in robots]
    assert np.abs(poses[0] - poses[1]).max() > 0.1


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("seed", range(8))
def test_a_table_its_urdf_and_its_screws_move_alike(convention, seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 9))
    types = "".join(rng.choice(["R", "P", "F"], n, p=[0.6, 0.25, 0.15]))
    table = rng.normal(size=(n, 4))
    T_base, T_tool = random_pose(rng), random_pose(rng)
    robot = from_dh(table, convention=convention, joint_types=types, T_base=T_base, T_tool=T_tool)
    dh = DHTable(convention, *table.T, types, T_base, T_tool)
    q = rng.uniform(-3, 3, (4, sum(kind != "F" for kind in types)))
    for values, T in zip(q, dh.fk(q), strict=True):
        expected, moving = T_base, iter(values)
        for row, kind in zip(table, types, strict=True):
            value = 0.0 if kind == "F" else next(moving)
            shifted = row + np.array([0, 0, value, 0]) if kind == "P" else row + np.array([0, 0, 0, value])
            expected = expected @ elementary(shifted, convention)
        expected = expected @ T_tool
        np.testing.assert_allclose(T, expected, atol=1e-12)
        np.testing.assert_allclose(chain_fk(chain(robot), values), expected, atol=1e-12)
        np.testing.assert_allclose(chain_fk(chain(from_urdf(to_urdf(robot))), values), expected, atol=1e-12)


def test_the_two_joint_arm_of_the_lectures_from_its_modified_table():
    l1, l2, theta1, theta2 = 0.5, 0.3, 0.7, -1.2
    table = [(0, 0, 0, 0), (0, l1, 0, 0), (0, l2, 0, 0)]
    T = chain_fk(chain(from_dh(table, convention="modified", joint_types="RRF")), [theta1, theta2])
    x = l1 * np.cos(theta1) + l2 * np.cos(theta1 + theta2)
    y = l1 * np.sin(theta1) + l2 * np.sin(theta1 + theta2)
    np.testing.assert_allclose(T[:3, 3], [x, y, 0], atol=1e-15)


def test_rows_may_be_named():
    rows = [{"a": 0.5}, {"a": 0.3, "theta": 0.1}]
    named = chain(from_dh(rows, convention="standard"))
    plain = chain(from_dh([[0, 0.5, 0, 0], [0, 0.3, 0, 0.1]], convention="standard"))
    np.testing.assert_array_equal(named.T_zero, plain.T_zero)
    with pytest.raises(UnknownNameError, match="did you mean 'alpha'"):
        from_dh([{"alfa": 1.0}], convention="standard")


@pytest.mark.parametrize(
    ("table", "more", "error", "says"),
    [
        (np.zeros((2, 3)), {}, InputError, r"expected \(n, 4\)"),
        (np.zeros(4), {}, InputError, r"expected \(n, 4\)"),
        ([[0, 0, np.nan, 0]], {}, InputError, "finite"),
        (np.zeros((2, 4)), {"convention": None}, InputError, "convention='standard' or 'modified'"),
        (np.zeros((2, 4)), {"convention": "modifed"}, UnknownNameError, "did you mean 'modified'"),
        (np.zeros((2, 4)), {"joint_types": "RX"}, InputError, "joint_types"),
        (np.zeros((2, 4)), {"joint_types": "R"}, InputError, "joint_types"),
        (np.zeros((2, 4)), {"lower": [0]}, InputError, "lower"),
        (np.zeros((2, 4)), {"T_tool": np.zeros((4, 4))}, InputError, "T_tool"),
        (np.zeros((2, 4)), {"joint_names": ["a"]}, InputError, "joint_names"),
        ("table", {}, Exception, "numbers"),
    ],
)
def test_bad_tables_are_refused(table, more, error, says):
    with pytest.raises(error, match=says):
        from_dh(table, **({"convention": "standard"} | more))


def geometries(rng):
    """Chains of every awkward kind: parallel, coincident, intersecting axes, slides, tilted tips."""
    n = int(rng.integers(1, 8))
    axes, points = [rng.normal(size=3)], [rng.normal(size=3)]
    if rng.random() < 0.3:
        axes, points = [np.array([0, 0, 1.0])], [np.array([0, 0, rng.normal()])]
    for _ in range(n - 1):
        axis, point = axes[-1] / np.linalg.norm(axes[-1]), points[-1]
        kind = rng.choice(["skew", "parallel", "anti", "line", "meet", "square"])
        side = np.cross(axis, rng.normal(size=3))
        new = {"parallel": axis, "anti": -axis, "line": axis * rng.choice([-1, 1]), "square": side}
        where = {"line": point + axis * rng.normal(), "meet": point + axis * rng.normal()}
        axes.append(new.get(kind, rng.normal(size=3)))
        points.append(where.get(kind, point + rng.normal(size=3)))
    T = random_pose(rng)
    if rng.random() < 0.4:
        T[:3, :3] = random_pose(rng)[:3, :3]
        z = axes[-1] / np.linalg.norm(axes[-1])
        x = np.cross(z, rng.normal(size=3))
        x /= np.linalg.norm(x)
        T[:3, :3] = np.column_stack([x, np.cross(z, x), z])
        if rng.random() < 0.5:
            T[:3, 3] = points[-1] + z * rng.normal()
    types = "".join(rng.choice(["R", "P"], n, p=[0.75, 0.25]))
    return chain(from_screws(axes, points, T, joint_types=types))


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("seed", range(60))
def test_the_derived_table_moves_as_the_chain(convention, seed):
    rng = np.random.default_rng(seed)
    c = geometries(rng)
    table = to_dh(c, convention=convention)
    assert table.deviation < 1e-12
    assert (table.a >= 0).all()
    again = chain(from_dh(table))
    for _ in range(5):
        q = rng.uniform(-3, 3, len(c.joint_types))
        expected = chain_fk(c, q)
        np.testing.assert_allclose(table.fk(q), expected, atol=1e-12)
        np.testing.assert_allclose(chain_fk(again, q), expected, atol=1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_the_special_choices_are_those_that_are_stated(seed):
    rng = np.random.default_rng(seed)
    z = np.array([0.0, 0.0, 1.0])
    # joints 1, 2 parallel; 2, 3 meet; 3, 4 on one line
    meet = np.array([0.5, 0.2, 0.9])
    across = rng.normal(size=3)
    axes = [z, z, across, across]
    points = [np.zeros(3), meet - 0.4 * z, meet + 0.3 * across, meet - 0.7 * across]
    c = chain(from_screws(axes, points, random_pose(rng)))
    standard, modified = (to_dh(c, convention=convention) for convention in CONVENTIONS)
    np.testing.assert_array_equal(standard.T_base, np.eye(4))
    assert standard.d[0] == 0.0  # parallel
    assert standard.alpha[0] == 0.0
    assert standard.a[0] == pytest.approx(np.hypot(0.5, 0.2))
    assert standard.a[1] == pytest.approx(0.0, abs=1e-15)  # they meet
    assert abs(standard.theta_offset[1]) <= np.pi / 2 + 1e-7
    assert standard.a[2] == standard.d[2] == standard.theta_offset[2] == 0.0  # on one line
    assert modified.alpha[0] == modified.a[0] == 0.0
    np.testing.assert_array_equal(modified.alpha[1:], standard.alpha[:-1])
    np.testing.assert_array_equal(modified.a[1:], standard.a[:-1])
    np.testing.assert_array_equal(modified.d, standard.d)
    np.testing.assert_array_equal(modified.theta_offset, standard.theta_offset)


@pytest.mark.parametrize("seed", range(10))
def test_a_table_in_common_normal_form_comes_back_as_it_was(seed):
    rng = np.random.default_rng(seed)
    n = 6
    table = np.column_stack(
        [rng.uniform(0.2, 1.4, n), rng.uniform(0.1, 1, n), rng.uniform(-1, 1, n), rng.uniform(-1, 1, n)]
    )
    table[0, 2:] = 0.3, 0.2
    back = to_dh(chain(from_dh(table, convention="standard")), convention="standard")
    np.testing.assert_allclose(back.rows, table, atol=1e-12)
    np.testing.assert_allclose(back.T_tool, np.eye(4), atol=1e-12)


def test_nearly_parallel_axes_are_called_parallel_and_the_price_is_told():
    tilt = 1e-9
    axes = [[0, 0, 1], [0, np.sin(tilt), np.cos(tilt)]]
    c = chain(from_screws(axes, [[0, 0, 0], [1, 0, 0]], np.eye(4)))
    table = to_dh(c, convention="standard")
    assert table.alpha[0] == 0.0
    worst = max(
        np.abs(table.fk(q) - chain_fk(c, q)).max() for q in np.random.default_rng(0).uniform(-3, 3, (50, 2))
    )
    assert 1e-10 < worst <= table.deviation < 1e-8


def test_the_printed_table_says_what_moves():
    text = str(DHTable("modified", [0, np.pi / 2], [0, 0.5], [0.1, 0.2], [0, 0], "RP"))
    assert text.splitlines()[0] == "Denavit–Hartenberg, modified"
    assert "α_i-1 [°]" in text
    assert "0 + q1" in text
    noise = str(DHTable("standard", [-1e-17], [1e-16], [-0.0], [1e-24], "R"))
    assert noise.split()[-7:] == ["joint_1", "0", "0", "0", "0", "+", "q1"]
    assert "0.2 + q2" in text
    assert " 90 " in text


def test_a_table_is_read_as_a_table():
    tool = pose((0, 0, -0.25))
    table = DHTable("standard", [np.pi / 2, 0], [0, 0.5], [0.1, 0], [0, -np.pi / 2], "RP", T_tool=tool)
    head, titles, first, second, name, *rows = str(table).splitlines()
    assert head == "Denavit–Hartenberg, standard"
    assert titles.split() == ["i", "joint", "α_i", "[°]", "a_i", "[m]", "d_i", "[m]", "θ_i", "[°]"]
    assert first.split() == ["1", "joint_1", "90", "0", "0.1", "0", "+", "q1"]
    assert second.split() == ["2", "joint_2", "0", "0.5", "0", "+", "q2", "-90"]
    assert name == "T_tool"
    np.testing.assert_allclose([[float(x) for x in row.split()] for row in rows], tool)
    assert "T_base" not in str(table)


def test_limits_are_read_as_a_table():
    limits = Limits([-1.0, -np.inf], [2.5, np.inf], velocity=[np.inf, 0.25])
    _, titles, *rows = str(limits).splitlines()
    assert titles.split() == ["i", "lower", "upper", "velocity"]
    assert [row.split() for row in rows] == [["0", "-1", "2.5", "-"], ["1", "-", "-", "0.25"]]
    assert str(Limits([], [])).splitlines()[1].split() == ["i", "lower", "upper"]


@pytest.mark.parametrize(
    ("column", "error", "words"),
    [
        (np.nan, InputError, "a holds nan"),
        (np.inf, InputError, "a holds inf"),
        (1j, InputTypeError, "a must be numbers"),
        ("abc", InputTypeError, "a must be numbers"),
        ([[1.0], [1.0, 2.0]], InputTypeError, "a must be numbers"),
        (np.zeros(2), InputError, r"alpha \(3,\) and a \(2,\) .*do not broadcast"),
    ],
)
def test_a_matrix_of_what_is_no_number_is_refused(column, error, words):
    with pytest.raises(error, match=words):
        dh_matrix(np.zeros(3), column, 0.0, 0.0, convention="modified")


@pytest.mark.parametrize("column", [0, 3])
@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_table_in_degrees_is_noticed_and_one_in_radians_is_not(column, convention):
    table = np.zeros((3, 4))
    table[1, column] = -90.0
    with pytest.warns(UserWarning, match="np.radians"):
        from_dh(table, convention=convention)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for angle in (np.radians(-90.0), 2 * np.pi, -2 * np.pi):
            table[1, column] = angle
            from_dh(table, convention=convention)
        table[1, 1:3] = 90.0  # a long link is no angle
        from_dh(table, convention=convention)


def random_bodies(rng, n):
    """Mass properties of n random bodies, in the frames of a table."""
    arms = rng.normal(size=(n, 3, 3))
    numbers = zip(rng.random(n), rng.normal(size=(n, 3)), arms @ np.swapaxes(arms, 1, 2), strict=True)
    return [Inertial(*row) for row in numbers]


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("seed", range(4))
def test_bodies_of_a_table_stand_in_its_frames(convention, seed):
    """Frame i is T_base A_1 … A_i: there are the centre of mass and the tensor of body i."""
    rng = np.random.default_rng(seed)
    n = 5
    types = "".join(rng.choice(["R", "P", "F"], n, p=[0.6, 0.25, 0.15]))
    dh = DHTable(convention, *rng.normal(size=(4, n)), types, random_pose(rng), random_pose(rng))
    bodies = random_bodies(rng, n)
    robot = Robot(from_dh(dh, inertials=bodies))
    q = rng.uniform(-2, 2, robot.dof)
    frame, mass, weighted = dh.T_base, 0.0, np.zeros(3)
    for A, body, link in zip(dh.matrices(q), bodies, robot.description.links[1:], strict=False):
        frame = frame @ A
        mass += body.mass
        weighted += body.mass * (frame[:3, :3] @ body.com + frame[:3, 3])
        R = (np.eye(4) if link.name == robot.base else robot.fk(q, frame=link.name))[:3, :3]
        turned = R @ link.inertial.inertia @ R.T
        np.testing.assert_allclose(turned, frame[:3, :3] @ body.inertia @ frame[:3, :3].T, atol=1e-12)
    assert robot.mass == pytest.approx(mass, rel=1e-14)
    np.testing.assert_allclose(robot.center_of_mass(q), weighted / mass, atol=1e-12)


def test_a_row_may_have_no_body_and_no_friction():
    body = Inertial(2.0, np.zeros(3), np.eye(3))
    table = [(0, 0.5, 0, 0), (0, 0.3, 0, 0)]
    robot = from_dh(
        table, convention="standard", inertials=[None, body], damping=[0.1, None], armature=[0.2, 0.3]
    )
    assert [link.inertial is None for link in robot.links] == [True, True, False, True]
    np.testing.assert_array_equal(robot.links[2].inertial.com, [0.3, 0, 0])
    assert [joint.damping for joint in robot.joints[:2]] == [0.1, None]
    assert [joint.friction for joint in robot.joints[:2]] == [None, None]
    assert [joint.armature for joint in robot.joints[:2]] == [0.2, 0.3]


@pytest.mark.parametrize(
    ("more", "error", "says"),
    [
        (
            {"inertials": [None]},
            InputError,
            "inertials has 1 entries for 2 rows of the table; give",
        ),
        ({"damping": 0.1}, InputError, "damping has 1 entries for 2 rows"),
        ({"friction": [0.1, np.nan]}, InputError, "friction of joint 'joint_2'"),
        (
            {"inertials": [1.0, None]},
            InputTypeError,
            "inertials contains a float; each entry must be",
        ),
    ],
)
def test_bad_bodies_of_a_table_are_refused(more, error, says):
    with pytest.raises(error, match=says):
        from_dh(np.zeros((2, 4)), convention="standard", **more)
