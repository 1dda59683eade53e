import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import (
    Description,
    Joint,
    Link,
    Loop,
    body_freedoms,
    mobility,
    point_freedoms,
    task_word,
    tree_freedoms,
)
from model.random_robots import random_tree


def test_points_and_bodies():
    assert (point_freedoms(2), point_freedoms(3)) == (2, 3)
    assert (body_freedoms(2), body_freedoms(3)) == (3, 6)
    for count in (point_freedoms, body_freedoms):
        with pytest.raises(InputError, match=r"2 .*or 3"):
            count(4)


@pytest.mark.parametrize(
    ("links", "joints", "dimension", "expected"),
    [
        (7, [1] * 6, 3, 6),  # six-joint arm
        (2, [1], 2, 1),
        (4, [1] * 4, 2, 1),  # four-bar linkage
        (4, [1] * 4, 3, -2),  # the same, counted in space: its constraints are not independent
        (6, [1] * 7, 2, 1),  # Watt, Stephenson
        (5, [1] * 5, 2, 2),  # five-bar linkage
        (3, [1] * 3, 2, 0),  # a triangle is a frame
        (14, ["universal"] * 6 + ["prismatic"] * 6 + ["spherical"] * 6, 3, 6),  # Stewart platform
        (
            17,
            ["revolute"] * 9 + ["spherical"] * 12,
            3,
            15,
        ),  # Delta robot: 3, and 6 rods that spin idly
        (8, [1] * 7, 3, 7),
        (4, ["universal", "spherical", "revolute", "revolute"], 3, 1),
        (1, [], 3, 0),
    ],
)
def test_known_linkages(links, joints, dimension, expected):
    assert mobility(links=links, joints=joints, dimension=dimension) == expected


@pytest.mark.parametrize("seed", range(8))
def test_an_open_chain_has_as_many_freedoms_as_its_joints(seed):
    tree = random_tree(
        np.random.default_rng(seed), kinds=("revolute", "prismatic", "fixed", "planar", "floating")
    )
    assert mobility(tree) == tree_freedoms(tree)
    assert tree_freedoms(tree, floating=True) == tree_freedoms(tree) + 6


def test_parameters_less_constraints():
    n = 6
    assert mobility(links=n + 1, joints=[1] * n) == 6 * n - 5 * n


def test_loops_of_a_description_count():
    links = tuple(Link(name) for name in "abcd")
    joints = tuple(
        Joint(f"j{i}", "revolute", p, c, axis=(0, 0, 1)) for i, (p, c) in enumerate(["ab", "bc", "cd"])
    )
    assert mobility(Description("open", links, joints), dimension=2) == 3
    loop = Loop("close", "revolute", "d", "a", axis=(0, 0, 1))
    assert mobility(Description("four_bar", links, joints, (loop,)), dimension=2) == 1


@pytest.mark.parametrize(
    ("dof", "task", "word"), [(5, 6, "over-constrained"), (6, 6, "exact"), (7, 6, "redundant")]
)
def test_the_arm_against_the_task(dof, task, word):
    assert task_word(dof, task) == word


def test_bad_counts_are_refused():
    with pytest.raises(InputError, match="at least 1, the ground"):
        mobility(links=0, joints=[])
    with pytest.raises(InputError, match="expected 0 to 6"):
        mobility(links=2, joints=[7])
    with pytest.raises(InputError, match="expected 0 to 3"):
        mobility(links=2, joints=[-1], dimension=2)
    with pytest.raises(InputError, match="expected 0 to 6"):
        mobility(links=2, joints=[1.5])
    with pytest.raises(UnknownNameError, match="mean 'revolute'"):
        mobility(links=2, joints=["revolut"])
    with pytest.raises(InputError, match="needs a description"):
        mobility(links=2)
    with pytest.raises(InputError, match="not both"):
        mobility(Description("r", (Link("a"),)), links=2)
    with pytest.raises(InputError, match="negative"):
        task_word(-1, 6)


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: mobility(cs.load_robot("ur5e")), InputTypeError, "expected a Description, got Robot"),
        (lambda: tree_freedoms("ur5e"), InputTypeError, "expected a Description, got str"),
        (lambda: mobility(links=4, joints=4), InputTypeError, "joints is a list of freedoms"),
        (lambda: mobility(links=4, joints="revolute"), InputTypeError, "joints is a list of freedoms"),
        (lambda: mobility(links=4, joints=np.ones((4, 2))), InputError, "expected 0 to 6"),
        (lambda: mobility(links=4, joints=[None]), InputError, "a joint has None freedoms"),
        (lambda: point_freedoms([3]), InputError, "expected 2"),
        (lambda: body_freedoms("3"), InputError, "expected 2"),
    ],
)
def test_what_cannot_be_counted_is_refused(call, error, words):
    with pytest.raises(error, match=words):
        call()


def test_whole_numbers_may_come_as_an_array():
    assert mobility(links=4, joints=np.ones(4), dimension=2) == 1
