"""Scenes: values that never change, one namespace of names, and errors that name the cause."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError


def table_and_can():
    can = cs.Cylinder(0.03, 0.12, [0.4, 0.0, 0.3], name="can")
    return cs.Scene([cs.Box([1, 1, 0.1], [0, 0, 0.2], name="table"), can, cs.Sphere(0.1), cs.Sphere(0.2)])


def state(scene):
    """Everything a scene consists of, but its version."""
    objects = [(s.name, type(s), s.pose.tolist(), s._sizes()) for s in scene]
    attached = {n: (a.frame, a.T_frame_object.tolist(), a.touch) for n, a in scene.attached.items()}
    return objects, attached, scene.allowed


def test_a_scene_is_a_collection_of_named_shapes():
    scene = table_and_can()
    assert len(scene) == 4
    assert scene.names == ("table", "can", "sphere_1", "sphere_2")
    assert [shape.name for shape in scene] == list(scene.names)
    assert scene["can"].radius == 0.03
    assert "can" in scene
    assert "cup" not in scene
    assert scene.obstacles == tuple(scene)
    assert not cs.Scene()


EDITS = {
    "add": lambda s: s.add(cs.Sphere(1.0), [cs.Box([1, 1, 1]), cs.HalfSpace(name="floor")]),
    "remove": lambda s: s.remove("can", "sphere_1"),
    "move": lambda s: s.move("can", [1, 2, 3]),
    "attach": lambda s: s.attach("can", "hand", [0, 0, 0.1], touch=["left", "table", "left"]),
    "allow": lambda s: s.allow("can", "table"),
}


@pytest.mark.parametrize("name", EDITS)
def test_every_edit_returns_a_new_scene_and_leaves_the_old_one(name):
    scene = table_and_can()
    before = state(scene)
    new = EDITS[name](scene)
    assert state(scene) == before
    assert state(new) != before
    assert new.version != scene.version


def test_edits_do_what_they_say():
    scene = table_and_can()
    assert EDITS["add"](scene).names[4:] == ("sphere_3", "box_1", "floor")
    assert EDITS["remove"](scene).names == ("table", "sphere_2")
    assert np.array_equal(EDITS["move"](scene)["can"].pose[:3, 3], [1, 2, 3])
    held = EDITS["attach"](scene)
    assert held.attached["can"].touch == ("left", "table")
    assert held.attached["can"].T_frame_object[2, 3] == 0.1
    assert [shape.name for shape in held.obstacles] == ["table", "sphere_1", "sphere_2"]
    assert scene.allow("table", "can").allow("can", "table").allowed == (("can", "table"),)


def test_each_edit_has_its_inverse():
    scene = table_and_can()
    assert state(EDITS["attach"](scene).detach("can")) == state(scene)
    assert state(scene.allow("a", "b").forbid("b", "a")) == state(scene)
    assert state(scene.add(cs.Sphere(1.0, name="x")).remove("x")) == state(scene)
    put = EDITS["attach"](scene).detach("can", [0, 0, 5])
    assert put["can"].pose[2, 3] == 5
    assert not put.attached


def test_removing_an_object_removes_its_pairs():
    scene = table_and_can().allow("can", "table").attach("can", "hand", np.eye(4), touch=["table", "left"])
    scene = scene.remove("table")
    assert scene.allowed == ()
    assert scene.attached["can"].touch == ("left",)


def test_scenes_survive_pickling_and_show_themselves():
    scene = EDITS["attach"](table_and_can()).allow("can", "table")
    assert state(pickle.loads(pickle.dumps(scene))) == state(scene)
    assert repr(scene) == "<Scene 4 objects; 1 attached, 1 allowed to touch: table, can, sphere_1, sphere_2>"
    page = scene._repr_html_()
    assert "can – table" in page
    assert "hand" in page
    assert repr(cs.Scene()) == "<Scene 0 objects>"


CALLS = {
    "a name twice": (
        lambda s: s.add(cs.Sphere(1.0, name="can")),
        InputError,
        "two objects of the scene have the name 'can'",
    ),
    "an unknown name": (
        lambda s: s["cann"],
        UnknownNameError,
        "no object 'cann' in the scene; did you mean 'can'",
    ),
    "moving an unknown object": (lambda s: s.move("tabel", [0, 0, 0]), UnknownNameError, "'table'"),
    "removing an unknown object": (lambda s: s.remove("x"), UnknownNameError, "no object 'x'"),
    "attaching an unknown object": (
        lambda s: s.attach("x", "hand", np.eye(4)),
        UnknownNameError,
        "no object",
    ),
    "detaching what is not attached": (
        lambda s: s.detach("can"),
        UnknownNameError,
        "no attached object 'can'",
    ),
    "moving what is attached": (
        lambda s: s.attach("can", "hand", np.eye(4)).move("can", [0, 0, 0]),
        InputError,
        "'can' is attached to 'hand'; detach it first",
    ),
    "touch as one name": (
        lambda s: s.attach("can", "hand", np.eye(4), touch="left"),
        InputTypeError,
        "['left']",
    ),
    "NaN in the pose of an attached object": (
        lambda s: s.attach("can", "hand", [0, np.nan, 0]),
        InputError,
        "T_frame_object of 'can'",
    ),
    "a pair of one": (lambda s: s.allow("can", "can"), InputError, "names 'can' twice"),
    "a pair that is not allowed": (lambda s: s.forbid("can", "table"), UnknownNameError, "no allowed pair"),
    "something else than a shape": (lambda s: s.add([3]), InputTypeError, "is an int; it must be a shape"),
    "one shape without brackets": (lambda s: cs.Scene(cs.Sphere(1.0)), InputTypeError, "in brackets"),
    "an unknown link": (
        lambda s: s.allow("can", "hnad").check_links(["hand"], ["hand"], "r"),
        UnknownNameError,
        "no link or object 'hnad' in r and its scene; did you mean 'hand'",
    ),
    "an unknown frame": (
        lambda s: s.attach("can", "hend", np.eye(4)).check_links(["hand"], ["hand"], "r"),
        UnknownNameError,
        "no frame 'hend' in r (it carries 'can'); did you mean 'hand'",
    ),
    "an unknown name in touch": (
        lambda s: s.attach("can", "hand", np.eye(4), touch=["lift"]).check_links(["left"], ["hand"], "r"),
        UnknownNameError,
        "'left'",
    ),
    "an object named as a link": (
        lambda s: s.check_links(["can"], ["can"], "r"),
        InputError,
        "object 'can' has the name of a link of r",
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_misuse_is_named(name):
    call, kind, text = CALLS[name]
    with pytest.raises(kind) as caught:
        call(table_and_can())
    assert text in str(caught.value)


def test_a_half_space_cannot_be_attached():
    scene = cs.Scene([cs.HalfSpace(name="floor")])
    with pytest.raises(InputError, match="'floor' is a half space"):
        scene.attach("floor", "tool0", np.eye(4))


def test_many_objects_without_names_get_numbers_that_are_free():
    scene = cs.Scene([cs.Sphere(0.01, [0, 0, k], name="sphere_2" if k == 0 else "") for k in range(3000)])
    assert len(scene) == 3000
    assert set(scene.names) == {f"sphere_{k}" for k in range(1, 3001)}
    less = scene.remove("sphere_7", "sphere_3")
    assert less.add(cs.Sphere(0.01)).names[-1] == "sphere_3"
    assert less.add(cs.Sphere(0.01), cs.Sphere(0.01)).names[-1] == "sphere_7"
    assert less.add(cs.Box([1, 1, 1])).names[-1] == "box_1"


@pytest.mark.parametrize("path", ["cell.toml", Path("cell.toml")])
def test_a_path_in_place_of_objects_is_told_how_files_are_read(path):
    with pytest.raises(InputTypeError, match=r"objects is 'cell.toml'; Scene.load\(path\) reads a file"):
        cs.Scene(path)
