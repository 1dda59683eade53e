"""Mesh files: each format gives the same box, and bad files are named with their fault."""

from __future__ import annotations

import struct

import numpy as np
import pytest

import cspace as cs
from cspace import shapes
from cspace.errors import MeshError
from shapes.solids import box_mesh

SIZE = (0.5, 1.0, 0.25)


def stl_text(vertices, faces):
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in vertices[face].tolist())
        + "endloop\nendfacet\n"
        for face in faces
    )
    return f"solid box\n{facets}endsolid box\n".encode()


def stl_binary(vertices, faces):
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *vertices[face].ravel(), 0) for face in faces)
    return b"solid by name".ljust(80) + struct.pack("<I", len(faces)) + records


def obj(vertices, faces):
    rows = [f"v {x} {y} {z}" for x, y, z in vertices]
    rows += [f"f {a + 1}/1 {b - len(vertices)}//2 {c + 1}" for a, b, c in faces]
    return "\n".join(["# a box", "vn 0 0 1", *rows]).encode()


def ply_header(form, count):
    return (
        f"ply\nformat {form} 1.0\ncomment box\nelement vertex 8\nproperty float x\nproperty double y\n"
        "property float z\nproperty uchar red\n"
        f"element face {count}\nproperty list uchar int vertex_indices\nend_header\n"
    )


def ply_text(vertices, faces):
    rows = [f"{x} {y} {z} 255" for x, y, z in vertices] + [f"3 {a} {b} {c}" for a, b, c in faces]
    return (ply_header("ascii", len(faces)) + "\n".join(rows)).encode()


def ply_binary(order, form):
    def write(vertices, faces):
        rows = [struct.pack(order + "fdfB", *v, 255) for v in vertices]
        rows += [struct.pack(order + "B3i", 3, *f) for f in faces.tolist()]
        return ply_header(form, len(faces)).encode() + b"".join(rows)

    return write


def collada(vertices, faces):
    """In centimetres, y up, turned and moved by a node, with polygons of a polylist."""
    T = cs.pose([0.1, 0.2, 0.3], rotvec=[0.3, 0.4, 0.5])
    up = cs.pose(matrix=[[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    local = cs.transform_points(cs.inverse_pose(up @ T), vertices) * 100
    T = T.copy()
    T[:3, 3] *= 100
    numbers = " ".join(map(repr, local.ravel().tolist()))
    corners = " ".join(f"{v} 0" for v in faces.ravel())
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{numbers}</float_array>
<technique_common><accessor source="#a" count="8" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#n" offset="1"/><vcount>{"3 " * len(faces)}</vcount>
<p>{corners}</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene><node><matrix>{" ".join(map(repr, T.ravel().tolist()))}</matrix>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes></COLLADA>""".encode()


WRITERS = {
    "text.stl": stl_text,
    "binary.STL": stl_binary,
    "box.obj": obj,
    "text.ply": ply_text,
    "little.ply": ply_binary("<", "binary_little_endian"),
    "big.ply": ply_binary(">", "binary_big_endian"),
    "box.dae": collada,
}


@pytest.mark.parametrize("name", WRITERS)
def test_every_format_gives_the_same_box(name, tmp_path):
    (tmp_path / name).write_bytes(WRITERS[name](*box_mesh(SIZE)))
    mesh = shapes.Mesh.from_file(tmp_path / name, pose=[1.0, 0.0, 0.0], name="box")
    assert mesh.solid
    assert (len(mesh.vertices), len(mesh.faces), mesh.name) == (8, 12, "box")
    assert mesh.volume == pytest.approx(np.prod(SIZE))
    points = np.random.default_rng(0).normal(size=(200, 3))
    assert np.abs(mesh.distance(points) - shapes.Box(SIZE, [1.0, 0.0, 0.0]).distance(points)).max() < 1e-7


@pytest.mark.parametrize("scale", [2.0, [2.0, -1.0, 0.5]])
def test_a_scale_applies_to_the_file_and_a_mirrored_mesh_stays_outward(scale, tmp_path):
    (tmp_path / "box.obj").write_bytes(obj(*box_mesh(SIZE)))
    mesh = shapes.Mesh.from_file(tmp_path / "box.obj", scale=scale)
    assert mesh.volume == pytest.approx(np.prod(np.abs(np.multiply(SIZE, scale))))
    assert mesh.contains([0.01, 0.01, 0.01])


def test_polygons_are_cut_into_triangles(tmp_path):
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    quad = shapes.Mesh.from_file(tmp_path / "quad.obj")
    assert len(quad.faces) == 2
    assert not quad.solid
    with pytest.raises(cs.errors.InputError, match="not closed"):
        shapes.Mesh.from_file(tmp_path / "quad.obj", solid=True)


BOX = stl_binary(*box_mesh(SIZE))
FAULTS = {
    "cut.stl": (BOX[:-10], "announces 12 triangles"),
    "text.stl": (b"solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n", "cut off"),
    "word.stl": (b"solid x\nvertex a 0 0\nvertex 0 0 0\nvertex 0 0 0\nendsolid", "malformed STL"),
    "other.stl": (b"hello", "no STL file"),
    "nan.stl": (
        BOX[:96] + struct.pack("<f", np.nan) + BOX[100:],
        "not finite",
    ),
    "empty.obj": (b"# nothing\n", "no triangles"),
    "number.obj": (b"v 0 0 0\nv 1 0 0\nf 1 2 3\n", ":3: 'f 1 2 3'"),
    "short.obj": (b"v 0 0\n", ":1: 'v 0 0'"),
    "cut.ply": (ply_text(*box_mesh(SIZE))[:-30], "cut off"),
    "head.ply": (b"ply\nformat ascii 1.0\nelement vertex many\nend_header\n", ":3: 'element vertex many'"),
    "not.dae": (b"<html></html>", "root element is <html>"),
    "entity.dae": (b"<!DOCTYPE a [<!ENTITY b 'c'>]><COLLADA/>", "entity"),
    "broken.dae": (b"<COLLADA>", ":1: malformed XML"),
    "box.step": (b"", "'.step'"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_bad_file_is_named_with_its_fault(name, tmp_path):
    data, text = FAULTS[name]
    (tmp_path / name).write_bytes(data)
    with pytest.raises(MeshError) as caught:
        shapes.Mesh.from_file(tmp_path / name)
    assert name in str(caught.value)
    assert text in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(MeshError, match=r"absent\.stl: no such file"):
        shapes.Mesh.from_file(tmp_path / "absent.stl")


def test_cut_and_changed_files_raise_nothing_else(tmp_path):
    rng = np.random.default_rng(0)
    for name, write in WRITERS.items():
        whole = write(*box_mesh(SIZE))
        for trial in range(60):
            data = bytearray(whole[: rng.integers(len(whole) + 1)] if trial % 2 else whole)
            for _ in range(3 if data else 0):
                data[rng.integers(len(data))] = rng.integers(256)
            (tmp_path / name).write_bytes(data)
            try:
                mesh = shapes.Mesh.from_file(tmp_path / name)
            except cs.CspaceError:
                continue
            assert np.isfinite(mesh.vertices).all()
            assert 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices)
