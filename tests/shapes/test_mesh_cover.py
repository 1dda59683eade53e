"""Covers of meshes and hulls hold the shape, stick out no farther than stated, and are kept in files."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import cspace as cs
from cspace import shapes
from cspace.shapes.cover_cache import cache_folder
from shapes.solids import box_mesh


def random_directions(rng, n):
    """Unit vectors (n, 3)."""
    directions = rng.normal(size=(n, 3))
    return directions / np.linalg.norm(directions, axis=1)[:, None]


def star_mesh(rng, pose=(0, 0, 0)):
    """A solid that is not convex: a hull of unit vectors, its corners moved to random distances."""
    directions = random_directions(rng, 60)
    ball = shapes.Hull(directions)
    return shapes.Mesh(ball.vertices * rng.uniform(0.1, 0.25, (len(ball.vertices), 1)), ball.facets, pose)


def ring_mesh(sides=20):
    """A ring of square section."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    rho, z = 0.2 + 0.04 * np.array([-1, 1, 1, -1]), 0.04 * np.array([-1, -1, 1, 1])
    around = np.stack([np.cos(angle), np.sin(angle)], axis=-1)[:, None] * rho[:, None]
    vertices = np.concatenate([around, np.broadcast_to(z[:, None], (sides, 4, 1))], axis=-1).reshape(-1, 3)
    a = np.arange(4 * sides).reshape(sides, 4)
    b, c = np.roll(a, -1, axis=1), np.roll(a, -1, axis=0)
    d = np.roll(b, -1, axis=0)
    faces = np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)])
    return shapes.Mesh(vertices, faces)


def some_shapes(rng):
    """Convex and other solids, open surfaces, thin ones and terrain, at random poses."""
    T = cs.random_pose(7, rng=rng)
    vertices, faces = box_mesh([0.3, 0.2, 0.001])
    return {
        "star": star_mesh(rng, T[0]),
        "ring": ring_mesh().moved(T[1]),
        "hull": shapes.Hull(0.2 * rng.normal(size=(30, 3)), T[2]),
        "plate": shapes.Mesh(vertices, faces, T[3]),
        "open box": shapes.Mesh(*(lambda v, f: (v, f[2:]))(*box_mesh([0.2, 0.3, 0.25])), T[4], solid=False),
        "loose triangles": shapes.Mesh(
            rng.uniform(-0.2, 0.2, (18, 3)), np.arange(18).reshape(-1, 3), T[5], solid=False
        ),
        "terrain": shapes.HeightField(rng.uniform(0, 0.1, (4, 5)), [0.3, 0.2], T[6], bottom=-0.1),
    }


NAMES = list(some_shapes(np.random.default_rng(0)))


def sample_shape(shape, rng, n=3000):
    """Points (n, 3) of the shape: of its surface, and of its inside if it has one."""
    points = rng.uniform(*shape.bounds, (n, 3))
    distance = shape.distance(points)
    on_surface = points - distance[:, None] * shape.gradient(points)
    return np.concatenate([on_surface, points[distance < 0.0]])


def find_gaps(points, cover):
    """The distance (n,) of points (n, 3) from the nearest sphere, negative inside."""
    return (np.linalg.norm(points[:, None] - cover.centers, axis=-1) - cover.radii).min(axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("within", [0.05, 0.015])
@pytest.mark.parametrize("name", NAMES)
def test_covers_hold_the_shape_and_stick_out_no_farther_than_stated(name, within):
    rng = np.random.default_rng(3)
    shape = some_shapes(rng)[name]
    cover = shapes.cover_mesh(shape, within)
    assert 0.0 < cover.stick_out <= within
    assert cover.uncovered_depth == 0.0
    assert cover.solid == getattr(shape, "solid", True)
    assert find_gaps(sample_shape(shape, rng), cover).max() < 1e-9
    rim = (cover.centers[:, None] + cover.radii[:, None, None] * random_directions(rng, 50)).reshape(-1, 3)
    assert shape.distance(rim).max() <= cover.stick_out


@pytest.mark.parametrize("name", NAMES)
def test_measures_hold_what_samples_show_and_agree_with_the_cover(name):
    rng = np.random.default_rng(5)
    shape = some_shapes(rng)[name]
    cover = shapes.cover_mesh(shape, 0.03)
    whole = shapes.measure_cover(shape, cover.centers, cover.radii)
    assert whole.uncovered_depth.upper <= 0.0 or not whole.uncovered_depth.lower
    assert whole.stick_out.lower <= cover.stick_out <= 0.03
    some = rng.random(len(cover)) < 0.5
    some[0] = True
    radii = cover.radii[some] * rng.uniform(0.5, 1.5, some.sum())
    found = shapes.measure_cover(shape, cover.centers[some], radii, tolerance=0.002)
    for low, high in (found.stick_out, found.uncovered_depth):
        assert 0.0 <= low <= high <= low + 0.00201
    given = shapes.SphereCover(cover.centers[some], radii, 0.0, 0.0, True, 0, 0.0)
    deepest = find_gaps(sample_shape(shape, rng), given).max()
    assert deepest <= found.uncovered_depth.upper
    rim = (given.centers[:, None] + radii[:, None, None] * random_directions(rng, 50)).reshape(-1, 3)
    assert shape.distance(rim).max() <= found.stick_out.upper


def test_a_box_around_one_sphere_has_the_measures_of_geometry():
    box = shapes.Mesh(*box_mesh([2.0, 2.0, 2.0]))
    for radius in (0.5, 1.2, 1.5, 2.0):
        found = shapes.measure_cover(box, [[0, 0, 0]], [radius], tolerance=1e-3)
        depth, out = max(np.sqrt(3.0) - radius, 0.0), max(radius - 1.0, 0.0)
        assert found.uncovered_depth.lower - 1e-9 <= depth <= found.uncovered_depth.upper + 1e-9
        assert found.stick_out.lower - 1e-9 <= out <= found.stick_out.upper + 1e-9
        assert found.covered == (radius == 2.0)
    share = 1.0 - np.pi * (1.2**2 - 1.0) / 4.0
    low, high = shapes.measure_cover(box, [[0, 0, 0]], [1.2]).uncovered_share
    assert low <= share <= high <= low + 0.01


def test_a_moved_shape_has_the_same_cover_moved():
    rng = np.random.default_rng(7)
    mesh, T = star_mesh(rng), cs.random_pose(rng=rng)
    cover, moved = mesh.cover(0.02), mesh.moved(T).cover(0.02)
    assert np.allclose(cs.spatial.transform_points(T, cover.centers), moved.centers, atol=1e-12)
    assert np.array_equal(cover.radii, moved.radii)


@pytest.mark.slow
def test_finer_covers_have_more_spheres_and_the_surface_alone_no_more():
    mesh = star_mesh(np.random.default_rng(8))
    counts = [len(mesh.cover(within)) for within in (0.1, 0.03, 0.01)]
    assert counts == sorted(set(counts))
    assert len(mesh.cover(0.01, inside=False)) <= counts[-1]
    assert not mesh.cover(0.01, inside=False).solid


@pytest.mark.slow
def test_the_same_mesh_has_the_same_spheres_in_every_thread_and_instruction_set():
    mesh = star_mesh(np.random.default_rng(9))
    first = mesh.cover(0.015)
    with ThreadPoolExecutor(4) as pool:
        for again in pool.map(lambda _: mesh.cover(0.015), range(4)):
            assert np.array_equal(first.spheres, again.spheres)
    code = (
        "import numpy as np; from cspace import shapes;"
        "h = shapes.Hull(np.random.default_rng(2).normal(size=(20, 3)));"
        "print(h.cover(0.1).spheres.tobytes().hex())"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "CSPACE_ISA": isa},
            capture_output=True,
            check=True,
        ).stdout
        for isa in ("baseline", "avx2")
    }
    assert len(found) == 1


def test_meshes_in_millimetres_are_covered():
    mesh = star_mesh(np.random.default_rng(10))
    large = shapes.Mesh(1000.0 * mesh.vertices, mesh.faces)
    assert abs(len(large.cover(20.0)) - len(mesh.cover(0.02))) <= 2


def test_cover_shape_takes_the_proved_cover():
    hull = shapes.Hull(np.random.default_rng(11).normal(size=(20, 3)), [1, 2, 3])
    cover = shapes.cover_shape(hull, 0.1)
    assert np.array_equal(cover.spheres, hull.cover(0.1).spheres)


def test_covers_show_their_numbers():
    line = repr(shapes.Mesh(*box_mesh([1, 1, 1])).cover(0.2))
    assert re.match(r"<SphereCover \d+ spheres of 0\.\d+ to 0\.\d+ m around a solid, stick out ≤ 0\.", line)
    open_box = shapes.Mesh(box_mesh([1, 1, 1])[0], box_mesh([1, 1, 1])[1][2:], solid=False)
    assert "around a surface" in repr(open_box.cover(0.2))
    assert "stick-out" in repr(shapes.measure_cover(open_box, [[0, 0, 0]], [1.0]))


MESH = shapes.Mesh(*box_mesh([1, 1, 1]))
CALLS = {
    "zero": (lambda: MESH.cover(0.0), "within is 0.0; it must be one positive number [m]"),
    "negative": (lambda: MESH.cover(-1), "within is -1"),
    "NaN": (lambda: MESH.cover(np.nan), "within holds nan"),
    "too fine": (lambda: MESH.cover(1e-5), "within is 1e-05 m; the cover needs too many pieces"),
    "inside": (lambda: MESH.cover(0.1, inside="no"), "inside is a str; it must be True or False"),
    "cache": (lambda: shapes.cover_mesh(MESH, 0.1, cache=1), "cache is an int"),
    "sphere": (lambda: shapes.cover_mesh(shapes.Sphere(1.0)), "mesh is a Sphere; give a Mesh, a Hull or"),
    "array": (lambda: shapes.cover_mesh(np.eye(3)), "mesh is an ndarray"),
    "time": (lambda: shapes.cover_mesh(MESH, 0.1, time_limit=0), "time_limit is 0"),
    "late": (lambda: shapes.cover_mesh(MESH, 0.01, time_limit=1e-4), "took longer than time_limit, 0.0001 s"),
    "no spheres": (lambda: shapes.measure_cover(MESH, np.empty((0, 3)), []), "centers holds no sphere"),
    "radii": (lambda: shapes.measure_cover(MESH, np.zeros((2, 3)), [1.0]), "radii has shape (1,)"),
    "negative radius": (lambda: shapes.measure_cover(MESH, [[0, 0, 0]], [-1]), "radii[0] is -1 m"),
    "NaN centre": (lambda: shapes.measure_cover(MESH, [[0, 0, np.nan]], [1]), "centers holds nan"),
    "tolerance": (lambda: shapes.measure_cover(MESH, [[0, 0, 0]], [1], tolerance=0), "tolerance is 0"),
}


@pytest.mark.parametrize("name", CALLS)
def test_bad_arguments_are_named(name):
    call, text = CALLS[name]
    with pytest.raises(cs.CspaceError) as caught:
        call()
    assert text in str(caught.value)


def test_late_covers_are_also_timeouts():
    with pytest.raises(TimeoutError):
        shapes.cover_mesh(MESH, 0.01, time_limit=1e-4)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of the cache, empty."""
    monkeypatch.setenv("CSPACE_CACHE", str(tmp_path / "kept"))
    return tmp_path / "kept"


def test_covers_are_kept_by_content_and_options(folder):
    first = MESH.cover(0.1)
    assert len(list(folder.iterdir())) == 1
    again = shapes.Mesh(MESH.vertices.copy(), MESH.faces.copy(), [1, 2, 3], "other").cover(0.1)
    assert len(list(folder.iterdir())) == 1
    assert np.array_equal(first.centers + np.array([1, 2, 3]), again.centers)
    assert (again.stick_out, again.parts) == (first.stick_out, first.parts)
    MESH.cover(0.11)
    MESH.cover(0.1, inside=False)
    shapes.Mesh(1.01 * MESH.vertices, MESH.faces).cover(0.1)
    assert len(list(folder.iterdir())) == 4


@pytest.mark.parametrize("damage", [b"", b"nonsense", None])
def test_a_damaged_file_is_written_again(folder, damage):
    first = MESH.cover(0.1)
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2] if damage is None else damage)
    assert np.array_equal(MESH.cover(0.1).spheres, first.spheres)
    assert path.read_bytes() == whole or len(path.read_bytes()) == len(whole)
    other = shapes.Mesh(2.0 * MESH.vertices, MESH.faces)
    other.cover(0.1)
    (late,) = set(folder.iterdir()) - {path}
    late.write_bytes(path.read_bytes())  # the file of another mesh
    assert other.cover(0.1).radii.max() > first.radii.max()


def test_no_cache_where_it_is_switched_off_or_cannot_be(folder, monkeypatch):
    shapes.cover_mesh(MESH, 0.1, cache=False)
    assert not folder.exists()
    monkeypatch.setenv("CSPACE_CACHE", "")
    MESH.cover(0.1)
    assert not folder.exists()
    folder.write_text("a file where the folder should be", encoding="utf-8")
    monkeypatch.setenv("CSPACE_CACHE", str(folder))
    assert MESH.cover(0.1).stick_out <= 0.1


def test_the_folder_is_that_of_the_system(monkeypatch, tmp_path):
    monkeypatch.delenv("CSPACE_CACHE", raising=False)
    name = "LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME"
    monkeypatch.setenv(name, str(tmp_path))
    assert cache_folder() == tmp_path / "cspace"
    monkeypatch.setenv(name, "relative")
    folder = cache_folder()
    assert folder is None or folder.is_absolute()


@pytest.mark.slow
def test_several_processes_share_the_cache(folder):
    code = (
        "import numpy as np; from cspace import shapes;"
        "h = shapes.Hull(np.random.default_rng(2).normal(size=(20, 3)));"
        "print([len(h.cover(0.1 + 0.01 * k)) for k in range(4)])"
    )
    runs = [subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) for _ in range(3)]
    assert len({run.communicate()[0] for run in runs}) == 1
    assert len(list(folder.iterdir())) == 4
