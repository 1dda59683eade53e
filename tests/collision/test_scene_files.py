"""Scene files: round trips of every shape, the files of MoveIt, and faults with their place."""

from __future__ import annotations

import json

import numpy as np
import pytest

import cspace as cs
from collision.test_scene import state
from cspace.errors import DescriptionError, InputError
from shapes.solids import every_shape


def full_scene():
    rng = np.random.default_rng(0)
    scene = cs.Scene([*every_shape(rng), cs.Box([1, 1, 1], [0.1, 0.2, 0.3], name='a "quoted" ü')])
    scene = scene.attach("sphere_1", "hand", cs.random_pose(rng=rng), touch=["left"])
    return scene.allow("box_1", "link_3").attach("hull_1", "hand", [0, 0, 1])


@pytest.mark.parametrize("suffix", ["toml", "json"])
def test_what_is_written_reads_back_bit_for_bit(suffix, tmp_path):
    scene, path = full_scene(), tmp_path / f"scene.{suffix}"
    scene.save(path)
    again = cs.Scene.load(path)
    assert state(again) == state(scene)
    points = np.random.default_rng(1).normal(size=(50, 3))
    for a, b in zip(scene, again, strict=True):
        assert np.array_equal(a.distance(points), b.distance(points))
    again.save(tmp_path / f"again.{suffix}")
    assert (tmp_path / f"again.{suffix}").read_bytes() == path.read_bytes()


def test_a_file_is_whole_or_untouched(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("kept")
    with pytest.raises(InputError, match="UTF-8"):
        cs.Scene([cs.Sphere(1.0, name="\ud800")]).save(path)
    assert path.read_text() == "kept"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(InputError, match=r"must be \.toml or \.json"):
        cs.Scene().save(tmp_path / "scene.yaml")


def test_places_may_be_written_as_xyz_and_rpy(tmp_path):
    path = tmp_path / "cell.toml"
    path.write_text('[[objects]]\nshape = "box"\nsize = [1, 2, 3]\nxyz = [1, 0, 0]\nrpy = [0, 0, 0.5]\n')
    box = cs.Scene.load(path)["box_1"]
    assert np.allclose(box.pose, cs.pose([1, 0, 0], rpy=[0, 0, 0.5]))


def test_meshes_may_stand_in_files_beside_the_scene(tmp_path):
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    path = tmp_path / "cell.json"
    mesh = {"shape": "mesh", "file": "quad.obj", "scale": 0.5, "name": "quad", "xyz": [0, 0, 1]}
    path.write_text(json.dumps({"objects": [mesh]}))
    assert np.allclose(cs.Scene.load(path)["quad"].bounds, [[0, 0, 1], [0.5, 0.5, 1]])


OLD = """cell
* Box 0
1
box
0.2 0.4 0.6
1 2 3
0 0 0.7071067811865476 0.7071067811865476
0 0 0 0
* parts
2
sphere
0.3
0 0 1
0 0 0 1
0 0 0 0
cylinder
0.1 0.5
0 0 2
0 0 0 1
0 0 0 0
.
"""
NEW = """(noname)+
* Box 0
0 0 3
0 0 0 1
1
box
0.2 0.4 0.6
1 2 0
0 0 0.7071067811865476 0.7071067811865476
0.5 0.5 0.5 1
1
grip here
0 0 0
0 0 0 1
* parts
0 0 0
0 0 0 1
2
sphere
0.3
0 0 1
0 0 0 1
0 0 0 0
cylinder
0.1 0.5
0 0 2
0 0 0 1
0 0 0 0
0
* floor
0 0 0
0 0 0 1
1
plane
0 0 2 1
0 0 0
0 0 0 1
0 0 0 0
0
* sheet
0 0 0
0 0 0 1
1
mesh
3 1
0 0 0
1 0 0
0 1 0
0 1 2
0 0 0
0 0 0 1
0 0 0 0
0
.
"""


@pytest.mark.parametrize("text", [OLD, NEW])
def test_files_of_moveit_of_both_versions_are_read(text, tmp_path):
    (tmp_path / "cell.scene").write_text(text)
    scene = cs.Scene.load(tmp_path / "cell.scene")
    assert scene.names[:3] == ("Box 0", "parts/0", "parts/1")
    assert np.allclose(scene["Box 0"].pose, cs.pose([1, 2, 3], rpy=[0, 0, np.pi / 2]))
    assert np.array_equal(scene["Box 0"].size, [0.2, 0.4, 0.6])
    assert (scene["parts/0"].radius, scene["parts/1"].length) == (0.3, 0.5)
    assert scene["parts/1"].pose[2, 3] == 2
    if text == NEW:
        assert scene["floor"].distance([0, 0, 0]) == pytest.approx(0.5)
        assert len(scene["sheet"].faces) == 1


FAULTS = {
    "shape.toml": ('[[objects]]\nshape = "bocks"\n', [":1:", "'bocks'", "'box'"]),
    "key.toml": ('[[objects]]\nshape = "box"\nsise = [1, 1, 1]\n', ["'sise'", "'size'"]),
    "lacking.toml": ('\n[[objects]]\nshape = "box"\n', [":2:", "a box needs 'size'"]),
    "flat.toml": (
        '[[objects]]\nshape = "sphere"\nradius = 1\n[[objects]]\nshape = "sphere"\nradius = 0\n',
        [":4:"],
    ),
    "syntax.toml": ("[[objects]\n", [":1:", "malformed TOML"]),
    "both.toml": ('[[objects]]\nshape = "sphere"\nradius = 1\norigin = [[1]]\nxyz = [1]\n', ["not both"]),
    "nan.toml": ('[[objects]]\nshape = "sphere"\nradius = 1\nxyz = [nan, 0, 0]\n', ["finite"]),
    "pairs.toml": ('allowed = ["ab"]\n', ["pairs of names"]),
    "frame.toml": ('[[attached]]\nobject = "x"\nframe = "hand"\n', ["no object 'x'"]),
    "format.json": ('{"format": 2}', ["format is 2"]),
    "syntax.json": ('{"format":\n 1,,}', [":2:", "malformed JSON"]),
    "list.json": ("[]", ["in braces"]),
    "word.json": ('{"objects": [{"shape": "sphere", "radius": "big"}]}', ["radius of a sphere"]),
    "cut.scene": (OLD[:60], ["file ends"]),
    "word.scene": (OLD.replace("0.2 0.4 0.6", "0.2 x 0.6"), [":5:", "expected 3 numbers"]),
    "kind.scene": (OLD.replace("sphere", "cone"), ["'cone'"]),
    "mark.scene": ("cell\nhello\n", ["'hello'", "'*'"]),
    "flat.scene": (OLD.replace("0.2 0.4", "0 0.4"), ["each side must be positive"]),
    "cell.yaml": ("", ["'.yaml'"]),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_bad_file_is_named_with_its_fault(name, tmp_path):
    text, fragments = FAULTS[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(DescriptionError) as caught:
        cs.Scene.load(tmp_path / name)
    for fragment in [name, *fragments]:
        assert fragment in str(caught.value)
