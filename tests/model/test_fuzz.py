"""Damaged files end in a CspaceError or in a robot, never in anything else, and never hang."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cspace.errors import CspaceError
from cspace.model import from_mjcf, from_toml, from_urdf, read_srdf, to_toml, to_urdf
from cspace.robots import load_description
from model.mjcf.models import ARM as MJCF
from model.mjcf.models import random_model
from model.mutation import POISON, exercise, exercise_srdf, mutant
from model.random_robots import random_tree
from model.test_srdf import PANDA, panda
from model.test_toml import DH, SCREWS, TREE
from model.test_urdf import ARM


def seeds():
    """Valid files to damage, a few kilobytes each."""
    trees = [random_tree(np.random.default_rng(i), n=4) for i in range(2)]
    texts = [ARM, TREE, SCREWS, DH, *map(to_urdf, trees), *map(to_toml, trees)]
    texts += [MJCF, random_model(np.random.default_rng(2), n=3), random_model(np.random.default_rng(6), n=4)]
    texts.append(to_urdf(load_description("planar_2r")))
    return [text.encode() for text in texts]


SEEDS = seeds()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_damaged_files_end_in_an_error_of_ours_or_in_a_robot(seed, tmp_path):
    rng = np.random.default_rng(seed)
    accepted = sum(exercise(mutant(rng, SEEDS), tmp_path / "x") for _ in range(150))
    assert accepted > 0, "the damage is too coarse to reach the deeper checks"


def damaged_srdf(rng):
    """An SRDF file of the Panda, damaged."""
    return mutant(rng, [PANDA.encode()])


@pytest.mark.parametrize("seed", range(2))
def test_damaged_srdf_files_end_in_an_error_of_ours_or_in_a_robot(seed):
    rng = np.random.default_rng(seed)
    assert sum(exercise_srdf(damaged_srdf(rng), panda()) for _ in range(150)) > 0


@pytest.mark.slow
@pytest.mark.parametrize("arm", [ARM, MJCF], ids=["urdf", "mjcf"])
def test_every_poison_in_every_attribute_is_refused_or_read(arm, tmp_path):
    """Each attribute value of the arms, each poison in its place."""
    rng = np.random.default_rng(0)
    parts = arm.split('"')
    for i in range(3, len(parts), 2):
        for poison in rng.choice(len(POISON), 6, replace=False):
            text = '"'.join([*parts[:i], "", *parts[i + 1 :]]).encode()
            at = len('"'.join(parts[:i]).encode()) + 1
            exercise(text[:at] + POISON[poison] + text[at:], tmp_path / "x")


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.text(max_size=200))
def test_any_text_is_refused_by_every_reader(text):
    for read in (from_urdf, from_mjcf, from_toml, read_srdf):
        with pytest.raises(CspaceError):
            read("x\n" + text if read is from_toml else "<" + text)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_are_refused(data):
    for read in (from_urdf, from_mjcf, read_srdf):
        with pytest.raises(CspaceError):
            read(data)
