"""`cspace space` of any robot: slices, projections and volumes, pictures, and how it ends."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from cli.schema import check


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "cell.toml"
    cs.Scene(
        [cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], "wall"), cs.HalfSpace(offset=-0.1, name="floor")]
    ).save(path)
    return path


def space_of(scene):
    return cs.configuration_space(cs.load_robot("panda"), cs.Scene.load(scene))


@pytest.mark.parametrize("joints", ["2,4", "2 4", "panda_joint2,panda_joint4", "q2 panda_joint4"])
def test_a_slice_is_that_of_the_library(scene, joints):
    result = cspace(f"space panda --scene {scene} --joints {joints} --at ready --size 40 --json")
    assert result.code == 0
    check(result.json)
    part = space_of(scene).slice((1, 3), at=cs.load_robot("panda").named_poses["ready"], size=40)
    answer = result.json["slice"]
    assert answer["joints"] == ["panda_joint2", "panda_joint4"]
    assert answer["free_share"] == part.free_share
    assert answer["proved"] == part.proved
    assert sum(answer["blocked"].values()) == pytest.approx(1 - part.free_share)
    assert set(answer["blocked"]) <= set(result.json["obstacles"])
    assert result.json["volume"] is result.json["projection"] is None


def test_a_projection_and_a_volume_are_those_of_the_library(scene):
    result = cspace(f"space panda --scene {scene} --joints 1,2 --size 16 --samples 12 --seed 3 --json")
    check(result.json)
    part = space_of(scene).project((0, 1), size=16, samples=12, rng=3)
    np.testing.assert_array_equal(result.json["projection"]["share"], part.share)
    result = cspace(f"space panda --scene {scene} --samples 2000 --seed 3 --margin 5mm --json")
    check(result.json)
    space = cs.configuration_space(cs.load_robot("panda"), cs.Scene.load(scene), margin=0.005)
    assert result.json["volume"]["share"] == space.volume(2000, rng=3).share
    assert result.json["margin"] == 0.005


def test_words_and_pictures(scene, tmp_path):
    for extra, words in (("", "proved"), ("--samples 5", "can be free")):
        picture = tmp_path / "space.png"
        result = cspace(f"space panda --scene {scene} --joints 2,4 --size 32 {extra} --plot {picture}")
        assert result.code == 0, result
        assert words in result.out
        assert f"wrote {picture}" in result.out
        assert picture.read_bytes().startswith(b"\x89PNG")
        picture.unlink()
    assert "floor" in cspace(f"space panda --scene {scene} --joints 2,4 --size 64").out
    assert "with 95 % confidence" in cspace(f"space panda --scene {scene} --samples 500").out
    degrees = cspace(f"space panda --scene {scene} --joints 2,4 --at 0 0 0 -90 0 90 0 --deg --size 8 --json")
    np.testing.assert_allclose(degrees.json["slice"]["at"], np.radians([0, 0, 0, -90, 0, 90, 0]))


def test_planar_arms_have_slices_too(scene):
    result = cspace(f"space planar_2r --scene {scene} --joints 1,2 --size 32 --json")
    assert result.json["schema"] == "cspace.joint_space/1"
    assert result.json["slice"]["size"] == [32, 32]


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ("panda --joints 1,1", "twice"),
        ("panda --joints 1,8", "joints 1 to 7"),
        ("panda --joints 0,1", "joints 1 to 7"),
        ("panda --joints 1", "two joints"),
        ("panda --joints 1,2,3", "two joints"),
        ("panda --joints panda_joint1,panda_jont3", "did you mean"),
        ("panda --joints 1,2 --at nowhere", "nowhere"),
        ("panda --joints 1,2 --at 0 0", "--at has 2 values"),
        ("panda --joints 1,2 --at 0 0 0 0 0 0 0", "outside its limits"),
        ("panda --joints 1,2 --size 0", "size is 0"),
        ("panda --joints 1,2 --samples 0", "samples is 0"),
        ("panda --joints 1,2 --plot way.xyz", "xyz"),
        ("panda --at ready", "--at needs --joints"),
        ("panda --plot space.png", "--plot needs --joints"),
        ("panda --from 0 0", "--from is for planar arms"),
        ("panda --link-radius 0.1", "--link-radius is for planar arms"),
        ("panda --joints 1,2 --to 1 1", "--to is for planar arms"),
        ("panda --spheres s.json --geometry skeleton", "leave one out"),
        ("puma560_urdf", "no collision geometry"),
        ("planar_2r", "--scene"),
        ("planar_2r --size 3", "--size needs --joints"),
    ],
)
def test_words_that_make_no_sense(words, text):
    result = cspace(f"space {words}")
    assert result.code == 2, result
    assert text in result.err
