"""Link matrices as symbols: evaluated, they are forward kinematics; printed, they are those of the books."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs

CONVENTIONS = ["standard", "modified"]


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda", "jaco2", "scara", "planar_3r", "stanford"])
def test_the_symbols_evaluate_to_forward_kinematics(name, convention):
    robot = cs.load_robot(name)
    links = robot.link_matrices(convention=convention)
    q = np.random.default_rng(3).uniform(-1.5, 1.5, (4, robot.dof))
    table, values = links.table, links.values(q)
    np.testing.assert_allclose(links.fk(q), robot.fk(q), atol=1e-12)
    numbers = table.matrices(q)
    T = np.eye(4)
    for i, (A, product) in enumerate(zip(links.matrices, links.products, strict=True)):
        T = T @ numbers[:, i]
        np.testing.assert_allclose(A.evaluate(values), numbers[:, i], atol=1e-12)
        np.testing.assert_allclose(product.evaluate(values), T, atol=1e-12)
    np.testing.assert_allclose(table.T_base @ T @ table.T_tool, robot.fk(q), atol=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_random_chains_with_slides(seed):
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(4, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    kinds = "".join(rng.choice(["R", "P"], 4))
    tip = cs.pose(rng.normal(size=3))
    robot = cs.Robot.from_screws(axes, rng.normal(size=(4, 3)), tip, joint_types=kinds)
    q = rng.uniform(-2, 2, (5, 4))
    for convention in CONVENTIONS:
        np.testing.assert_allclose(robot.link_matrices(convention=convention).fk(q), robot.fk(q), atol=1e-9)


def test_the_universal_robots_class_as_in_print():
    """Hawkins 2013, Analytic inverse kinematics for the Universal Robots arms: the entries of its product."""
    links = cs.load_robot("ur5e").link_matrices()
    T = links.products[-1]
    assert T[2, 0].text(least=1e-5) == "−s234 c5 c6 − c234 s6"
    assert T[2, 2].text(least=1e-5) == "−s234 s5"
    assert links.products[2][0, 3].text(least=1e-5) == "0.425 c1 c2 + 0.3922 c1 c23"


def test_every_form_holds_every_matrix():
    links = cs.load_robot("puma560").link_matrices()
    text, markdown, latex = links.text(), links.to_markdown(), links.to_latex()
    assert "A1 A2 A3 A4 A5 A6" in text
    assert str(links) == text
    assert markdown.count("$$") == 2 * (6 + 5)
    assert latex.count(r"\[") == latex.count(r"\]") == 6 + 5
    for form in (markdown, latex):
        assert form.count("{") == form.count("}")
        assert form.isascii()


def test_long_entries_are_counted():
    text = cs.load_robot("xarm7").link_matrices().text()
    assert " terms" in text


def test_bad_input():
    links = cs.load_robot("planar_2r").link_matrices()
    with pytest.raises(cs.CspaceError, match="shape"):
        links.values([0.1, 0.2, 0.3])
    with pytest.raises(cs.CspaceError, match="convention"):
        cs.load_robot("planar_2r").link_matrices(convention="other")


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("digits", [9, 10, 12])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_rounded_right_angles_leave_no_terms_in_print(digits, scale, convention):
    """Rows alpha, a, d, theta; the lengths of an arm of one size or another."""

    def links(angle):
        rows = np.array([[angle, 0, 3, 0], [0, -4, 0, 0], [0, -2, 0, 0], [angle, 0, 1, 0], [-angle, 0, 1, 0]])
        robot = cs.Robot.from_dh(rows * [1, scale, scale, 1], convention=convention)
        return robot.link_matrices(convention=convention)

    rounded, exact = links(round(np.pi / 2, digits)), links(np.pi / 2)
    for one, other in zip(rounded.matrices + rounded.products, exact.matrices + exact.products, strict=True):
        assert str(one) == str(other)
        assert one.latex() == other.latex()
        assert str(one).count("\n") == 3
        assert "\n" not in repr(one)
